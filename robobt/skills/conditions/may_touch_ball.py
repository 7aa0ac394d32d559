"""Condition: this robot may touch the ball."""

from __future__ import annotations

from robobt.skills.base import Condition, skill
from robobt.skills.kicker import follow_restart
from robobt.tree import Status


@skill
class MayTouchBall(Condition):
    """SUCCESS while the rules let this robot touch the ball.

    That is while the ball is in play, but for a kicker before anybody else has
    touched the ball, and for the own team once it may take a restart.
    """

    reads = ("team",)

    def on_running(self) -> Status:
        """Ask the referee's state and remember who kicked."""
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
