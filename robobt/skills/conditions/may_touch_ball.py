"""Condition: this robot may touch the ball."""

from __future__ import annotations

from robobt.skills.base import Condition, skill
from robobt.skills.kicker import follow_restart
from robobt.tree import Status


@skill
class MayTouchBall(Condition):
    """SUCCESS while the rules let this robot touch the ball.

    A robot may touch the ball while it is in play, unless the robot took a restart and nobody else has
    touched the ball since; before play it may touch it once its team may take a restart.
    """

    reads = ("team",)

    def on_running(self) -> Status:
        """Check the referee's state and remember who kicked."""
        frame, team = self.frame, self.store.team
        follow_restart(frame, team)
        game = frame.game
        if game.in_play:
            if team.kicker == self.me.id:
                return self.fail("nobody has touched the ball since my kick")
            return self.succeed()
        if game.may_touch and game.restart_team is frame.team and not game.halted and not game.stopped:
            return self.succeed("our restart")
        return self.fail(game.command.name)
