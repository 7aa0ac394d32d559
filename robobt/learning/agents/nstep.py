"""n-step returns of many environments at once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


class Transitions(NamedTuple):
    """Transitions for a critic: Q(observation, action) = reward + discount * Q(next observation, ...).

    Attributes:
        observation, action: (m, ...).
        reward: (m,) discounted sum of up to n rewards.
        discount: (m,) gamma^k for k rewards summed, 0 when the episode terminated.
        next_observation: (m, ...) the observation k steps later.
    """

    observation: FloatArray
    action: FloatArray
    reward: FloatArray
    discount: FloatArray
    next_observation: FloatArray


class NStep:
    """Collects steps of ``envs`` interleaved episodes into n-step transitions.

    A return ends with its episode. After a terminated episode nothing follows; a truncated one is
    bootstrapped from its last observation.

    ``horizons`` are the numbers of rewards that returns sum, n alone or n and 1; there is one transition for
    each.
    """

    def __init__(
        self, horizons: Sequence[int], gamma: float, envs: int, observation_size: int, action_size: int
    ) -> None:
        self._n = n = horizons[0]
        self._one_step_too = len(horizons) > 1
        self._gamma = gamma
        # A slot holds the transitions that began at one step, of all environments.
        self._observations = np.zeros((n, envs, observation_size))
        self._actions = np.zeros((n, envs, action_size))
        self._returns = np.zeros((n, envs))
        self._open = np.zeros((n, envs), dtype=np.bool_)
        self._ages = np.zeros(n, dtype=np.int64)
        self._first_rewards = np.zeros((n, envs))
        self._first_discounts = np.zeros((n, envs))
        self._first_next = np.zeros((n, envs, observation_size))
        self._step = 0

    def add(
        self,
        observation: FloatArray,
        action: FloatArray,
        reward: FloatArray,
        next_observation: FloatArray,
        terminated: NDArray[np.bool_],
        truncated: NDArray[np.bool_],
    ) -> list[tuple[Transitions, ...]]:
        """Add one step of every environment; return the transitions it completes, once for each horizon.

        All are (envs, ...). Where an episode has ended ``next_observation`` is its last one, not the first of
        the next episode. ``truncated`` means that a time limit ended the episode.
        """
        slot = self._step % self._n
        self._step += 1
        self._observations[slot] = observation
        self._actions[slot] = action
        self._returns[slot] = 0.0
        self._open[slot] = True
        self._ages[slot] = 0
        if self._one_step_too:
            self._first_rewards[slot] = reward
            self._first_discounts[slot] = self._gamma * ~terminated
            self._first_next[slot] = next_observation
        ended = terminated | truncated
        complete = []
        for i in range(self._n):
            self._returns[i] += self._gamma ** self._ages[i] * reward
            self._ages[i] += 1
            out = self._open[i] & ended if self._ages[i] < self._n else self._open[i].copy()
            if out.any():
                complete.append(self._take(i, out, next_observation, terminated))
        return complete

    def flush(self, observation: FloatArray) -> list[tuple[Transitions, ...]]:
        """Truncate every episode where it stands, at ``observation`` (envs, ...)."""
        never = np.zeros(len(observation), dtype=np.bool_)
        return [
            self._take(i, self._open[i].copy(), observation, never)
            for i in range(self._n)
            if self._open[i].any()
        ]

    def _take(
        self, slot: int, which: NDArray[np.bool_], next_observation: FloatArray, terminated: NDArray[np.bool_]
    ) -> tuple[Transitions, ...]:
        self._open[slot] &= ~which
        observation, action = self._observations[slot, which], self._actions[slot, which]
        discount = self._gamma ** self._ages[slot] * ~terminated[which]
        far = Transitions(observation, action, self._returns[slot, which], discount, next_observation[which])
        if not self._one_step_too:
            return (far,)
        near = Transitions(
            observation,
            action,
            self._first_rewards[slot, which],
            self._first_discounts[slot, which],
            self._first_next[slot, which],
        )
        return (far, near)
