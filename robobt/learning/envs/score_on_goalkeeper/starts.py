"""Where episodes of Score-On-Goalkeeper start."""

from __future__ import annotations

from math import pi

import numpy as np

from robobt.learning.envs.score_on_goalkeeper.settings import KeeperSettings, ScoreOnGoalkeeperSettings
from robobt.learning.envs.starts import BALL_COLUMNS, ROBOT_COLUMNS, velocities
from robobt.learning.envs.task import FloatArray
from robobt.learning.opponents.keepers import FITTED, KINDS, TRAITS, real_population
from robobt.world.geometry import wrap_angles
from robobt.world.state import BALL_RADIUS

COLUMNS = (*ROBOT_COLUMNS, *(f"keeper_{name}" for name in ROBOT_COLUMNS), *BALL_COLUMNS, *TRAITS)
"""Columns of a start: attacker, goalkeeper, ball, and which goalkeeper it is."""

_GAP = 3e-4
"""Between ball and front before the dribbler takes it [m]."""
_BEFORE_AREA = 0.4
"""How far from the defence area they start at least [m]."""
_INSET = 0.3
"""How far from the touch lines [m]."""
_APART = 0.2
"""Least distance of a robot and a free ball [m]."""


def score_starts(settings: ScoreOnGoalkeeperSettings, rng: np.random.Generator, count: int) -> FloatArray:
    """Draw ``count`` starts (count, 19), columns :data:`COLUMNS`; the ball in the mouth or anywhere."""
    starts, field, keepers = settings.starts, settings.field, settings.keepers
    x = starts.robot_x or (0.0, field.half_length - field.defense_depth - _BEFORE_AREA)
    y = starts.robot_y or (_INSET - field.half_width, field.half_width - _INSET)
    rows = np.zeros((count, len(COLUMNS)))
    far, turned = rng.random(count), rng.uniform(-pi, pi, count)
    if starts.easy:
        far, turned = far**2, turned * rng.random(count)
    rows[:, 0] = x[1] - (x[1] - x[0]) * far
    rows[:, 1] = rng.uniform(*y, count)
    rows[:, 2] = wrap_angles(np.arctan2(-rows[:, 1], field.half_length - rows[:, 0]) + turned)
    drifting = velocities(rng, starts.robot_speed, count)
    ball = np.column_stack((rng.uniform(*x, count), rng.uniform(*y, count)))
    rolling = velocities(rng, starts.ball_speed, count)
    # A ball that lies in the robot is moved away from it.
    way = ball - rows[:, :2]
    apart = np.maximum(np.hypot(way[:, 0], way[:, 1]), 1e-9)[:, None]
    ball = np.where(apart < _APART, rows[:, :2] + way / apart * _APART, ball)
    held = (rng.random(count) < starts.held)[:, None]
    ahead = settings.simulator.body.face + BALL_RADIUS + _GAP
    mouth = rows[:, :2] + ahead * np.column_stack((np.cos(rows[:, 2]), np.sin(rows[:, 2])))
    rows[:, 3:5] = np.where(held, 0.0, drifting)
    rows[:, 12:14] = np.where(held, mouth, ball)
    rows[:, 14:16] = np.where(held, 0.0, rolling)
    rows[:, 16:] = keeper_traits(keepers, rng, count)
    rows[:, 6] = field.half_length - rows[:, 18]
    rows[:, 7] = rng.uniform(*starts.keeper_y, count)
    rows[:, 8] = pi
    return rows


def keeper_traits(keepers: KeeperSettings, rng: np.random.Generator, count: int) -> FloatArray:
    """Draw ``count`` goalkeepers (count, 3), columns :data:`~robobt.learning.opponents.keepers.TRAITS`."""
    rows = np.empty((count, len(TRAITS)))
    rows[:, 0] = rng.choice([KINDS.index(kind) for kind in keepers.kinds], count)
    rows[:, 1] = rng.uniform(*keepers.speed, count)
    rows[:, 2] = rng.uniform(*keepers.out, count)
    if "fitted" in keepers.kinds:
        fitted, real = rows[:, 0] == FITTED, real_population()
        rows[fitted, 1] = real.max_speed * np.exp(real.spread * rng.standard_normal(count))[fitted]
    return rows
