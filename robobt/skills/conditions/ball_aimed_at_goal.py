"""Condition: a robot that has the ball points it at our goal."""

from __future__ import annotations

from math import cos, isnan, nan

from robobt.skills.base import Condition, skill
from robobt.tree import Status
from robobt.world.compiled import compilable
from robobt.world.field import FieldGeometry
from robobt.world.geometry import line_crossing_x
from robobt.world.records import Ball, Robot
from robobt.world.rules import has_ball
from robobt.world.state import ROBOT_RADIUS


@skill
class BallAimedAtGoal(Condition):
    """SUCCESS while another robot, of either team, holds the ball and points at our goal mouth.

    Writes the place to block to the store's ``target``: where a kick now would cross the goal line, moved a
    robot's radius in front of it.

    Source: RoboBulls' published code, Goalie.
    """

    writes = ("target",)

    def on_running(self) -> Status:
        """Look at every other robot's heading."""
        frame = self.frame
        field, ball = frame.field, frame.ball
        for robot in (*frame.opponents, *frame.teammates(self.me.id)):
            if has_ball(robot, ball) and not isnan(y := aimed_at(robot, ball, field)):
                self.store.target = (ROBOT_RADIUS - field.half_length, y)
                return self.succeed(f"robot {robot.id} aims at y = {y:.2f}")
        return self.fail("nobody aims at our goal")


@compilable
def aimed_at(robot: Robot, ball: Ball, field: FieldGeometry) -> float:
    """Return the y at which the robot would kick the ball over our goal line [m]; nan beside the goal."""
    if cos(robot.heading) >= 0.0:
        return nan
    y = line_crossing_x((ball.x, ball.y), robot.heading, -field.length / 2)
    return y if y is not None and abs(y) < field.goal_width / 2 else nan
