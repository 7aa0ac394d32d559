"""The interface that a learner needs: many arenas, stepped together."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]


class EpisodeEnds(NamedTuple):
    """The ends of the episodes of ``n`` arenas, (n,) each; see :class:`StepResult`."""

    terminated: BoolArray
    truncated: BoolArray
    success: BoolArray

    @classmethod
    def none(cls, n: int) -> EpisodeEnds:
        """Return the ends of ``n`` running episodes."""
        rows = np.zeros((3, n), dtype=np.bool_)
        # Unpacking them would cost three times as much.
        return cls(rows[0], rows[1], rows[2])

    def copy(self) -> EpisodeEnds:
        """Return a copy with these changes."""
        return EpisodeEnds(*(part.copy() for part in self))

    @property
    def over(self) -> BoolArray:
        """Which have ended, (n,)."""
        return self.terminated | self.truncated


@dataclass(slots=True)
class StepResult:
    """The result of one step of all arenas; the receiver owns the arrays.

    Attributes:
        observation: (n, O) input of the next action; of the new episode where one has ended.
        reward: (n,).
        terminated: (n,) the episode ended in a terminal state.
        truncated: (n,) the time limit cut the episode off.
        final_observation: (n, O) the observation after this step; it differs from ``observation`` only where
            an episode has ended.
        success: (n,) the episode ended in success.
    """

    observation: FloatArray
    reward: FloatArray
    terminated: BoolArray
    truncated: BoolArray
    final_observation: FloatArray
    success: BoolArray


class VectorTask(Protocol):
    """``n`` arenas of one environment. An episode that ends restarts in the same step."""

    n: int
    observation_size: int
    action_size: int

    def reset(self, seed: int | None = None) -> FloatArray:
        """Restart all arenas, in a new simulator, and return (n, O) observations.

        A task reset with a ``seed`` behaves like a new task with that seed, bit for bit. Without a seed its
        random numbers continue.
        """

    def step(self, actions: FloatArray) -> StepResult:
        """Advance one control period with (n, A) ``actions`` in [-1, 1]; return the result."""
