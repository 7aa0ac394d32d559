"""Stand where the ball sees as little of our goal as possible."""

from __future__ import annotations

from math import hypot

from robobt.skills.base import skill
from robobt.skills.driving import DrivingSkill
from robobt.tree import Status
from robobt.world.field import FieldGeometry
from robobt.world.geometry import Point
from robobt.world.rules import in_own_defense_area
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS


@skill
class CoverAngle(DrivingSkill):
    """Stand on the bisector of the angle between the posts as the ball sees them, facing the ball.

    How far out is as far as ``stand_out``, but no farther than the own defence
    area lets, nor than where the robot's width already hides the whole goal.
    Never ends by itself; FAILURE while the ball is behind the goal line.

    Args:
        limits: how to drive; None for the robot's own.
        speed: factor on the top speed.
        stand_out: farthest from the goal line [m].
    """

    stand_out: float = 0.5

    def on_running(self) -> Status:
        """Drive to the place for one tick."""
        field, me, ball = self.frame.field, self.me, self.ball
        if ball.x <= -field.half_length:
            return self.fail("the ball is behind the goal line")
        half_goal = field.goal_width / 2
        line = -field.half_length
        foot = bisector_foot(field, ball.position)
        dx, dy = ball.x - line, ball.y - foot
        gap = hypot(dx, dy)
        hides = ROBOT_RADIUS / half_goal * gap
        out = min(self.stand_out, max(gap - hides, ROBOT_RADIUS), gap - ROBOT_RADIUS - BALL_RADIUS)
        out = max(out, 0.0)
        x = max(line + out * dx / gap, line + ROBOT_RADIUS)
        most_y = field.defense_width / 2 - ROBOT_RADIUS
        y = min(most_y, max(-most_y, foot + out * dy / gap))
        self.drive_to(
            (min(x, line + field.defense_depth - ROBOT_RADIUS), y),
            ball.position,
            # Inside nobody else may stand; a new goalkeeper from outside goes round its own wall.
            avoid_robots=not in_own_defense_area(field, me.x, me.y, ROBOT_RADIUS),
            goalkeeper=True,
            thereabouts=True,
        )
        return self.run("covering the angle")


def bisector_foot(field: FieldGeometry, ball: Point) -> float:
    """Return where the bisector of the angle between our posts, as the ball sees them, meets the line [m]."""
    half_goal, ahead = field.goal_width / 2, ball[0] + field.half_length
    to_left, to_right = hypot(ahead, half_goal - ball[1]), hypot(ahead, half_goal + ball[1])
    # The bisector of an angle divides the opposite side as the other two sides.
    return half_goal * (to_right - to_left) / (to_right + to_left)
