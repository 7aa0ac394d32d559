"""Condition: the ball rests in the own defence area and has to be cleared."""

from __future__ import annotations

from robobt.skills.base import Condition, skill
from robobt.tree import Status
from robobt.world.compiled import compilable
from robobt.world.field import FieldGeometry
from robobt.world.records import Ball
from robobt.world.rules import carries, in_area


@skill
class BallRestsInDefense(Condition):
    """SUCCESS while the ball is in the own defence area, at rest or carried by this robot.

    Source: RoboBulls' published code, Goalie.

    Args:
        rest_speed: a ball slower than this counts as resting [m/s].
    """

    rest_speed: float = 0.1

    def on_running(self) -> Status:
        """Look where the ball is and how fast."""
        field, ball = self.frame.field, self.ball
        if not lies_in_area(ball, field):
            return self.fail("the ball is outside our area")
        if ball.speed > self.rest_speed and not carries(self.me, ball):
            return self.fail("the ball moves")
        return self.succeed()


@compilable
def lies_in_area(ball: Ball, field: FieldGeometry) -> bool:
    """Return whether the ball lies in the own defence area."""
    half_length = field.length / 2
    inside = abs(ball.x) <= half_length and abs(ball.y) <= field.width / 2
    return inside and in_area(-ball.x, ball.y, half_length, field.defense_depth, field.defense_width, 0.0)
