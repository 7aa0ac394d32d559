"""Condition: everybody has to stand still."""

from __future__ import annotations

from robobt.skills.base import Condition, skill
from robobt.tree import Status


@skill
class IsHalted(Condition):
    """SUCCESS while the referee has halted the game or a team has its time-out."""

    def on_running(self) -> Status:
        """Check the referee's state."""
        if self.frame.game.halted:
            return self.succeed(self.frame.game.command.name)
        return self.fail("the game is not halted")
