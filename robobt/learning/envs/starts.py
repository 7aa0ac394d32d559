"""Where episodes start: drawn once from a seed, so that sets of starts can be held out."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from robobt.learning.envs.settings import Span
from robobt.learning.envs.task import FloatArray

START_COLUMNS = ("x", "y", "heading", "vx", "vy", "omega", "ball_x", "ball_y", "ball_vx", "ball_vy")
"""Columns of a start: robot and ball in field coordinates [m, rad, m/s, rad/s]."""

GIVE_UP = 1000
"""Draws of a start after which there is none that fits."""

Sampler = Callable[[np.random.Generator, int], FloatArray]


def velocities(rng: np.random.Generator, speed: Span, count: int) -> FloatArray:
    """Draw ``count`` velocities (count, 2) in any direction, with a speed in the range [m/s]."""
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
        """Take the next ``count`` starts, each with its index in the given ones, -1 for a drawn one."""
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
