"""Stand between the ball and the nearest point of our goal."""

from __future__ import annotations

from robobt.skills.base import skill
from robobt.skills.driving import DrivingSkill
from robobt.tree import Status
from robobt.world.geometry import closest_point_on_segment
from robobt.world.state import ROBOT_RADIUS


@skill
class CoverNearPost(DrivingSkill):
    """Drive to the nearest point of the line from the ball to the nearest point of the goal mouth.

    Never ends by itself. FAILURE while the ball lies beside the goal or that
    point is not well inside the own defence area.

    Source: RoboBulls' published code, Goalie.

    Args:
        limits: how to drive; None for the robot's own.
        speed: factor on the top speed.
        before_goal: balls farther back than this count as beside the goal [m].
    """

    before_goal: float = 0.15

    def on_running(self) -> Status:
        """Drive to the line for one tick."""
        field, ball = self.frame.field, self.ball.position
        if ball[0] < self.before_goal - field.half_length:
            return self.fail("the ball is beside the goal")
        half_goal = field.goal_width / 2
        nearest = (-field.half_length, min(half_goal, max(-half_goal, ball[1])))
        place = closest_point_on_segment(self.me.position, ball, nearest)
        if place[0] > field.defense_depth - field.half_length - ROBOT_RADIUS or (
            abs(place[1]) > field.defense_width / 2
        ):
            return self.fail("too far out")
        self.drive_to(place, ball, avoid_robots=False, goalkeeper=True, thereabouts=True)
        return self.run("covering the near post")
