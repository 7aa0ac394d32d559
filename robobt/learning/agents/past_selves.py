"""Frozen copies of a policy as opponents, so that it does not forget how to beat them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import torch
from numpy.typing import NDArray

from robobt.learning.agents.networks import Actor, ActorBuild, policy_of

Floats = NDArray[np.float64]


class PastSelves:
    """The newest ``size`` frozen copies of a policy.

    Attributes:
        taken: the steps after which each was copied, the oldest first.
    """

    def __init__(self, size: int) -> None:
        self._size = size
        self._actors: list[Actor] = []
        self.taken: list[int] = []

    def add(self, actor: Actor, steps: int) -> Actor:
        """Add a copy of ``actor`` after ``steps``, replacing the oldest when full; return the copy."""
        copy = _copy(actor.build, actor.state_dict())
        self._actors = [*self._actors, copy][-self._size :]
        self.taken = [*self.taken, steps][-self._size :]
        return copy

    def decide(self, observation: Floats) -> Floats:
        """Map (arenas, k, O) to (arenas, k, A); arenas are divided evenly among the copies."""
        blocks = np.array_split(observation, len(self._actors))
        return np.concatenate(
            [policy_of(actor)(block) for actor, block in zip(self._actors, blocks, strict=True)]
        )

    def state(self) -> dict[str, NDArray[np.generic]]:
        """Return all weights, by steps and name."""
        return {
            f"{steps}/{name}": weight.numpy().copy()
            for steps, actor in zip(self.taken, self._actors, strict=True)
            for name, weight in actor.state_dict().items()
        }

    def restore(self, state: Mapping[str, NDArray[np.generic]], build: ActorBuild) -> None:
        """Take over another's :meth:`state`; ``build`` is the policy's."""
        self.taken = sorted({int(key.partition("/")[0]) for key in state})
        self._actors = [
            _copy(build, {
                key.partition("/")[2]: torch.from_numpy(array.copy())
                for key, array in state.items()
                if key.startswith(f"{steps}/")
            })
            for steps in self.taken
        ]  # fmt: skip


def _copy(build: ActorBuild, weights: Mapping[str, torch.Tensor]) -> Actor:
    copy = Actor(**build)
    copy.load_state_dict(weights)
    return copy.requires_grad_(False)
