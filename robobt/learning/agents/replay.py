"""What the agent remembers: transitions in one packed array, drawn evenly or by priority."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from robobt.learning.agents.nstep import Transitions
from robobt.learning.agents.sum_tree import SumTree

Floats = NDArray[np.float32]


@dataclass(slots=True)
class Outlook:
    """One way to bootstrap: value = reward + discount * value(following); rows as in Transitions."""

    reward: Tensor
    discount: Tensor
    following: Tensor


@dataclass(slots=True)
class Batch:
    """Rows drawn from a replay.

    Attributes:
        observation, action: (batch, ...).
        outlooks: one for each number of steps that the replay holds returns of.
        weights: (batch,) importance weights, None when drawn evenly.
        rows: (batch,) where they lie in the replay.
    """

    observation: Tensor
    action: Tensor
    outlooks: list[Outlook]
    weights: Tensor | None
    rows: NDArray[np.int64]


class Replay:
    """A ring of transitions behind an optional part that is never overwritten.

    Every row is packed as observation, action, then for each outlook reward,
    discount and following observation, so that a batch is one gather.

    Args:
        capacity: rows, demonstrations included.
        observation_size, action_size: lengths of the vectors.
        outlooks: for how many numbers of steps each row holds a return.
    """

    def __init__(self, capacity: int, observation_size: int, action_size: int, outlooks: int = 1) -> None:
        self.capacity = capacity
        self._sizes = [observation_size, action_size, *[1, 1, observation_size] * outlooks]
        # Untouched pages of zeros take no memory until they are written.
        self._rows: Floats = np.zeros((capacity, sum(self._sizes)), dtype=np.float32)
        self._view = torch.from_numpy(self._rows)
        self.kept = 0
        self._next = 0
        self._filled = 0

    def __len__(self) -> int:
        return self._filled

    def add(self, *outlooks: Transitions) -> NDArray[np.int64]:
        """Append transitions, over the oldest when full; the same ones seen over several horizons.

        Returns:
            The rows they were put in.
        """
        first = outlooks[0]
        parts = [first.observation, first.action]
        for seen in outlooks:
            parts += [seen.reward[:, None], seen.discount[:, None], seen.following]
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
        """Never overwrite what is in the replay now.

        Raises:
            ValueError: that would leave no room for anything else.
        """
        if self._filled >= self.capacity:
            raise ValueError(f"{self._filled} kept transitions leave no room in a replay of {self.capacity}")
        self.kept = self._next = self._filled

    def draw(self, count: int, rng: np.random.Generator) -> Batch:
        """``count`` rows, each as likely as any other."""
        return self.gather(rng.integers(0, self._filled, count), None)

    def gather(self, rows: NDArray[np.int64], weights: NDArray[np.float64] | None) -> Batch:
        """The given rows as a batch."""
        packed = self._view.index_select(0, torch.from_numpy(rows))
        observation, action, *rest = torch.split(packed, self._sizes, 1)
        outlooks = [
            Outlook(reward[:, 0], discount[:, 0], following)
            for reward, discount, following in zip(rest[0::3], rest[1::3], rest[2::3], strict=True)
        ]
        return Batch(
            observation,
            action,
            outlooks,
            None if weights is None else torch.from_numpy(weights.astype(np.float32)),
            rows,
        )

    def state(self) -> dict[str, NDArray[np.generic]]:
        """Everything that a resumed run needs."""
        return {
            "rows": self._rows[: self._filled],
            "places": np.array([self.kept, self._next, self._filled]),
        }

    def restore(self, state: Mapping[str, NDArray[np.generic]]) -> None:
        """Become the replay whose ``state`` it was."""
        self.kept, self._next, self._filled = (int(value) for value in state["places"].tolist())
        self._rows[: self._filled] = state["rows"]


class PrioritisedReplay(Replay):
    """A replay that draws rows the more often, the more was learned from them.

    P(i) = p_i^alpha / sum, and weights (N P(i))^-beta, the largest of a batch
    scaled to 1, make up for it. New rows get the largest priority yet.

    Args:
        alpha: 0 draws evenly, 1 in full proportion.
        beta: how far the weights make up for it, 1 in full.
        floor: added to every priority.
        bonus: added to the priorities of kept rows (demonstrations).

    Source: Schaul et al., "Prioritized experience replay", 2015; the bonus from
    Vecerik et al. (DDPGfD), 2017.
    """

    def __init__(
        self,
        capacity: int,
        observation_size: int,
        action_size: int,
        outlooks: int = 1,
        *,
        alpha: float,
        beta: float,
        floor: float,
        bonus: float,
    ) -> None:
        super().__init__(capacity, observation_size, action_size, outlooks)
        self._alpha, self._beta, self._floor, self._bonus = alpha, beta, floor, bonus
        self._tree = SumTree(capacity)
        self._largest = 1.0

    def add(self, *outlooks: Transitions) -> NDArray[np.int64]:
        """As :meth:`Replay.add`; the rows get the largest priority yet."""
        rows = super().add(*outlooks)
        self._tree.set(rows, np.full(len(rows), self._largest**self._alpha))
        return rows

    def draw(self, count: int, rng: np.random.Generator) -> Batch:
        """``count`` rows by priority, with their importance weights."""
        rows = self._tree.draw(count, rng)
        chance = self._tree[rows] / self._tree.total
        weights = (self._filled * chance) ** -self._beta
        return self.gather(rows, weights / weights.max())

    def learned(self, rows: NDArray[np.int64], surprise: NDArray[np.float64]) -> None:
        """Set the priorities of rows that were learned from.

        Args:
            surprise: (batch,) squared error, and whatever else raises a priority.
        """
        priority = surprise + self._floor + self._bonus * (rows < self.kept)
        self._largest = max(self._largest, float(priority.max()))
        self._tree.set(rows, priority**self._alpha)

    def state(self) -> dict[str, NDArray[np.generic]]:
        """Everything that a resumed run needs."""
        rows = np.arange(self._filled)
        return super().state() | {"priorities": self._tree[rows], "largest": np.array([self._largest])}

    def restore(self, state: Mapping[str, NDArray[np.generic]]) -> None:
        """Become the replay whose ``state`` it was."""
        super().restore(state)
        if self._filled:
            self._tree.set(np.arange(self._filled), state["priorities"].astype(np.float64))
        self._largest = float(state["largest"].astype(np.float64)[0])
