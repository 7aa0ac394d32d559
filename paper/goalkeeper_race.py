"""The race of ball and goalkeeper: how likely a shot scores, without a simulator.

The goalkeeper is the paper's. It drives to the nearest point of the line from the ball to
where the shot would cross, and ends that line a robot's radius before the goal's, as
RoboBulls' published code does: on a slanting shot it so takes its place a little beside the
ball's way, too far out on a shot to the far post and too far in on one to the near post.
"""

from __future__ import annotations

from collections.abc import Callable
from math import atan2, cos, erf, sin, sqrt
from typing import NamedTuple, TypeVar, cast

import numpy as np
import pyarrow as pa
from numba import njit

from robobt.shots import Traits
from robobt.sim import PRESETS
from robobt.world import BALL_RADIUS, DIVISION_B, ROBOT_RADIUS, FloatArray

_BALL = PRESETS["robobulls"].ball
SLIDING, SWITCH, ROLLING = _BALL.slide_deceleration, _BALL.switch_share, _BALL.roll_deceleration
GOAL_LINE, POST = DIVISION_B.half_length, DIVISION_B.goal_width / 2.0 - 0.01
REACH = ROBOT_RADIUS + BALL_RADIUS
"""A ball whose centre comes nearer than this to the goalkeeper's is saved [m]."""

STEP = 0.01
THERE = 0.005
LEAST_OFFSET = 0.002
_COLUMNS = (
    *("angle_to_goal", "distance_to_goal", "target_y", "robot_x", "robot_y", "ball_x", "ball_y"),
    *("opp_x", "opp_y", "opp_vx", "opp_vy"),
)

HELD = 0.11
"""Ball to robot's centre where the ball was not recorded [m]."""


class Shot(NamedTuple):
    """The start of a race.

    Attributes:
        x, y: of the ball [m].
        target_y: where on the goal line the shot is aimed [m].
        keeper_x, keeper_y, keeper_vx, keeper_vy: of the goalkeeper, in field coordinates [m, m/s].
        bearing: the ball's off the line shooter -> target as the shooter sees it [rad].
    """

    x: float
    y: float
    target_y: float
    keeper_x: float
    keeper_y: float
    keeper_vx: float
    keeper_vy: float
    bearing: float


def _record(kind: type[Shot] | type[Traits]) -> np.dtype[np.record]:
    return cast("np.dtype[np.record]", np.dtype((np.record, [(name, "f8") for name in kind._fields])))


SHOT, TRAITS = _record(Shot), _record(Traits)
"""The records of a :class:`Shot` and of a goalkeeper's traits."""

_Function = TypeVar("_Function", bound=Callable[..., object])


def _compiled(function: _Function) -> _Function:
    return cast(_Function, njit(cache=True)(function))


def race_inputs(table: pa.Table) -> FloatArray:
    """Return what the race starts from, :data:`SHOT` (n, 8)."""
    column = {name: np.asarray(table.column(name).to_numpy(), dtype=np.float64) for name in _COLUMNS}
    angle, length = column["angle_to_goal"], column["distance_to_goal"]
    c, s = np.cos(angle), np.sin(angle)
    target = np.nan_to_num(column["target_y"])
    # Rows without field coordinates still say where everybody is in the frame of the shot.
    x, y = GOAL_LINE - length * c, target - length * s
    dx, dy = column["ball_x"] - column["robot_x"], column["ball_y"] - column["robot_y"]
    dx, dy = np.where(np.isnan(dx), HELD * c, dx), np.where(np.isnan(dy), HELD * s, dy)
    across = c * dy - s * dx
    ox, oy = column["opp_x"], column["opp_y"]
    vx, vy = np.nan_to_num(column["opp_vx"]), np.nan_to_num(column["opp_vy"])
    return np.stack(
        [
            *(x + dx, y + dy, target),
            *(x + c * ox - s * oy, y + s * ox + c * oy, c * vx - s * vy, s * vx + c * vy),
            np.arctan2(across, c * dx + s * dy),
        ],
        axis=1,
    )


@_compiled
def _nearest(shot: Shot, traits: Traits, c: float, s: float) -> float:
    """Return how near the ball, kicked along (c, s), comes to the goalkeeper before the goal line [m]."""
    px, py, kx, ky, vx, vy = shot.x, shot.y, shot.keeper_x, shot.keeper_y, shot.keeper_vx, shot.keeper_vy
    max_speed, speed = traits.max_speed, traits.kick_speed
    end_x, end_y = GOAL_LINE - ROBOT_RADIUS, py + (GOAL_LINE - px) * s / c
    rolling, most = SWITCH * speed, traits.acceleration * STEP
    time, nearest, gap = 0.0, 99.0, 99.0
    while px < GOAL_LINE + BALL_RADIUS and gap <= nearest + REACH and speed > 0.0:
        if time >= traits.delay:
            # To the nearest point of the ball's remaining way, by the root of the distance.
            dx, dy = end_x - px, end_y - py
            squared = dx * dx + dy * dy
            share = ((kx - px) * dx + (ky - py) * dy) / squared if squared > 0.0 else 0.0
            share = min(1.0, max(0.0, share))
            gx, gy = px + share * dx - kx, py + share * dy - ky
            left = sqrt(gx * gx + gy * gy) + 1e-9
            scale = min(max_speed, sqrt(2.0 * traits.braking * max(left - THERE, 0.0))) / left
            ax, ay = scale * gx - vx, scale * gy - vy
            squared = ax * ax + ay * ay
            if squared > most * most:
                scale = most / sqrt(squared)
                ax, ay = scale * ax, scale * ay
        else:
            ax, ay = 0.0, 0.0
        kx, ky = kx + (vx + 0.5 * ax) * STEP, ky + (vy + 0.5 * ay) * STEP
        vx, vy = vx + ax, vy + ay
        slower = (SLIDING if speed > rolling else ROLLING) * STEP
        px, py = px + c * (speed - 0.5 * slower) * STEP, py + s * (speed - 0.5 * slower) * STEP
        speed -= slower
        time += STEP
        gap = sqrt((px - kx) * (px - kx) + (py - ky) * (py - ky))
        nearest = min(nearest, gap)
    return nearest


@_compiled
def goal_chances(shots_: FloatArray, traits_: FloatArray, offset: float, follows: float) -> FloatArray:
    """Compute the probability of a goal of every shot, (n,), over a sample of goalkeepers.

    Args:
        shots_: (n, 8) of :func:`race_inputs`.
        traits_: (m, 7) :data:`TRAITS`; their offset is left out.
        offset: standard deviation of the offset, over which the chance is worked out exactly [m].
        follows: share of the ball's bearing off the aim by which the kick goes astray.
    """
    shots, traits = shots_.view(SHOT)[:, 0], traits_.view(TRAITS)[:, 0]
    chances = np.zeros(len(shots))
    blur = sqrt(2.0) * max(offset, LEAST_OFFSET)
    for i, shot in enumerate(shots):
        aim = atan2(shot.target_y - shot.y, GOAL_LINE - shot.x) + follows * shot.bearing
        for keeper in traits:
            c, s = cos(aim + keeper.kick_error), sin(aim + keeper.kick_error)
            if abs(c * shot.y + s * (GOAL_LINE - shot.x)) < POST * c:
                room = _nearest(shot, keeper, c, s) - REACH
                chances[i] += 0.5 * (1.0 + erf(room / blur))
    return chances / len(traits)
