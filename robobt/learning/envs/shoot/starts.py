"""Where episodes of Shoot-Towards-Goal start."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from robobt.learning.envs.settings import Span
from robobt.learning.envs.shoot.settings import ShootSettings
from robobt.learning.envs.starts import GIVE_UP, START_COLUMNS, velocities
from robobt.learning.envs.task import FloatArray
from robobt.sim.arenas import Arenas
from robobt.sim.records import COMMAND, size
from robobt.world.state import BALL_RADIUS

_GAP = 3e-4
"""Between ball and front before the dribbler takes it [m]."""

_POINTS = 17
"""Places across the mouth at which it is tried out where the ball settles."""


def shoot_starts(settings: ShootSettings, rng: np.random.Generator, count: int) -> FloatArray:
    """Draw ``count`` starts (count, 10) of Shoot, the ball where the dribbler holds it after the warm-up."""
    starts, field = settings.starts, settings.field
    # The margins are those of the authors' code.
    x = starts.robot_x or (0.3, field.half_length - field.defense_depth - 0.3)
    y = starts.robot_y or (-field.half_width + 0.1, field.half_width - 0.1)
    rows = np.zeros((count, len(START_COLUMNS)))
    rows[:, 0] = rng.uniform(*x, count)
    rows[:, 1] = rng.uniform(*y, count)
    rows[:, 2] = rng.uniform(*starts.heading, count)
    rows[:, 5] = rng.uniform(*starts.robot_turn, count)
    aside = rng.uniform(*starts.ball_aside, count)
    ahead, across = _held_ball(settings)
    grid = np.linspace(*starts.ball_aside, len(ahead))
    dx, dy = np.interp(aside, grid, ahead), np.interp(aside, grid, across)
    cos, sin = np.cos(rows[:, 2]), np.sin(rows[:, 2])
    rows[:, 6] = rows[:, 0] + cos * dx - sin * dy
    rows[:, 7] = rows[:, 1] + sin * dx + cos * dy
    # The ball goes round with the robot.
    rows[:, 8] = -rows[:, 5] * (rows[:, 7] - rows[:, 1])
    rows[:, 9] = rows[:, 5] * (rows[:, 6] - rows[:, 0])
    if starts.robot_speed != (0.0, 0.0):
        rows[:, 3:5] = _drifts(settings, rng, rows, x, y)
        rows[:, 8:10] += rows[:, 3:5]
    return rows


def _drifts(
    settings: ShootSettings, rng: np.random.Generator, rows: FloatArray, x: Span, y: Span
) -> FloatArray:
    """Draw velocities from which the robots come to rest inside the ranges."""
    limits = settings.robot_limits
    braking = min(limits.braking, limits.lateral_braking)
    drifts = np.zeros((len(rows), 2))
    open_ = np.arange(len(rows))
    for _ in range(GIVE_UP):
        drifts[open_] = velocities(rng, settings.starts.robot_speed, len(open_))
        moved = drifts[open_]
        rest = rows[open_, :2] + moved * np.hypot(moved[:, :1], moved[:, 1:]) / (2.0 * braking)
        inside = (rest >= (x[0], y[0])) & (rest <= (x[1], y[1]))
        open_ = open_[~inside.all(axis=1)]
        if len(open_) == 0:
            return drifts
    raise ValueError("starts: robots of that speed do not stop inside the ranges")


@lru_cache(maxsize=16)
def _held_ball(settings: ShootSettings) -> tuple[FloatArray, FloatArray]:
    """Find where a ball put into the mouth is after the warm-up: ahead and aside of the robot's centre [m].

    At rest this depends on nothing but where across the mouth it was put, so the
    warm-up of every start is that of the same few places, evenly spread over ``ball_aside``.
    """
    points = np.linspace(*settings.starts.ball_aside, _POINTS)
    simulator = settings.stepped_simulator
    arenas = Arenas(settings.field, [None], simulator, settings.period, len(points))
    ahead = simulator.body.face + BALL_RADIUS + _GAP
    balls = np.column_stack((np.full(len(points), ahead), points, np.zeros((len(points), 2))))
    arenas.place(np.zeros((len(points), 1, 3)), balls)
    commands = np.zeros((len(points), 1, size(COMMAND)))
    commands.view(COMMAND)["dribbler"] = float(settings.action.dribbler)
    for _ in range(settings.starts.warm_up):
        arenas.step(commands)
    return arenas.balls[:, 0].copy(), arenas.balls[:, 1].copy()
