"""Condition: both teams may play the ball."""

from __future__ import annotations

from robobt.skills.base import Condition, skill
from robobt.tree import Status


@skill
class BallInPlay(Condition):
    """SUCCESS while the ball is free for both teams; FAILURE in a stop and before a restart is taken."""

    def on_running(self) -> Status:
        """Check the referee's state."""
        game = self.frame.game
        if game.in_play:
            return self.succeed()
        return self.fail(game.command.name)
