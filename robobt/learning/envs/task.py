"""What a learner needs of an environment: many arenas, stepped together."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]


class Ends(NamedTuple):
    """How the episodes of ``n`` arenas have ended, (n,) each; see :class:`StepResult`."""

    terminated: BoolArray
    truncated: BoolArray
    success: BoolArray

    @classmethod
    def none(cls, n: int) -> Ends:
        """Return those of ``n`` episodes that go on."""
        rows = np.zeros((3, n), dtype=np.bool_)
        # Unpacked, they cost three times as much.
        return cls(rows[0], rows[1], rows[2])

    def copy(self) -> Ends:
        """Return what does not change with these."""
        return Ends(*(part.copy() for part in self))

    @property
    def over(self) -> BoolArray:
        """Which have ended, (n,)."""
        return self.terminated | self.truncated


@dataclass(slots=True)
class StepResult:
    """What one control tick of all arenas brought; the arrays are the receiver's own.

    Attributes:
        observation: (n, O) what the next action is decided on: of the new
            episode where one has ended.
        reward: (n,).
        terminated: (n,) the episode ended in a state from which nothing follows.
        truncated: (n,) the time limit cut the episode off.
        final_observation: (n, O) what this tick led to; differs from
            ``observation`` only where an episode has ended.
        success: (n,) the episode ended in success.
    """

    observation: FloatArray
    reward: FloatArray
    terminated: BoolArray
    truncated: BoolArray
    final_observation: FloatArray
    success: BoolArray


class VectorTask(Protocol):
    """``n`` arenas of one environment. An episode that ends starts anew in the same step."""

    n: int
    observation_size: int
    action_size: int

    def reset(self, seed: int | None = None) -> FloatArray:
        """Start all arenas anew, in a new simulator, and return (n, O) observations.

        A task that is reset with a ``seed`` goes on as a new one with that seed
        would, bit for bit. Without one, its random numbers go on.
        """

    def step(self, actions: FloatArray) -> StepResult:
        """Let one control period pass under (n, A) ``actions`` in [-1, 1]; return what came of it."""
