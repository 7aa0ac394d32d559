"""Means of what a learner reports about its updates."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

_COUNT = ".count"


class Diagnostics:
    """Sums and counts by name, from which :meth:`means` are computed for the log."""

    def __init__(self) -> None:
        self._sums: dict[str, Tensor] = {}
        self._counts: dict[str, int] = {}

    def add(self, **values: Tensor) -> None:
        """Add one value of each name; the tensors are scalars without a gradient."""
        for name, value in values.items():
            if name in self._sums:
                self._sums[name] += value
                self._counts[name] += 1
            else:
                self._sums[name], self._counts[name] = value.clone(), 1

    def means(self) -> dict[str, float]:
        """Return the mean of each name since :meth:`clear`."""
        return {name: float(total) / self._counts[name] for name, total in self._sums.items()}

    def clear(self) -> None:
        """Forget all values."""
        self._sums.clear()
        self._counts.clear()

    def state(self) -> dict[str, NDArray[np.generic]]:
        """Return the state for a resumed run, as arrays by name."""
        counts = {f"{name}{_COUNT}": np.array(count) for name, count in self._counts.items()}
        return {**{name: total.numpy().copy() for name, total in self._sums.items()}, **counts}

    def restore(self, state: Mapping[str, NDArray[np.generic]]) -> None:
        """Take over the :meth:`state` of another one."""
        self._sums = {
            name: torch.from_numpy(np.array(value))
            for name, value in state.items()
            if not name.endswith(_COUNT)
        }
        self._counts = {name: int(state[f"{name}{_COUNT}"].item()) for name in self._sums}
