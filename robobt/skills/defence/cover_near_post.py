"""Stand between the ball and the nearest point of our goal."""

from __future__ import annotations

from robobt.skills.base import skill
from robobt.skills.driving import DrivingSkill
from robobt.tree import Status
from robobt.world.compiled import compilable
from robobt.world.field import FieldGeometry
from robobt.world.geometry import closest_point_on_segment
from robobt.world.records import Ball, Robot
from robobt.world.state import ROBOT_RADIUS


@skill
class CoverNearPost(DrivingSkill):
    """Drive to the nearest point of the line from the ball to the nearest point of the goal mouth.

    Never ends by itself. FAILURE while the ball is beside the goal or that point is not well inside the own
    defence area.

    Source: RoboBulls' published code, Goalie.

    Args:
        limits: how to drive; None for the robot's own.
        speed_factor: factor on the top speed.
        before_goal: distance in front of the goal line; balls farther back count as beside the goal [m].
    """

    before_goal: float = 0.15

    def on_running(self) -> Status:
        """Drive to the line for one tick."""
        field, ball = self.frame.field, self.ball.position
        if ball[0] < self.before_goal - field.half_length:
            return self.fail("the ball is beside the goal")
        x, y, inside = near_post_place(self.me, self.ball, field)
        if not inside:
            return self.fail("too far out")
        self.drive_to((x, y), ball, avoid_robots=False, goalkeeper=True, thereabouts=True)
        return self.run("covering the near post")


@compilable
def near_post_place(me: Robot, ball: Ball, field: FieldGeometry) -> tuple[float, float, bool]:
    """Return where to stand [m], and whether that is well inside the own defence area."""
    half_length, half_goal = field.length / 2, field.goal_width / 2
    nearest = (-half_length, min(half_goal, max(-half_goal, ball.y)))
    x, y = closest_point_on_segment((me.x, me.y), (ball.x, ball.y), nearest)
    inside = x <= field.defense_depth - half_length - ROBOT_RADIUS and abs(y) <= field.defense_width / 2
    return x, y, inside
