"""Steps of many arenas, and how much better their actions were than expected."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(slots=True)
class Rollout:
    """Steps of ``n`` arenas, T of each.

    Attributes:
        observation: (T, n, O) the policy's observation, followed by the additional inputs of the value.
        action: (T, n, A) as sampled.
        log_probability: (T, n) of the action.
        value: (T, n) V of the observation.
        next_value: (T, n) V of the next observation; arbitrary where the episode has terminated.
        reward: (T, n).
        terminated: (T, n) whether the episode terminated with this step.
        ended: (T, n) whether it terminated or was truncated.
        shown: (T, n, A) what a teacher would have done; None without one.
    """

    observation: Floats
    action: Floats
    log_probability: Floats
    value: Floats
    next_value: Floats
    reward: Floats
    terminated: NDArray[np.bool_]
    ended: NDArray[np.bool_]
    shown: Floats | None = None

    @classmethod
    def empty(cls, ticks: int, n: int, observations: int, actions: int) -> Rollout:
        """Return a rollout of zeros."""

        def numbers() -> Floats:
            return np.zeros((ticks, n))

        def flags() -> NDArray[np.bool_]:
            return np.zeros((ticks, n), dtype=np.bool_)

        observation, action = np.zeros((ticks, n, observations)), np.zeros((ticks, n, actions))
        return cls(observation, action, numbers(), numbers(), numbers(), numbers(), flags(), flags())


def advantages(rollout: Rollout, gamma: float, gae_lambda: float) -> Floats:
    """Compute (1) and (2) of :mod:`robobt.learning.agents.ppo`, (T, n)."""
    delta = rollout.reward + gamma * rollout.next_value * ~rollout.terminated - rollout.value
    result = np.zeros_like(delta)
    later = np.zeros(delta.shape[1])
    for t in reversed(range(len(delta))):
        later = delta[t] + gamma * gae_lambda * later * ~rollout.ended[t]
        result[t] = later
    return result
