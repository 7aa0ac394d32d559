"""Condition: the ball rolls into our goal."""

from __future__ import annotations

from math import inf, isnan, nan

from robobt.skills.base import Condition, skill
from robobt.tree import Status
from robobt.world.compiled import compilable
from robobt.world.field import FieldGeometry
from robobt.world.records import Ball
from robobt.world.rules import carries
from robobt.world.state import ROBOT_RADIUS


@skill
class ShotComing(Condition):
    """SUCCESS while the ball, on its present straight line, crosses our goal line between the posts.

    A ball that a robot carries does not count as a shot. Writes the place to block to the store's ``target``:
    the point of the crossing, moved a robot's radius in front of the line.

    Source: RoboBulls' published code, Goalie, where only a ball carried by the goalkeeper itself is excluded.

    Args:
        min_speed: least speed towards the goal line that counts [m/s].
        margin: how far beside the mouth it still counts [m].
    """

    writes = ("target",)

    min_speed: float = 0.1
    margin: float = 0.0

    def on_running(self) -> Status:
        """Extend the ball's line to the goal line."""
        field, ball = self.frame.field, self.ball
        y = crossing(ball, field, self.min_speed, self.margin)
        if isnan(y):
            return self.fail("no ball comes")
        if y == inf:
            return self.fail("the ball goes wide")
        for robots in (self.frame.own, self.frame.opponents):
            for robot in robots:
                if carries(robot, ball):
                    return self.fail("the ball is carried")
        self.store.target = (ROBOT_RADIUS - field.half_length, y)
        return self.succeed(f"crosses at y = {y:.2f}")


@compilable
def crossing(ball: Ball, field: FieldGeometry, min_speed: float, margin: float) -> float:
    """Return the y at which the ball crosses our goal line [m]; nan if it does not come.

    Infinity if it goes wide. ``min_speed`` and ``margin`` are as in :class:`ShotComing`.
    """
    if ball.vx > -min_speed:
        return nan
    y = ball.y - (ball.x + field.length / 2) * ball.vy / ball.vx
    return y if ball.x >= -field.length / 2 and abs(y) < field.goal_width / 2 + margin else inf
