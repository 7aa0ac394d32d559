"""The replay buffer: transitions in one packed array, sampled uniformly or by priority."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from robobt.learning.agents.nstep import Transitions


class SumTree:
    """Priorities of ``capacity`` items, 0 to begin with.

    Setting and sampling go level by level over whole arrays, so a batch costs
    about twenty array operations whatever its size.
    """

    def __init__(self, capacity: int) -> None:
        self._leaves = 1 << max(0, capacity - 1).bit_length()
        self._sums = np.zeros(2 * self._leaves)

    @property
    def total(self) -> float:
        """Sum of all priorities."""
        return float(self._sums[1])

    def __getitem__(self, items: NDArray[np.int64]) -> NDArray[np.float64]:
        """Return the priorities of ``items``."""
        return self._sums[items + self._leaves]

    def set(self, items: NDArray[np.int64], priorities: NDArray[np.float64]) -> None:
        """Set priorities; of an item given twice, one of the two is kept."""
        nodes = items + self._leaves
        self._sums[nodes] = priorities
        while nodes[0] > 1:
            nodes = nodes >> 1
            self._sums[nodes] = self._sums[2 * nodes] + self._sums[2 * nodes + 1]

    def sample(self, count: int, rng: np.random.Generator) -> NDArray[np.int64]:
        """Sample ``count`` items, one from each of as many equal shares of the total (stratified)."""
        left = (np.arange(count) + rng.random(count)) * (self.total / count)
        nodes = np.ones(count, dtype=np.int64)
        while nodes[0] < self._leaves:
            nodes = nodes << 1
            before = self._sums[nodes]
            # A right-hand sum of 0 is never entered, whatever rounding left over.
            right = (left >= before) & (self._sums[nodes + 1] > 0.0)
            left = left - before * right
            nodes = nodes + right
        return nodes - self._leaves


Floats = NDArray[np.float32]


@dataclass(slots=True)
class Bootstrap:
    """An n-step return: target = reward + discount * Q(next observation); rows as in Transitions."""

    reward: Tensor
    discount: Tensor
    next_observation: Tensor


@dataclass(slots=True)
class Batch:
    """Rows sampled from a replay.

    ``bootstraps`` has one entry per horizon of the returns in the replay; ``weights`` (batch,) are importance
    weights, None when sampled uniformly; ``rows`` (batch,) are indices in the replay.
    """

    observation: Tensor
    action: Tensor
    bootstraps: list[Bootstrap]
    weights: Tensor | None
    rows: NDArray[np.int64]


class ReplayBuffer:
    """A ring buffer of transitions after an optional part that is never overwritten.

    Every row is packed as observation, action, then for each horizon reward,
    discount and next observation, so that a batch is one gather.

    ``capacity`` is the number of rows, demonstrations included; ``horizons`` that of returns per row.
    """

    def __init__(self, capacity: int, observation_size: int, action_size: int, horizons: int = 1) -> None:
        self.capacity = capacity
        self._sizes = [observation_size, action_size, *[1, 1, observation_size] * horizons]
        # Untouched pages of zeros take no memory until they are written.
        self._rows: Floats = np.zeros((capacity, sum(self._sizes)), dtype=np.float32)
        self._view = torch.from_numpy(self._rows)
        self.kept = 0
        self._next = 0
        self._filled = 0

    def __len__(self) -> int:
        return self._filled

    def add(self, *transitions: Transitions) -> NDArray[np.int64]:
        """Append transitions, given once per horizon, over the oldest when full; return their rows.

        Raises:
            ValueError: there are more than the replay has room for.
        """
        first = transitions[0]
        parts = [first.observation, first.action]
        for part in transitions:
            parts += [part.reward[:, None], part.discount[:, None], part.next_observation]
        packed = np.concatenate(parts, axis=1)
        room = self.capacity - self.kept
        if len(packed) > room:
            raise ValueError(f"{len(packed)} transitions at once in a replay with room for {room}")
        rows = self.kept + (self._next - self.kept + np.arange(len(packed))) % room
        self._rows[rows] = packed
        self._next = int(self.kept + (self._next - self.kept + len(packed)) % room)
        self._filled = min(self.capacity, max(self._filled, int(rows.max()) + 1))
        return rows

    def keep(self) -> None:
        """Protect what is in the replay now from being overwritten.

        Raises:
            ValueError: that would leave no room for anything else.
        """
        if self._filled >= self.capacity:
            raise ValueError(f"{self._filled} kept transitions leave no room in a replay of {self.capacity}")
        self.kept = self._next = self._filled

    def sample(self, count: int, rng: np.random.Generator) -> Batch:
        """Sample ``count`` rows uniformly."""
        return self.gather(rng.integers(0, self._filled, count), None)

    def gather(self, rows: NDArray[np.int64], weights: NDArray[np.float64] | None) -> Batch:
        """Return the given rows as a batch."""
        packed = self._view.index_select(0, torch.from_numpy(rows))
        observation, action, *rest = torch.split(packed, self._sizes, 1)
        bootstraps = [
            Bootstrap(reward[:, 0], discount[:, 0], next_observation)
            for reward, discount, next_observation in zip(rest[0::3], rest[1::3], rest[2::3], strict=True)
        ]
        return Batch(
            observation,
            action,
            bootstraps,
            None if weights is None else torch.from_numpy(weights.astype(np.float32)),
            rows,
        )

    def state(self) -> dict[str, NDArray[np.generic]]:
        """Return everything that a resumed run needs."""
        return {"rows": self._rows[: self._filled], "places": np.array([self.kept, self._next, self._filled])}

    def restore(self, state: Mapping[str, NDArray[np.generic]]) -> None:
        """Take over another replay's :meth:`state`."""
        self.kept, self._next, self._filled = (int(value) for value in state["places"].tolist())
        self._rows[: self._filled] = state["rows"]


