"""Intervals for figures that come from counting trials."""

from __future__ import annotations

from math import sqrt
from statistics import NormalDist
from typing import NamedTuple


class Interval(NamedTuple):
    """A confidence interval."""

    low: float
    high: float


def wilson_interval(successes: int, trials: int, confidence: float = 0.95) -> Interval:
    """Wilson's score interval for a proportion.

    Unlike the textbook normal interval it stays inside [0, 1] and keeps its
    coverage when every trial succeeds or none does.

    Args:
        successes: how many trials succeeded.
        trials: how many there were; none at all gives (0, 1), nothing is known.
        confidence: coverage, between 0 and 1.

    Raises:
        ValueError: counts or confidence out of range.

    Source: Wilson, "Probable inference, the law of succession, and statistical
    inference", 1927.
    """
    if trials < 0 or not 0 <= successes <= trials:
        raise ValueError(f"{successes} successes of {trials} trials is not a count")
    if not 0.0 < confidence < 1.0:
        raise ValueError(f"confidence must lie between 0 and 1, not {confidence}")
    if trials == 0:
        return Interval(0.0, 1.0)
    z = NormalDist().inv_cdf(0.5 + confidence / 2.0)
    share = successes / trials
    spread = z * z / trials
    middle = (share + spread / 2.0) / (1.0 + spread)
    half = z * sqrt(share * (1.0 - share) / trials + spread / (4.0 * trials)) / (1.0 + spread)
    low = 0.0 if successes == 0 else max(0.0, middle - half)
    high = 1.0 if successes == trials else min(1.0, middle + half)
    return Interval(low, high)
