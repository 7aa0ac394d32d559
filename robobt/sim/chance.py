"""Random numbers of an arena, for compiled code: each arena has its own, and they follow from its seed."""

from __future__ import annotations

from collections.abc import Iterable
from math import cos, log, pi, sqrt

import numpy as np

from robobt.sim.records import ArenaState, IntArray
from robobt.world.compiled import compiled_merged

_MODULUS = 2**31 - 1
"""A prime. Source of it and of the multiplier: Park, Miller and Stockmeyer, 1993 (Lehmer's generator)."""

_MULTIPLIER = 48271

_WIDEST = 3.0
"""Most standard deviations by which a factor differs from 1."""


def seeded(seeds: Iterable[int]) -> IntArray:
    """Return the state of each arena's random numbers for its seed, at least 0."""
    hashed = [int(np.random.SeedSequence(int(seed)).generate_state(1)[0]) for seed in seeds]
    return np.array(hashed, dtype=np.int64) % (_MODULUS - 1) + 1


@compiled_merged
def drawn_factor(state: ArenaState, deviation: float) -> float:
    """Draw a factor with mean 1 and this standard deviation, of a normal distribution cut off."""
    first, second = _drawn(state), _drawn(state)
    normal = sqrt(-2.0 * log(first)) * cos(2.0 * pi * second)
    return 1.0 + deviation * min(max(normal, -_WIDEST), _WIDEST)


@compiled_merged
def _drawn(state: ArenaState) -> float:
    """Draw a number between 0 and 1, both excluded."""
    state.chance = state.chance * _MULTIPLIER % _MODULUS
    return state.chance / _MODULUS
