"""What the play ``goalkeeper`` looks at, in either of its styles, compiled."""

from __future__ import annotations

from math import cos, hypot, inf, pi

import numpy as np
from numpy.typing import NDArray

from robobt.motion.scene import BALL_GAP
from robobt.skills.conditions.ball_at_defense_edge import BallAtDefenseEdge
from robobt.skills.conditions.ball_rests_in_defense import BallRestsInDefense
from robobt.skills.defence.return_to_goal import ReturnToGoal
from robobt.world.compiled import compiled, numbers_dtype
from robobt.world.field import FieldGeometry
from robobt.world.geometry import FloatArray, line_crossing_x, wrap_angle
from robobt.world.records import Trip
from robobt.world.rules import ALONG, MOUTH_SECTOR, before_mouth, in_area
from robobt.world.state import ROBOT_RADIUS

AIM, SHOT, FETCH, CLEAR, COVER, HOME = range(6)
"""Cases of the play, in the order in which their conditions are looked at."""

_FIELD = numbers_dtype(FieldGeometry)
_EDGE_REST, _REST = BallAtDefenseEdge.rest_speed, BallRestsInDefense.rest_speed
_BEFORE_GOAL = ReturnToGoal.before_goal


@compiled
def see(
    robots: FloatArray,
    contact: NDArray[np.bool_],
    me: int,
    seen: FloatArray,
    movers: FloatArray,
    sensed: NDArray[np.bool_],
) -> None:
    """Fill in an arena as the goalkeeper's team sees it: the own goal at -x, the own robot first.

    Args:
        robots: (R, 6) x, y, heading, vx, vy, omega in field coordinates.
        contact: (R,) whether the ball lies in the robot's mouth.
        me: which of the R is the goalkeeper; it defends the goal at +x.
        seen: (R, 6) to be filled like ``robots``.
        movers: (R, 8) to be filled with what a way in open play depends on
            (:func:`robobt.world.records.movers_of`).
        sensed: (R,) to be filled like ``contact``.
    """
    for k in range(len(robots)):
        row = 0 if k == me else (k + 1 if k < me else k)
        seen[row] = -robots[k]
        seen[row, 2], seen[row, 5] = wrap_angle(robots[k, 2] + pi), robots[k, 5]
        sensed[row] = contact[k]
        movers[row, :2] = seen[row, :2]
        movers[row, 2:4] = seen[row, 3:5]


@compiled
def case_of(
    field_: FloatArray,
    seen: FloatArray,
    sensed: NDArray[np.bool_],
    ball: FloatArray,
    fetching: FloatArray,
    min_speed: float,
    margin: float,
    before_goal: float,
) -> tuple[int, float]:
    """Return the case, and where the ball would cross the goal line if it is one of a shot [m].

    Args:
        field_: numbers of the field.
        seen: of :func:`see`.
        sensed: of the same.
        ball: x, y, vx, vy as the goalkeeper's team sees it.
        fetching: (1,) whether a ball is being fetched; changed.
        min_speed: slowest approach that counts as a shot [m/s].
        margin: how far beside the goal a shot still counts [m].
        before_goal: balls farther back than this count as beside the goal [m].
    """
    field: FieldGeometry = field_.view(_FIELD)[0]
    half_length, half_goal = field.length / 2, field.goal_width / 2
    depth, width = field.defense_depth, field.defense_width
    x, y, speed = ball[0], ball[1], hypot(ball[2], ball[3])
    carried, carries, nearest = False, False, inf
    for k in range(len(seen)):
        robot = seen[k]
        dx, dy = x - robot[0], y - robot[1]
        held = sensed[k] or before_mouth(dx, dy, robot[2], MOUTH_SECTOR)
        along = held and hypot(ball[2] - robot[3], ball[3] - robot[4]) < ALONG
        carried = carried or along
        if k == 0:
            carries = along
            continue
        nearest = min(nearest, hypot(dx, dy))
        if held and cos(robot[2]) < 0.0:
            crossing = line_crossing_x((x, y), robot[2], -half_length)
            if crossing is not None and abs(crossing) < half_goal:
                return AIM, crossing
    if ball[2] <= -min_speed and x >= -half_length and not carried:
        crosses = y - (x + half_length) * ball[3] / ball[2]
        if abs(crosses) < half_goal + margin:
            return SHOT, crosses
    inside = abs(x) <= half_length and abs(y) <= field.width / 2
    near = inside and in_area(-x, y, half_length, depth, width, 2.0 * ROBOT_RADIUS)
    if fetching[0] > 0.0:
        goes_on = near and not in_area(-x, y, half_length, depth, width, -ROBOT_RADIUS)
        fetching[0] = 1.0 if goes_on else 0.0
    elif near and not in_area(-x, y, half_length, depth, width, -0.5 * ROBOT_RADIUS):
        ours = nearest - hypot(x - seen[0, 0], y - seen[0, 1]) > ROBOT_RADIUS
        fetching[0] = 1.0 if ours and speed <= _EDGE_REST else 0.0
    if fetching[0] > 0.0:
        return FETCH, 0.0
    if inside and in_area(-x, y, half_length, depth, width, 0.0) and (speed <= _REST or carries):
        return CLEAR, 0.0
    return (COVER if x > before_goal - half_length else HOME), 0.0


@compiled
def set_out_for_home(trip: Trip, half_length: float) -> None:
    """Set the task of the skill ReturnToGoal."""
    trip.x, trip.y, trip.heading = _BEFORE_GOAL - half_length, 0.0, 0.0
    trip.final_speed, trip.ball_gap, trip.avoids_robots = 0.0, BALL_GAP, 1.0
