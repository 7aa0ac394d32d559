"""Condition: a restart is about to be taken."""

from __future__ import annotations

from robobt.skills.base import Condition, skill
from robobt.tree import Status
from robobt.world.game import Restart


@skill
class IsRestart(Condition):
    """SUCCESS from the stop before a restart until the ball is in play; at a penalty kick, until it ends.

    Args:
        kind: which restart; None for any.
        ours: true for the own team's restarts, false for the opponents'; None for either.
    """

    kind: Restart | None = None
    ours: bool | None = None

    def on_running(self) -> Status:
        """Check the referee's state."""
        frame, game = self.frame, self.frame.game
        restart, team = game.restart, game.restart_team
        if restart is None and game.penalty is not None:
            restart, team = Restart.PENALTY, game.penalty
        if restart is None or game.halted:
            return self.fail("no restart")
        if self.kind is not None and restart is not self.kind:
            return self.fail(restart.value)
        ours = team is frame.team
        if self.ours is not None and ours is not self.ours:
            return self.fail("ours" if ours else "theirs")
        return self.succeed(f"{'our' if ours else 'their'} {restart.value}")
