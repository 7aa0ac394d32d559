"""Starts of episodes, drawn from a seed so that sets of starts can be held out."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from robobt.learning.envs.settings import Span
from robobt.learning.envs.task import FloatArray, IntArray
from robobt.sim.records import COMMAND, RecordArray, size
from robobt.world.field import FieldGeometry
from robobt.world.records import BALL, ROBOT, ROBOT_SIZE

MOUTH_GAP = 3e-4
"""Gap between ball and front before the dribbler takes the ball [m]."""


ROBOT_COLUMNS = ROBOT.names or ()
BALL_COLUMNS = tuple(f"ball_{name}" for name in BALL.names or ())
START_COLUMNS = (*ROBOT_COLUMNS, *BALL_COLUMNS)
"""Columns of a start with one robot: robot and ball in field coordinates [m, rad, m/s, rad/s]."""


def columns_of(robots: int) -> tuple[str, ...]:
    """Return the columns of a start with this number of robots: the robots, then the ball."""
    if robots == 1:
        return START_COLUMNS
    names = [f"robot_{k}_{name}" for k in range(robots) for name in ROBOT_COLUMNS]
    return (*names, *BALL_COLUMNS)


def split(rows: FloatArray, robots: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return views of starts (m, S): robots (m, robots, ROBOT_SIZE), balls (m, size(BALL)) and the rest."""
    ball = robots * ROBOT_SIZE
    rest = ball + size(BALL)
    return rows[:, :ball].reshape(len(rows), robots, ROBOT_SIZE), rows[:, ball:rest], rows[:, rest:]


def start_parts(rows: FloatArray, robots: int) -> tuple[RecordArray, RecordArray, FloatArray]:
    """Return robots (m, robots) and balls (m,) of starts as records, and the remaining columns.

    They are views of the ``rows`` (m, S): assignments to them change the starts.
    """
    bodies, balls, rest = split(rows, robots)
    return bodies.view(ROBOT)[..., 0], balls.view(BALL)[:, 0], rest


def places_of(records: RecordArray) -> FloatArray:
    """Return the places (..., 2) of robots or balls [m]."""
    return np.stack((records["x"], records["y"]), axis=-1)


def check_starts(rows: FloatArray, columns: Sequence[str], robots: int, field: FieldGeometry) -> None:
    """Check given starts (m, S).

    Raises:
        ValueError: other columns, a number that is not finite, or a place outside the walls.
    """
    if rows.ndim != 2 or rows.shape[1] != len(columns):
        raise ValueError(f"starts must have the shape (m, {len(columns)}), not {rows.shape}")
    if not np.isfinite(rows).all():
        raise ValueError("a start is not finite")
    bodies, balls, _ = start_parts(rows, robots)
    x, y = field.outer
    for places in (places_of(bodies), places_of(balls)):
        if (np.abs(places) > (x, y)).any():
            raise ValueError(f"a start lies outside the walls at ({x:g}, {y:g})")


GIVE_UP = 1000
"""Number of draws after which no start is found."""

_STARTS_AT_A_TIME = 8
"""Number of starts that an arena draws at a time, because drawing one takes as long."""

Sampler = Callable[[np.random.Generator, int], FloatArray]


def velocities(rng: np.random.Generator, speed: Span, count: int) -> tuple[FloatArray, FloatArray]:
    """Draw ``count`` velocities in any direction, along x and y, with a speed in the range [m/s]."""
    fast, towards = rng.uniform(*speed, count), rng.uniform(-np.pi, np.pi, count)
    return fast * np.cos(towards), fast * np.sin(towards)


def commands_before(
    robots: FloatArray, limits: RecordArray, learners: Sequence[int], dribbler: bool
) -> FloatArray:
    """Return the commands (m, R, 7) by which learners move as they do at a start; the other robots have none.

    Args:
        robots: (m, R, 6) states at the start, in field coordinates.
        limits: (m, R) of the robots, for their gains.
        learners: indices of the robots that learn.
        dribbler: whether their dribblers are on.
    """
    commands = np.zeros((*robots.shape[:2], size(COMMAND)))
    given, now = commands.view(COMMAND)[..., 0], robots.view(ROBOT)[..., 0]
    for index in learners:
        command, state, own = given[:, index], now[:, index], limits[:, index]
        c, s = np.cos(state["heading"]), np.sin(state["heading"])
        ahead, aside = c * state["vx"] + s * state["vy"], c * state["vy"] - s * state["vx"]
        # See RobotLimits.command_for.
        whole = own["gain"] * own["side_gain"] - own["cross_ahead"] * own["cross_aside"]
        command["vx"] = (own["side_gain"] * ahead - own["cross_ahead"] * aside) / whole
        command["vy"] = (own["gain"] * aside - own["cross_aside"] * ahead) / whole
        command["omega"] = state["omega"] / own["turn_gain"]
        command["dribbler"] = float(dribbler)
    return commands


class StartPool:
    """A queue of starts: given ones first, then those that each arena draws itself.

    Args:
        sample: function that draws a number of starts.
        rngs: a generator for each arena.
        columns: columns of a start.
    """

    def __init__(self, sample: Sampler, rngs: Sequence[np.random.Generator], columns: int) -> None:
        self._sample = sample
        self._rngs = rngs
        self._drawn = np.zeros((len(rngs), _STARTS_AT_A_TIME, columns))
        self._next = [_STARTS_AT_A_TIME] * len(rngs)
        self._given = np.zeros((0, columns))
        self._next_given = 0

    def give(self, starts: FloatArray) -> None:
        """Use these starts next, and drop those given before."""
        self._given = starts
        self._next_given = 0

    def take(self, which: IntArray) -> tuple[FloatArray, list[int]]:
        """Take a start for each of these arenas, with its index in the given ones, -1 for a drawn one."""
        given = min(len(which), len(self._given) - self._next_given)
        first = self._next_given
        self._next_given += given
        rows = np.empty((len(which), self._drawn.shape[-1]))
        rows[:given] = self._given[first : first + given]
        for k, arena in enumerate(which[given:].tolist(), given):
            if self._next[arena] == _STARTS_AT_A_TIME:
                self._drawn[arena] = self._sample(self._rngs[arena], _STARTS_AT_A_TIME)
                self._next[arena] = 0
            rows[k] = self._drawn[arena, self._next[arena]]
            self._next[arena] += 1
        return rows, [*range(first, first + given), *([-1] * (len(which) - given))]
