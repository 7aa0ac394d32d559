"""A sum tree over arrays: sample indices in proportion to their priorities."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


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
