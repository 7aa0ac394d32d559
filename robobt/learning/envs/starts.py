"""Where episodes start: drawn once from a seed, so that sets of starts can be held out."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np

from robobt.learning.envs.settings import GoToBallSettings, ShootSettings, Span
from robobt.learning.envs.task import FloatArray
from robobt.sim.arenas import Arenas
from robobt.sim.kernels import DRIBBLE
from robobt.sim.settings import SimSettings
from robobt.world.field import FieldGeometry
from robobt.world.state import BALL_RADIUS

START_COLUMNS = ("x", "y", "heading", "vx", "vy", "omega", "ball_x", "ball_y", "ball_vx", "ball_vy")
"""Columns of a start: robot and ball in field coordinates [m, rad, m/s, rad/s]."""

_GIVE_UP = 1000
_GAP = 1e-4
"""Between ball and front before the dribbler takes it [m]."""

_POINTS = 17
"""Places across the mouth at which it is tried out where the ball settles."""

Sampler = Callable[[np.random.Generator, int], FloatArray]


def go_to_ball_starts(settings: GoToBallSettings, rng: np.random.Generator, count: int) -> FloatArray:
    """``count`` starts (count, 10) of Go-To-Ball.

    Robot and ball anywhere in their ranges, drawn again until their distance fits.

    Raises:
        ValueError: no start with that distance was found.
    """
    starts, field = settings.starts, settings.field
    x = (-field.half_length + starts.inset, field.half_length - starts.inset)
    y = (-field.half_width + starts.inset, field.half_width - starts.inset)
    rows = np.zeros((count, len(START_COLUMNS)))
    open_ = np.arange(count)
    for _ in range(_GIVE_UP):
        rows[open_, 0] = rng.uniform(*(starts.robot_x or x), len(open_))
        rows[open_, 1] = rng.uniform(*(starts.robot_y or y), len(open_))
        rows[open_, 6] = rng.uniform(*(starts.ball_x or x), len(open_))
        rows[open_, 7] = rng.uniform(*(starts.ball_y or y), len(open_))
        gap = np.hypot(rows[open_, 6] - rows[open_, 0], rows[open_, 7] - rows[open_, 1])
        open_ = open_[(gap < starts.distance[0]) | (gap > starts.distance[1])]
        if len(open_) == 0:
            break
    else:
        raise ValueError(
            f"starts: no robot and ball {starts.distance[0]:g} m to {starts.distance[1]:g} m apart"
        )
    rows[:, 2] = rng.uniform(*starts.heading, count)
    rows[:, 3:5] = _velocities(rng, starts.robot_speed, count)
    rows[:, 5] = rng.uniform(*starts.robot_turn, count)
    rows[:, 8:10] = _velocities(rng, starts.ball_speed, count)
    return rows


def shoot_starts(settings: ShootSettings, rng: np.random.Generator, count: int) -> FloatArray:
    """``count`` starts (count, 10) of Shoot: the ball where the dribbler holds it after the warm-up."""
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
    ahead, across = held_ball(
        settings.field,
        settings.stepped_simulator,
        settings.period,
        starts.ball_aside,
        starts.warm_up,
        settings.action.dribbler,
    )
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
    """Velocities from which the robots come to rest inside the ranges.

    Raises:
        ValueError: none was found for some of them.
    """
    limits = settings.robot_limits
    braking = min(limits.braking, limits.lateral_braking)
    drifts = np.zeros((len(rows), 2))
    open_ = np.arange(len(rows))
    for _ in range(_GIVE_UP):
        drifts[open_] = _velocities(rng, settings.starts.robot_speed, len(open_))
        moved = drifts[open_]
        rest = rows[open_, :2] + moved * np.hypot(moved[:, :1], moved[:, 1:]) / (2.0 * braking)
        inside = (rest >= (x[0], y[0])) & (rest <= (x[1], y[1]))
        open_ = open_[~inside.all(axis=1)]
        if len(open_) == 0:
            return drifts
    raise ValueError("starts: robots of that speed do not stop inside the ranges")


@lru_cache(maxsize=16)
def _settled(
    field: str, simulator: str, period: float, aside: Span, ticks: int, dribbler: bool
) -> tuple[FloatArray, FloatArray]:
    settings = SimSettings.model_validate_json(simulator)
    points = np.linspace(*aside, _POINTS)
    arenas = Arenas(FieldGeometry.model_validate_json(field), [None], settings, period, len(points))
    ahead = settings.body.face + BALL_RADIUS + _GAP
    balls = np.column_stack((np.full(len(points), ahead), points, np.zeros((len(points), 2))))
    arenas.place(np.zeros((len(points), 1, 3)), balls)
    commands = np.zeros((len(points), 1, 6))
    commands[..., DRIBBLE] = float(dribbler)
    for _ in range(ticks):
        arenas.step(commands)
    return arenas.balls[:, 0].copy(), arenas.balls[:, 1].copy()


def held_ball(
    field: FieldGeometry, simulator: SimSettings, period: float, aside: Span, ticks: int, dribbler: bool
) -> tuple[FloatArray, FloatArray]:
    """Where a ball put into the mouth is after ``ticks`` at rest: ahead and aside of the robot's centre [m].

    At rest this depends on nothing but where across the mouth it was put, so the
    warm-up of every start is that of the same few places, evenly spread over ``aside``.
    """
    return _settled(field.model_dump_json(), simulator.model_dump_json(), period, aside, ticks, dribbler)


def _velocities(rng: np.random.Generator, speed: Span, count: int) -> FloatArray:
    fast, towards = rng.uniform(*speed, count), rng.uniform(-np.pi, np.pi, count)
    return np.column_stack((fast * np.cos(towards), fast * np.sin(towards)))


class StartPool:
    """Starts handed out one after the other: given ones first, then drawn ones."""

    def __init__(self, sample: Sampler, rng: np.random.Generator, block: int) -> None:
        self._sample = sample
        self._rng = rng
        self._block = block
        self._drawn = np.zeros((0, len(START_COLUMNS)))
        self._next = 0
        self._given = np.zeros((0, len(START_COLUMNS)))
        self._next_given = 0

    def give(self, starts: FloatArray) -> None:
        """Hand these out next, and forget those given before."""
        self._given = starts
        self._next_given = 0

    def take(self, count: int) -> tuple[FloatArray, list[int]]:
        """The next ``count`` starts, and for each its index in the given ones, -1 for a drawn one."""
        given = min(count, len(self._given) - self._next_given)
        first = self._next_given
        self._next_given += given
        rows = [self._given[first : first + given]]
        missing = count - given
        while missing > 0:
            if self._next == len(self._drawn):
                self._drawn = self._sample(self._rng, self._block)
                self._next = 0
            part = self._drawn[self._next : self._next + missing]
            self._next += len(part)
            missing -= len(part)
            rows.append(part)
        return np.concatenate(rows), [*range(first, first + given), *([-1] * (count - given))]
