"""Returns as a distribution over fixed atoms (C51), as D4PG's critic learns it.

Source: Bellemare, Dabney & Munos, "A distributional perspective on reinforcement
learning", 2017, algorithm 1; Barth-Maron et al., "Distributed distributional
deterministic policy gradients", 2018.
"""

from __future__ import annotations

import torch
from torch import Tensor


class Atoms:
    """At least 2 evenly spaced returns from ``low`` to ``high``; returns beyond are clipped to them."""

    def __init__(self, low: float, high: float, count: int) -> None:
        if count < 2 or not low < high:
            raise ValueError(f"needs at least 2 atoms on a rising range, not {count} from {low} to {high}")
        self.low, self.high, self.count = low, high, count
        self.values = torch.linspace(low, high, count)

    def mean(self, logits: Tensor) -> Tensor:
        """Compute the expected return of (..., atoms) logits: (...)."""
        return torch.softmax(logits, -1) @ self.values

    def project(self, probabilities: Tensor, reward: Tensor, discount: Tensor) -> Tensor:
        """Project the distribution of reward + discount * Z on the atoms.

        ``reward`` and ``discount`` are (batch,), ``probabilities``, Z's, and the answer (batch, atoms), each
        row of which has mass 1.
        """
        width = (self.high - self.low) / (self.count - 1)
        moved = reward[:, None] + discount[:, None] * self.values
        place = (moved.clamp(self.low, self.high) - self.low) / width
        # Rounding can push the last place past the last atom.
        lower = place.floor().clamp_(0, self.count - 1)
        # On an atom both neighbours are that atom: all of the mass stays with the lower.
        upper_share = place - lower
        upper = (lower + 1).clamp_(max=self.count - 1)
        projected = torch.zeros_like(probabilities)
        projected.scatter_add_(1, lower.long(), probabilities * (1 - upper_share))
        projected.scatter_add_(1, upper.long(), probabilities * upper_share)
        return projected