class PrioritisedReplay(ReplayBuffer):
    """A replay that samples the rows with large errors more often.

    P(i) = p_i^alpha / sum, and importance weights (N P(i))^-beta, the largest of a
    batch scaled to 1, correct for it. New rows get the largest priority yet.

    An ``alpha`` of 0 samples uniformly, 1 in proportion to the priorities; with a ``beta`` of 1 the weights
    correct for it in full; ``epsilon`` is added to every priority, ``bonus`` to those of kept rows
    (demonstrations).

    Source: Schaul et al., "Prioritized experience replay", 2015; the bonus from
    Vecerik et al. (DDPGfD), 2017.
    """

    def __init__(
        self,
        capacity: int,
        observation_size: int,
        action_size: int,
        horizons: int = 1,
        *,
        alpha: float,
        beta: float,
        epsilon: float,
        bonus: float,
    ) -> None:
        super().__init__(capacity, observation_size, action_size, horizons)
        self._alpha, self._beta, self._epsilon, self._bonus = alpha, beta, epsilon, bonus
        self._tree = SumTree(capacity)
        self._largest = 1.0

    def add(self, *transitions: Transitions) -> NDArray[np.int64]:
        """Append transitions with the largest priority yet; see :meth:`ReplayBuffer.add`."""
        rows = super().add(*transitions)
        self._tree.set(rows, np.full(len(rows), self._largest**self._alpha))
        return rows

    def sample(self, count: int, rng: np.random.Generator) -> Batch:
        """Sample ``count`` rows by priority, with their importance weights."""
        rows = self._tree.sample(count, rng)
        chance = self._tree[rows] / self._tree.total
        weights = (self._filled * chance) ** -self._beta
        return self.gather(rows, weights / weights.max())

    def update_priorities(self, rows: NDArray[np.int64], errors: NDArray[np.float64]) -> None:
        """Set the priorities of rows after an update.

        ``rows`` (batch,) are indices in the replay; ``errors`` (batch,) squared TD errors, with any other
        terms of the priorities added.
        """
        priority = errors + self._epsilon + self._bonus * (rows < self.kept)
        self._largest = max(self._largest, float(priority.max()))
        self._tree.set(rows, priority**self._alpha)

    def state(self) -> dict[str, NDArray[np.generic]]:
        """Return everything that a resumed run needs."""
        rows = np.arange(self._filled)
        return super().state() | {"priorities": self._tree[rows], "largest": np.array([self._largest])}

    def restore(self, state: Mapping[str, NDArray[np.generic]]) -> None:
        """Take over another replay's :meth:`state`."""
        super().restore(state)
        if self._filled:
            self._tree.set(np.arange(self._filled), state["priorities"].astype(np.float64))
        self._largest = float(state["largest"].astype(np.float64)[0])
