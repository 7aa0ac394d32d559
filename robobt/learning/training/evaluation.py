"""Evaluation of policies by success and time, never by the return."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from robobt.statistics import Interval, wilson_interval

FloatArray = NDArray[np.float64]

Policy = Callable[[FloatArray], FloatArray]
"""(n, observation) -> (n, action)."""


@dataclass(frozen=True, slots=True)
class Evaluation:
    """Results of a policy from a set of starts, each played once and without noise.

    Attributes:
        success: (n,) whether the episode ended in success.
        times: (n,) until the timed moment [s]; NaN where it never came.
        optimum: (n,) shortest possible times [s]; NaN where unknown.
        returns: (n,) undiscounted sums of rewards.
        terms: what each term of the reward contributed to them in the mean, by its name.
    """

    success: NDArray[np.bool_]
    times: FloatArray
    optimum: FloatArray
    returns: FloatArray
    terms: Mapping[str, float] = field(default_factory=dict)

    @property
    def rate(self) -> float:
        """Share of the starts that ended in success."""
        return float(self.success.mean())

    @property
    def interval(self) -> Interval:
        """Wilson's 95 % interval of :attr:`rate`."""
        return wilson_interval(int(self.success.sum()), len(self.success))

    @property
    def mean_time(self) -> float | None:
        """Mean time of the successes [s]; None without any."""
        timed = self.success & np.isfinite(self.times)
        return float(self.times[timed].mean()) if timed.any() else None

    @property
    def mean_optimum(self) -> float | None:
        """Mean of the successes' shortest possible times [s]; None where unknown."""
        known = self.success & np.isfinite(self.optimum)
        return float(self.optimum[known].mean()) if known.any() else None

    @property
    def time_ratio(self) -> float | None:
        """Summed times of the successes over the sum of their optima; None where unknown."""
        known = self.success & np.isfinite(self.times) & (self.optimum > 0.0)
        return float(self.times[known].sum() / self.optimum[known].sum()) if known.any() else None
