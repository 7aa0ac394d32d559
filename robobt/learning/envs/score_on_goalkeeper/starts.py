"""Starts of Score-On-Goalkeeper."""

from __future__ import annotations

from math import pi

import numpy as np

from robobt.learning.envs.score_on_goalkeeper.settings import KeeperSettings, ScoreOnGoalkeeperSettings
from robobt.learning.envs.starts import BALL_COLUMNS, MOUTH_GAP, ROBOT_COLUMNS, start_parts, velocities
from robobt.learning.envs.task import FloatArray
from robobt.learning.opponents.keepers import (
    GOALKEEPER_KINDS,
    GOALKEEPER_TRAITS,
    KEEPER,
    Kind,
    real_population,
)
from robobt.world.geometry import wrap_angles
from robobt.world.state import BALL_RADIUS

SCORE_START_COLUMNS = (
    *ROBOT_COLUMNS,
    *(f"keeper_{name}" for name in ROBOT_COLUMNS),
    *BALL_COLUMNS,
    *GOALKEEPER_TRAITS,
)
"""Columns of a start: attacker, goalkeeper, ball, and the kind of goalkeeper."""

_START_AREA_GAP = 0.4
"""Least distance of starts from the defence area [m]."""
_INSET = 0.3
"""Least distance of starts from the touch lines [m]."""
_APART = 0.2
"""Least distance of a robot and a free ball [m]."""


def score_starts(settings: ScoreOnGoalkeeperSettings, rng: np.random.Generator, count: int) -> FloatArray:
    """Draw ``count`` starts (count, 19) with the columns :data:`SCORE_START_COLUMNS`.

    The ball lies in the mouth or anywhere.
    """
    starts, field, keepers = settings.starts, settings.field, settings.keepers
    x = starts.robot_x or (0.0, field.half_length - field.defense_depth - _START_AREA_GAP)
    y = starts.robot_y or (_INSET - field.half_width, field.half_width - _INSET)
    rows = np.zeros((count, len(SCORE_START_COLUMNS)))
    far, turned = rng.random(count), rng.uniform(-pi, pi, count)
    if starts.easy:
        far, turned = far**2, turned * rng.random(count)
    robots, ball, traits = start_parts(rows, 2)
    robot, keeper = robots.T
    farthest, nearest = x
    robot["x"] = nearest - (nearest - farthest) * far
    robot["y"] = rng.uniform(*y, count)
    robot["heading"] = wrap_angles(np.arctan2(-robot["y"], field.half_length - robot["x"]) + turned)
    drifting = velocities(rng, starts.robot_speed, count)
    ball_x, ball_y = rng.uniform(*x, count), rng.uniform(*y, count)
    rolling = velocities(rng, starts.ball_speed, count)
    # A ball inside the robot is moved away from it.
    way_x, way_y = ball_x - robot["x"], ball_y - robot["y"]
    apart = np.maximum(np.hypot(way_x, way_y), 1e-9)
    ball_x = np.where(apart < _APART, robot["x"] + way_x / apart * _APART, ball_x)
    ball_y = np.where(apart < _APART, robot["y"] + way_y / apart * _APART, ball_y)
    held = rng.random(count) < starts.held
    ahead = settings.simulator.body.face + BALL_RADIUS + MOUTH_GAP
    ball["x"] = np.where(held, robot["x"] + ahead * np.cos(robot["heading"]), ball_x)
    ball["y"] = np.where(held, robot["y"] + ahead * np.sin(robot["heading"]), ball_y)
    robot["vx"], robot["vy"] = np.where(held, 0.0, drifting)
    ball["vx"], ball["vy"] = np.where(held, 0.0, rolling)
    traits[:] = keeper_traits(keepers, rng, count)
    keeper["x"] = field.half_length - traits.view(KEEPER)["keeper_out"][:, 0]
    keeper["y"] = rng.uniform(*starts.keeper_y, count)
    keeper["heading"] = pi
    return rows


def keeper_traits(keepers: KeeperSettings, rng: np.random.Generator, count: int) -> FloatArray:
    """Draw ``count`` goalkeepers, a row each.

    The columns are :data:`~robobt.learning.opponents.keepers.GOALKEEPER_TRAITS`.
    """
    keeper = np.empty(count, KEEPER)
    keeper["keeper_kind"] = rng.choice([GOALKEEPER_KINDS.index(kind) for kind in keepers.kinds], count)
    keeper["keeper_speed"] = rng.uniform(*keepers.speed, count)
    keeper["keeper_out"] = rng.uniform(*keepers.out, count)
    if "fitted" in keepers.kinds:
        fitted, real = keeper["keeper_kind"] == Kind.FITTED, real_population()
        speeds = real.max_speed * np.exp(real.spread * rng.standard_normal(count))
        keeper["keeper_speed"][fitted] = speeds[fitted]
    return keeper.view(np.float64).reshape(count, -1)
