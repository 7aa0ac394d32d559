"""Condition: the ball lies in the own defence area and somebody has to clear it."""

from __future__ import annotations

from robobt.skills.base import Condition, skill
from robobt.tree import Status
from robobt.world.rules import carries, in_own_defense_area


@skill
class BallRestsInDefense(Condition):
    """SUCCESS while the ball lies in the own defence area, at rest or carried by this robot.

    Source: RoboBulls' published code, Goalie.

    Args:
        rest_speed: fastest ball that rests [m/s].
    """

    rest_speed: float = 0.1

    def on_running(self) -> Status:
        """Look where the ball is and how fast."""
        field, ball = self.frame.field, self.ball
        if not (in_own_defense_area(field, ball.x, ball.y) and field.contains(ball.x, ball.y)):
            return self.fail("the ball is outside our area")
        if ball.speed > self.rest_speed and not carries(self.me, ball):
            return self.fail("the ball moves")
        return self.succeed()
