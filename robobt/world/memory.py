"""Observations with a memory: the last actions and what was seen before, by which a policy can tell delay."""

from __future__ import annotations

import re
from collections import deque
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robobt.world.geometry import FloatArray
from robobt.world.observation import ObservationEntry, ObservationSpec

_NAME = re.compile(r"(.+)_memory_(\d+)x(\d+)_(\d+)")
_MOST = 32
"""Most actions and observations that are remembered."""


@dataclass(frozen=True, slots=True)
class MemorySize:
    """How much is remembered.

    Attributes:
        base: name of the observation without it.
        actions: number of past actions.
        action_size: entries of an action.
        observations: number of past observations.
    """

    base: str
    actions: int
    action_size: int
    observations: int

    @property
    def name(self) -> str:
        """Name of the observation with it."""
        return f"{self.base}_memory_{self.actions}x{self.action_size}_{self.observations}"


def memory_of(name: str) -> MemorySize | None:
    """Return the memory of an observation by its name; None for one without."""
    found = _NAME.fullmatch(name)
    if found is None:
        return None
    base, actions, action_size, observations = found.groups()
    size = MemorySize(base, int(actions), int(action_size), int(observations))
    return size if max(size.actions, size.observations) <= _MOST and size.action_size <= _MOST else None


def with_memory(spec: ObservationSpec, size: MemorySize) -> ObservationSpec:
    """Return an observation followed by past actions in [-1, 1] and past observations, the latest first."""
    entries = list(spec.entries)
    for age in range(1, size.actions + 1):
        entries += [ObservationEntry(f"action {i}, {age} ago", "1", 1.0) for i in range(size.action_size)]
    for age in range(1, size.observations + 1):
        entries += [
            ObservationEntry(f"{entry.name}, {age} ago", entry.unit, entry.range, entry.scale, entry.signed)
            for entry in spec.entries
        ]
    return ObservationSpec(size.name, spec.version, tuple(entries), spec.vectors)


class Memory:
    """What ``rows`` robots remember side by side.

    Before the first action there were only zeros, and what is seen first was seen before.

    Args:
        size: of the memory.
        seen: entries of the observation without it.
        rows: number of robots.
    """

    def __init__(self, size: MemorySize, seen: int, rows: int = 1) -> None:
        self._actions: deque[FloatArray] = deque(
            [np.zeros((rows, size.action_size)) for _ in range(size.actions)], maxlen=size.actions
        )
        self._observations: deque[FloatArray] = deque(
            [np.zeros((rows, seen)) for _ in range(size.observations)], maxlen=size.observations
        )

    def begin(self, seen: FloatArray, which: NDArray[np.int64] | slice) -> None:
        """Forget what the robots ``which`` remember; they see ``seen`` (m, O) now."""
        for action in self._actions:
            action[which] = 0.0
        for observation in self._observations:
            observation[which] = seen

    def remember(self, seen: FloatArray, actions: FloatArray) -> None:
        """Remember what was seen, (n, O), and what was done then, (n, A)."""
        if self._actions.maxlen:
            self._actions.appendleft(np.array(actions, dtype=np.float64))
        if self._observations.maxlen:
            self._observations.appendleft(np.array(seen, dtype=np.float64))

    def recall(self, seen: FloatArray, which: NDArray[np.int64] | slice = slice(None)) -> FloatArray:
        """Return what the robots ``which`` see now, (m, O), followed by what they remember."""
        return np.concatenate(
            [seen, *(action[which] for action in self._actions), *(one[which] for one in self._observations)],
            axis=1,
        )
