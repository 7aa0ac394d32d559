"""Condition: a pass is on its way to this robot."""

from __future__ import annotations

from robobt.skills.base import Condition, skill
from robobt.tree import Status
from robobt.world.rules import has_ball

_LEAVING = 0.3
"""Time in which a kicked ball must have left the passer [s]."""


@skill
class PassIsComing(Condition):
    """SUCCESS from the kick of a pass to this robot until a robot has the ball or it stops coming nearer.

    Args:
        slowest: least ball speed that counts as coming [m/s].
        patience: longest time a pass takes [s].
    """

    reads = ("team",)

    slowest: float = 0.2
    patience: float = 4.0

    def on_running(self) -> Status:
        """Track the ball."""
        team, me, ball, frame = self.store.team, self.me, self.ball, self.frame
        age = frame.time - team.pass_time
        if team.receiver != me.id or not 0.0 <= age <= self.patience:
            return self.fail("no pass to this robot")
        if age < _LEAVING:
            return self.succeed("kicked")
        for robot in (*frame.own, *frame.opponents):
            if has_ball(robot, ball):
                return self.fail("it has arrived somewhere")
        if ball.vx * (me.x - ball.x) + ball.vy * (me.y - ball.y) <= 0.0 or ball.speed < self.slowest:
            return self.fail("it comes no nearer")
        return self.succeed("on its way")
