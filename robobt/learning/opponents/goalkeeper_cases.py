"""What a goalkeeper's play does, by the conditions of its table."""

from __future__ import annotations

from collections.abc import Sequence
from enum import IntEnum
from math import hypot, inf, isnan
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from robobt.motion.ball_watch import Watch
from robobt.skills.base import FACING, heading_thereabouts
from robobt.skills.conditions.ball_aimed_at_goal import aimed_at
from robobt.skills.conditions.ball_at_defense_edge import BallAtDefenseEdge, is_at_edge, is_ours
from robobt.skills.conditions.ball_rests_in_defense import BallRestsInDefense, lies_in_area
from robobt.skills.defence.cover_angle import CoverAngle, cover_place, is_at_home
from robobt.skills.defence.cover_near_post import near_post_place
from robobt.skills.defence.shot_coming import crossing
from robobt.world.compiled import compiled
from robobt.world.field import FieldGeometry
from robobt.world.records import Limits, Robot, Scene, Trip
from robobt.world.rules import ALONG

_STAND_OUT = CoverAngle.stand_out
_EDGE_REST_SPEED, _AREA_REST_SPEED = BallAtDefenseEdge.rest_speed, BallRestsInDefense.rest_speed


class Case(IntEnum):
    """Cases of the play, in the order in which their conditions are checked."""

    AIM = 0
    SHOT = 1
    FETCH = 2
    CLEAR = 3
    COVER = 4
    HOME = 5


class Style(NamedTuple):
    """The parameters that differ between the two plays.

    Attributes:
        min_speed: slowest approach that counts as a shot [m/s].
        margin: how far beside the goal a shot still counts [m].
        before_goal: balls farther back than this count as beside the goal [m].
        near_post: whether it covers the near post, rather than the angle between the posts.
        dives: whether it dives, and catches with the dribbler.
    """

    min_speed: float
    margin: float
    before_goal: float
    near_post: bool
    dives: bool


class Setting(Protocol):
    """What every arena has in common; the trip is the goalkeeper's."""

    trip: Trip
    scene: Scene
    own: Limits
    field: FieldGeometry


class GoalkeeperMemory(Protocol):
    """Of one goalkeeper.

    Attributes:
        aim, shot: the ball as seen in these cases.
        fetching: whether a ball is being fetched.
        slowed: whether it drives by other limits than its own.
    """

    aim: Watch
    shot: Watch
    fetching: float
    slowed: float


@compiled
def case_of(
    style: Style,
    setting: Setting,
    robots: Sequence[Robot],
    has: NDArray[np.bool_],
    memory: GoalkeeperMemory,
) -> tuple[int, float]:
    """Return the case, and where the ball would cross the goal line if it is one of a shot [m]."""
    field, ball = setting.field, setting.scene.ball
    carried, carries, nearest, own_way = False, False, inf, 0.0
    for k in range(len(robots)):
        robot = robots[k]
        dx, dy = ball.x - robot.x, ball.y - robot.y
        along = has[k] and hypot(ball.vx - robot.vx, ball.vy - robot.vy) < ALONG
        carried = carried or along
        if k == 0:
            carries, own_way = along, hypot(dx, dy)
            continue
        nearest = min(nearest, hypot(dx, dy))
        if has[k]:
            aim = aimed_at(robot, ball, field)
            if not isnan(aim):
                return Case.AIM, aim
    y = crossing(ball, field, style.min_speed, style.margin)
    if abs(y) < inf and not carried:
        return Case.SHOT, y
    speed, fetching = hypot(ball.vx, ball.vy), memory.fetching > 0.0
    at_edge = is_at_edge(ball, field, fetching)
    fetching = at_edge and (fetching or (speed <= _EDGE_REST_SPEED and is_ours(own_way, nearest)))
    memory.fetching = 1.0 if fetching else 0.0
    if fetching:
        return Case.FETCH, 0.0
    if lies_in_area(ball, field) and (speed <= _AREA_REST_SPEED or carries):
        return Case.CLEAR, 0.0
    return (Case.COVER if ball.x > style.before_goal - field.length / 2 else Case.HOME), 0.0


@compiled
def set_out(style: Style, setting: Setting) -> bool:
    """Set the trip of CoverNearPost or CoverAngle; return False if the skill would fail."""
    trip, ball, field = setting.trip, setting.scene.ball, setting.field
    avoids = False
    if style.near_post:
        trip.x, trip.y, inside = near_post_place(trip.me, ball, field)
        if not inside:
            return False
    else:
        trip.x, trip.y = cover_place(ball, field, _STAND_OUT)
        avoids = not is_at_home(trip.me, field)
    trip.heading = heading_thereabouts(trip.me, (ball.x, ball.y), FACING)
    trip.final_speed, trip.ball_gap, trip.avoids_robots = 0.0, -1.0, 1.0 if avoids else 0.0
    return True
