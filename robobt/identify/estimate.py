"""A figure that was identified: its value, its 95 % interval, and what it rests on."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import hypot, inf, isfinite, nan
from statistics import NormalDist

import numpy as np

from robobt.statistics import mean_interval, student_quantile
from robobt.world.geometry import FloatArray

CONFIDENCE = 0.95
"""Confidence of all intervals."""


@dataclass(frozen=True, slots=True)
class Estimate:
    """An identified figure.

    Attributes:
        value: the estimate; NaN if nothing was seen.
        low: lower end of the 95 % interval.
        high: upper end of the interval.
        count: number of independent events that it rests on, such as kicks or stretches of free rolling.
        seen: whether that was enough; a figure that was not seen enough goes into no preset.
        unit: of the value.
    """

    value: float
    low: float
    high: float
    count: int
    seen: bool
    unit: str = ""

    @property
    def half_width(self) -> float:
        """Half the width of the interval."""
        return (self.high - self.low) / 2.0

    def text(self) -> str:
        """Return value, interval and unit as people read them."""
        if not self.seen:
            return "not seen enough"
        unit = f" {self.unit}" if self.unit else ""
        return f"{short(self.value)} ({short(self.low)} to {short(self.high)}){unit}"


def short(value: float, digits: int = 4) -> str:
    """Return a value with few digits; less than half of 0.000001 is 0, which has no sign."""
    return f"{round(value, 6) + 0.0:.{digits}g}"


def unseen(count: int = 0, unit: str = "") -> Estimate:
    """Return the estimate of something that was not seen enough."""
    return Estimate(nan, -inf, inf, count, False, unit)


def from_error(
    value: float, error: float, count: int, seen: bool, unit: str = "", freedom: int = 0
) -> Estimate:
    """Return an estimate from its standard error.

    Args:
        value: the estimate.
        error: its standard error.
        count: number of events that it rests on.
        seen: whether that is enough, if the numbers are finite.
        unit: of the value.
        freedom: degrees of freedom of the standard error; 0 for many.
    """
    if not (isfinite(value) and isfinite(error)):
        return unseen(count, unit)
    half = quantile(freedom) * error
    return Estimate(value, value - half, value + half, count, seen, unit)


def quantile(freedom: int) -> float:
    """Return the two-sided 95 % point of Student's distribution; of the normal one for 0."""
    point = 0.5 + CONFIDENCE / 2.0
    return student_quantile(freedom, point) if freedom > 0 else NormalDist().inv_cdf(point)


def of_values(values: FloatArray, least: int, unit: str = "") -> Estimate:
    """Return the mean of independent values, without outliers, seen enough from ``least`` values on."""
    good = without_outliers(np.asarray(values, dtype=float))
    if len(good) < max(2, least):
        return unseen(len(good), unit)
    low, high = mean_interval(good)
    return Estimate(float(good.mean()), low, high, len(good), True, unit)


def widened(estimate: Estimate, share: float) -> Estimate:
    """Return an estimate with what is not random, a relative half width of ``share``, in its interval."""
    if not estimate.seen:
        return estimate
    more = share * abs(estimate.value)
    low = estimate.value - hypot(estimate.value - estimate.low, more)
    high = estimate.value + hypot(estimate.high - estimate.value, more)
    return replace(estimate, low=low, high=high)


def scaled(estimate: Estimate, factor: float) -> Estimate:
    """Return the estimate of something that is this many times as large."""
    value, low, high = (it * factor for it in (estimate.value, estimate.low, estimate.high))
    return replace(estimate, value=value, low=low, high=high)


def not_negative(estimate: Estimate) -> Estimate:
    """Return the estimate of something that cannot be below 0."""
    value, low, high = (max(it, 0.0) for it in (estimate.value, estimate.low, estimate.high))
    return replace(estimate, value=value, low=low, high=high) if isfinite(estimate.value) else estimate


def without_outliers(values: FloatArray, factor: float = 4.0) -> FloatArray:
    """Return the finite values within ``factor`` robust standard deviations of their median."""
    good: FloatArray = values[np.isfinite(values)]
    if len(good) < 4:
        return good
    middle = np.median(good)
    spread = 1.4826 * np.median(np.abs(good - middle))
    kept: FloatArray = good[np.abs(good - middle) <= factor * spread + 1e-12]
    return kept
