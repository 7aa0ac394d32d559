"""The first waypoint of RoboBulls' path planner, round the ball and other robots.

Source: RoboBulls' published code, PathPlannerFPPA. Only the first waypoint is ever driven to, so only the
first is computed. It is always to the right of the way unless that leads off the field, even if the left is
shorter; the published times include this.
"""

from __future__ import annotations

from math import hypot

from robobt.world.field import FieldGeometry
from robobt.world.geometry import Point, closest_point_on_segment, distance, segment_distance
from robobt.world.state import BALL_RADIUS, Frame, RobotState

RADIUS = 0.1
"""The robot radius in RoboBulls' constants [m]; real robots have 0.09 m."""

_FIELD_BORDER = 0.1
_PATH_STEP = 0.02
_MOST_TURNS = 4
_BALL_HIT = RADIUS + BALL_RADIUS + 0.01
_BALL_FREE = RADIUS + BALL_RADIUS + 0.05
_ROBOT_HIT = 2 * RADIUS + 0.01
_ROBOT_FREE = 2 * RADIUS + 0.05


def first_waypoint(frame: Frame, me: RobotState, goal: Point, *, goalkeeper: bool = False) -> Point:
    """Return the next waypoint towards ``goal`` that avoids the ball and the robots [m].

    ``me`` may drive in its own defence area if it is the ``goalkeeper``.
    """
    start = me.position
    others = [other.position for other in frame.others(me.id)]
    next_ = allowed(frame.field, goal, goalkeeper=goalkeeper)
    for _ in range(_MOST_TURNS):
        obstacle = _in_the_way(start, next_, frame.ball.position, others)
        if obstacle is None:
            return next_
        beside = _beside(frame, start, next_, obstacle, others)
        if beside is None:
            return next_
        next_ = allowed(frame.field, beside, goalkeeper=goalkeeper)
    return next_


def allowed(field: FieldGeometry, point: Point, *, goalkeeper: bool = False) -> Point:
    """Move the point to where a robot may go: 0.1 m inside the lines and out of the defence areas [m]."""
    x, y = point
    x = min(max(x, _FIELD_BORDER - field.half_length), field.half_length - _FIELD_BORDER)
    y = min(max(y, _FIELD_BORDER - field.half_width), field.half_width - _FIELD_BORDER)
    if goalkeeper and x <= 0.0:
        return (x, y)
    sign = 1.0 if x > 0.0 else -1.0
    to_front = abs(x) - (field.half_length - field.defense_depth)
    to_side = field.defense_width / 2 - abs(y)
    if to_front < 0.0 or to_side < 0.0:
        return (x, y)
    if to_side >= to_front:
        return (x - sign * to_front, y)
    return (x, y + (to_side if y >= 0.0 else -to_side))


def _in_the_way(start: Point, end: Point, ball: Point, others: list[Point]) -> Point | None:
    # A place behind the ball is itself inside this distance, so reaching it does not count as a collision.
    if segment_distance(ball, start, end) <= _BALL_HIT:
        return ball
    for other in others:
        if not _close(other, start, _ROBOT_HIT) and segment_distance(other, start, end) <= _ROBOT_HIT:
            return other
    return None


def _beside(frame: Frame, start: Point, end: Point, obstacle: Point, others: list[Point]) -> Point | None:
    length = distance(start, end)
    if length < _PATH_STEP:
        return None
    foot = closest_point_on_segment(obstacle, start, end)
    (start_x, start_y), (end_x, end_y) = start, end
    x, y = (end_y - start_y) / length, (start_x - end_x) / length
    right = _free_point(frame, foot, (x, y), obstacle, others)
    return right or _free_point(frame, foot, (-x, -y), obstacle, others)


def _free_point(frame: Frame, foot: Point, side: Point, obstacle: Point, others: list[Point]) -> Point | None:
    round_ball = obstacle == frame.ball.position
    (x, y), (dx, dy) = foot, side
    while frame.field.contains(x, y):
        if not (round_ball and _close((x, y), obstacle, _BALL_FREE)) and all(
            hypot(x - other_x, y - other_y) > _ROBOT_FREE for other_x, other_y in others
        ):
            return (x, y)
        x, y = x + _PATH_STEP * dx, y + _PATH_STEP * dy
    return None


def _close(a: Point, b: Point, most: float) -> bool:
    return abs(a[0] - b[0]) <= most and abs(a[1] - b[1]) <= most
