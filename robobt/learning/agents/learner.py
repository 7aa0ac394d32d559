"""What every learner with an actor and a critic keeps, saves and takes over."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping

import numpy as np
import torch
from numpy.typing import NDArray
from torch import nn

from robobt.learning.agents.optimiser import Adam, restore_state, state_of


class Learner(ABC):
    """An actor and a critic with their optimisers.

    ``critic_loss`` and ``value`` are sums over the ``updates`` since :meth:`reset_sums`.
    """

    _actor_adam: Adam
    _critic_adam: Adam

    def __init__(self) -> None:
        self.updates = 0
        self.critic_loss, self.value = torch.zeros(()), torch.zeros(())

    @abstractmethod
    def _modules(self) -> tuple[tuple[str, nn.Module], ...]:
        """Return all networks, by the names under which they are saved."""

    def set_learning_rates(self, fraction: float) -> None:
        """Set both learning rates to ``fraction`` of those in the settings."""
        for optimiser in (self._actor_adam, self._critic_adam):
            optimiser.set_learning_rate(fraction)

    def reset_sums(self) -> None:
        """Set :attr:`critic_loss` and :attr:`value` to zero."""
        self.critic_loss, self.value = torch.zeros(()), torch.zeros(())

    def state(self) -> dict[str, NDArray[np.generic]]:
        """Return weights, optimisers and counters as arrays by name."""
        sums = np.array([float(self.critic_loss), float(self.value)])
        return {
            "updates": np.array([self.updates]),
            "sums": sums,
            **state_of(self._modules(), self._optimisers()),
        }

    def restore(self, state: Mapping[str, NDArray[np.generic]]) -> None:
        """Take over another learner's :meth:`state`.

        Raises:
            KeyError: it is that of a learner with other settings.
            RuntimeError: the same.
        """
        self.updates = int(state["updates"].tolist()[0])
        loss, value = state["sums"].tolist()
        self.critic_loss, self.value = torch.tensor(loss), torch.tensor(value)
        restore_state(state, self._modules(), self._optimisers())

    def _optimisers(self) -> tuple[tuple[str, Adam], ...]:
        return (("actor_adam", self._actor_adam), ("critic_adam", self._critic_adam))
