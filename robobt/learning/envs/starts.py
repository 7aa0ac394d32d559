"""Where episodes start: drawn once from a seed, so that sets of starts can be held out."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from robobt.learning.envs.settings import Span
from robobt.learning.envs.task import FloatArray, IntArray

ROBOT_COLUMNS = ("x", "y", "heading", "vx", "vy", "omega")
BALL_COLUMNS = ("ball_x", "ball_y", "ball_vx", "ball_vy")
START_COLUMNS = (*ROBOT_COLUMNS, *BALL_COLUMNS)
"""Columns of a start with one robot: robot and ball in field coordinates [m, rad, m/s, rad/s]."""


def columns_of(robots: int) -> tuple[str, ...]:
    """Return the columns of a start with so many robots: each of them, then the ball."""
    if robots == 1:
        return START_COLUMNS
    names = [f"robot_{k}_{name}" for k in range(robots) for name in ROBOT_COLUMNS]
    return (*names, *BALL_COLUMNS)


GIVE_UP = 1000
"""Draws of a start after which there is none that fits."""

_BLOCK = 8
"""Starts that an arena draws at a time: drawing one takes as long."""

Sampler = Callable[[np.random.Generator, int], FloatArray]


def velocities(rng: np.random.Generator, speed: Span, count: int) -> FloatArray:
    """Draw ``count`` velocities (count, 2) in any direction, with a speed in the range [m/s]."""
    fast, towards = rng.uniform(*speed, count), rng.uniform(-np.pi, np.pi, count)
    return np.column_stack((fast * np.cos(towards), fast * np.sin(towards)))


class StartPool:
    """Starts handed out one after the other: given ones first, then those that each arena draws for itself.

    Args:
        sample: draws so many starts.
        rngs: a generator for each arena.
        columns: of a start.
    """

    def __init__(self, sample: Sampler, rngs: Sequence[np.random.Generator], columns: int) -> None:
        self._sample = sample
        self._rngs = rngs
        self._drawn = np.zeros((len(rngs), _BLOCK, columns))
        self._next = [_BLOCK] * len(rngs)
        self._given = np.zeros((0, columns))
        self._next_given = 0

    def give(self, starts: FloatArray) -> None:
        """Hand these out next, and forget those given before."""
        self._given = starts
        self._next_given = 0

    def take(self, which: IntArray) -> tuple[FloatArray, list[int]]:
        """Take a start for each of these arenas, with its index in the given ones, -1 for a drawn one."""
        given = min(len(which), len(self._given) - self._next_given)
        first = self._next_given
        self._next_given += given
        rows = np.empty((len(which), self._drawn.shape[2]))
        rows[:given] = self._given[first : first + given]
        for k, arena in enumerate(which[given:].tolist(), given):
            if self._next[arena] == _BLOCK:
                self._drawn[arena] = self._sample(self._rngs[arena], _BLOCK)
                self._next[arena] = 0
            rows[k] = self._drawn[arena, self._next[arena]]
            self._next[arena] += 1
        return rows, [*range(first, first + given), *([-1] * (len(which) - given))]
