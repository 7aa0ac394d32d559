"""Stand where the robot hides as much of our goal from the ball as possible."""

from __future__ import annotations

from math import hypot

from robobt.skills.base import skill
from robobt.skills.driving import DrivingSkill
from robobt.tree import Status
from robobt.world.compiled import compilable
from robobt.world.field import FieldGeometry
from robobt.world.geometry import Point
from robobt.world.records import Ball, Robot
from robobt.world.rules import in_area
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS


@skill
class CoverAngle(DrivingSkill):
    """Stand on the bisector of the angle between the posts as seen from the ball, facing the ball.

    It goes as far out as ``stand_out``, but stays in the own defence area and goes no farther than the point
    where its width hides the whole goal. Never ends by itself; FAILURE while the ball is behind the goal
    line.

    Args:
        limits: how to drive; None for the robot's own.
        speed_factor: factor on the top speed.
        stand_out: largest distance from the goal line [m].
    """

    stand_out: float = 0.5

    def on_running(self) -> Status:
        """Drive to the place for one tick."""
        field, me, ball = self.frame.field, self.me, self.ball
        if ball.x <= -field.half_length:
            return self.fail("the ball is behind the goal line")
        place = cover_place(ball, field, self.stand_out)
        self.drive_to(
            place,
            ball.position,
            avoid_robots=not is_at_home(me, field),
            goalkeeper=True,
            thereabouts=True,
        )
        return self.run("covering the angle")


@compilable
def is_at_home(me: Robot, field: FieldGeometry) -> bool:
    """Return whether the goalkeeper is where no other robot may stand, so that it need not avoid robots.

    A new goalkeeper that comes from outside avoids its own wall.
    """
    half_length, depth, width = field.length / 2, field.defense_depth, field.defense_width
    return in_area(-me.x, me.y, half_length, depth, width, ROBOT_RADIUS)


@compilable
def cover_place(ball: Ball, field: FieldGeometry, stand_out: float) -> Point:
    """Return where to stand against a ball, at most ``stand_out`` in front of the goal line [m]."""
    half_length, half_goal = field.length / 2, field.goal_width / 2
    depth, width, there = field.defense_depth, field.defense_width, (ball.x, ball.y)
    line = -half_length
    foot = bisector_foot(there, half_length, half_goal)
    dx, dy = ball.x - line, ball.y - foot
    gap = hypot(dx, dy)
    hides = ROBOT_RADIUS / half_goal * gap
    out = min(stand_out, max(gap - hides, ROBOT_RADIUS), gap - ROBOT_RADIUS - BALL_RADIUS)
    out = max(out, 0.0)
    x = max(line + out * dx / gap, line + ROBOT_RADIUS)
    most_y = width / 2 - ROBOT_RADIUS
    y = min(most_y, max(-most_y, foot + out * dy / gap))
    return (min(x, line + depth - ROBOT_RADIUS), y)


@compilable
def bisector_foot(ball: Point, half_length: float, half_goal: float) -> float:
    """Return where the bisector of the angle between our posts, seen from the ball, meets the goal line [m].

    The goal line is ``half_length`` from the middle of the field, a post ``half_goal`` from the goal's
    middle.
    """
    ahead = ball[0] + half_length
    to_left, to_right = hypot(ahead, half_goal - ball[1]), hypot(ahead, half_goal + ball[1])
    # The bisector of an angle divides the opposite side in the ratio of the other two sides.
    return half_goal * (to_right - to_left) / (to_right + to_left)
