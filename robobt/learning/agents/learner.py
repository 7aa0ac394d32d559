"""The base of learners with an actor and a critic: their state, saved and restored."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from torch import nn

from robobt.learning.agents.diagnostics import Diagnostics
from robobt.learning.agents.optimiser import Adam, restore_state, state_of


class Learner(ABC):
    """An actor and a critic with their optimisers.

    Attributes:
        updates: number of updates so far.
        diagnostics: losses, gradient norms and so on of the updates since they were last logged.
    """

    _actor_adam: Adam
    _critic_adam: Adam

    def __init__(self) -> None:
        self.updates = 0
        self.diagnostics = Diagnostics()

    @abstractmethod
    def _modules(self) -> tuple[tuple[str, nn.Module], ...]:
        """Return all networks by the names under which they are saved."""

    def set_learning_rates(self, fraction: float) -> None:
        """Set both learning rates to ``fraction`` of those in the settings."""
        for optimiser in (self._actor_adam, self._critic_adam):
            optimiser.set_learning_rate(fraction)

    def state(self) -> dict[str, NDArray[np.generic]]:
        """Return weights, optimisers and the number of updates as arrays by name."""
        return {"updates": np.array([self.updates]), **state_of(self._modules(), self._optimisers())}

    def restore(self, state: Mapping[str, NDArray[np.generic]]) -> None:
        """Restore the :meth:`state` of another learner.

        Raises:
            KeyError: it belongs to a learner with other settings.
            RuntimeError: a network has other shapes.
        """
        self.updates = int(state["updates"].tolist()[0])
        restore_state(state, self._modules(), self._optimisers())

    def _optimisers(self) -> tuple[tuple[str, Adam], ...]:
        return (("actor_adam", self._actor_adam), ("critic_adam", self._critic_adam))
