"""Condition: a restart is about to be taken."""

from __future__ import annotations

from robobt.skills.base import Skill, skill
from robobt.tree import Status
from robobt.world.game import Restart


@skill
class IsRestart(Skill):
    """SUCCESS from the stop before a restart until the ball is in play.

    Args:
        kind: which restart; None is any.
        ours: whether it has to be the own team's or the opponents'; None is either.
    """

    kind: Restart | None = None
    ours: bool | None = None

    def on_running(self) -> Status:
        """Ask the referee's state."""
        frame = self.frame
        restart = frame.game.restart
        if restart is None or frame.game.halted:
            return self.fail("no restart")
        if self.kind is not None and restart is not self.kind:
            return self.fail(restart.value)
        ours = frame.game.restart_team is frame.team
        if self.ours is not None and ours is not self.ours:
            return self.fail("ours" if ours else "theirs")
        return self.succeed(f"{'our' if ours else 'their'} {restart.value}")
