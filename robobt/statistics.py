"""Intervals, paired tests and folds for figures that come from trials; usable by itself.

scipy is imported by the functions that need it: matches use this module too, and play without it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from math import atan, cos, log, pi, sin, sqrt
from statistics import NormalDist
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Indices = NDArray[np.intp]


class Interval(NamedTuple):
    """A confidence interval."""

    low: float
    high: float


def wilson_interval(successes: int, trials: int, confidence: float = 0.95) -> Interval:
    """Compute Wilson's score interval for a proportion of ``successes`` in ``trials``.

    Unlike the textbook normal interval it stays inside [0, 1] and keeps its
    coverage when every trial succeeds or none does. No trials at all give (0, 1): nothing is known.

    Raises:
        ValueError: counts or confidence out of range.

    Source: Wilson, "Probable inference, the law of succession, and statistical
    inference", 1927.
    """
    _check_count(successes, trials, confidence)
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


def clopper_pearson_interval(successes: int, trials: int, confidence: float = 0.95) -> Interval:
    """Compute Clopper and Pearson's interval for a proportion, whose coverage is never below its level.

    Arguments and errors as for :func:`wilson_interval`.

    Source: Clopper and Pearson, "The use of confidence or fiducial limits
    illustrated in the case of the binomial", 1934.
    """
    from scipy.special import betaincinv

    _check_count(successes, trials, confidence)
    tail = (1.0 - confidence) / 2.0
    failures = trials - successes
    low = float(betaincinv(successes, failures + 1, tail)) if successes else 0.0
    high = float(betaincinv(successes + 1, failures, 1.0 - tail)) if failures else 1.0
    return Interval(low, high)


def mean_interval(values: ArrayLike, confidence: float = 0.95) -> Interval:
    """Compute Student's interval for the mean of independent values; a single one gives no bounds.

    Raises:
        ValueError: no values, one that is not finite, or confidence out of range.
    """
    sample = np.asarray(values, dtype=np.float64)
    if sample.ndim != 1 or len(sample) == 0 or not np.isfinite(sample).all():
        raise ValueError("a mean needs a list of finite values")
    if not 0.0 < confidence < 1.0:
        raise ValueError(f"confidence must lie between 0 and 1, not {confidence}")
    if len(sample) == 1:
        return Interval(-np.inf, np.inf)
    quantile = student_quantile(len(sample) - 1, 0.5 + confidence / 2.0)
    half = quantile * float(sample.std(ddof=1)) / sqrt(len(sample))
    middle = float(sample.mean())
    return Interval(middle - half, middle + half)


@lru_cache(maxsize=256)
def student_quantile(degrees: int, probability: float) -> float:
    """Return the value below which Student's distribution has a probability.

    Args:
        degrees: of freedom, at least 1.
        probability: more than a half and less than 1.
    """
    low, high = 0.0, 1.0
    while _student_inside(degrees, high) < 2.0 * probability - 1.0:
        low, high = high, 2.0 * high
    while (middle := (low + high) / 2.0) not in (low, high):
        if _student_inside(degrees, middle) < 2.0 * probability - 1.0:
            low = middle
        else:
            high = middle
    return high


def _student_inside(degrees: int, t: float) -> float:
    """Return how probable it is by Student's distribution to be within ``t`` of zero.

    Source: Abramowitz and Stegun, "Handbook of Mathematical Functions", 1964, 26.7.3 and 26.7.4.
    """
    angle = atan(t / sqrt(degrees))
    odd = degrees % 2
    k = np.arange(2 + odd, degrees, 2)
    # Each term is the one before times (k - 1) / k and the squared cosine.
    series = sin(angle) * (1.0 + float(np.cumprod(cos(angle) ** 2 * (k - 1.0) / k).sum()))
    if not odd:
        return series
    return 2.0 / pi * (angle + (cos(angle) * series if degrees > 1 else 0.0))


class PairedTest(NamedTuple):
    """A paired t-test: mean and variance of the differences, t, its degrees of freedom, two-sided p."""

    mean: float
    variance: float
    t: float
    degrees: int
    p: float


def corrected_resampled_t_test(differences: ArrayLike, test_to_train: float) -> PairedTest:
    """Compute the corrected resampled paired t-test.

    The runs of a repeated cross-validation share training data, so that their
    differences vary less than independent ones would. The correction takes
    variance x (1/k + n_test/n_train) for the variance of the mean of k runs.

    Args:
        differences: one a run, at least two.
        test_to_train: n_test / n_train of a run; 1/9 for ten folds, 0 for no correction.

    Returns:
        the test; where all differences are equal, t is infinite and p 0 (equal
        and zero: t is 0 and p 1).

    Raises:
        ValueError: fewer than two differences, one that is not finite, or a negative ratio.

    Source: Nadeau and Bengio, "Inference for the generalization error", 2003.
    """
    from scipy.special import stdtr

    sample = np.asarray(differences, dtype=np.float64)
    if sample.ndim != 1 or len(sample) < 2 or not np.isfinite(sample).all():
        raise ValueError("a paired test needs at least two finite differences")
    if not test_to_train >= 0.0:
        raise ValueError(f"test_to_train must not be negative: {test_to_train}")
    mean = float(sample.mean())
    # Of equal differences the mean may be off by a rounding error, and with it the variance.
    variance = 0.0 if (sample == sample[0]).all() else float(sample.var(ddof=1))
    spread = sqrt(variance * (1.0 / len(sample) + test_to_train))
    degrees = len(sample) - 1
    if spread > 0.0:
        t = mean / spread
        return PairedTest(mean, variance, t, degrees, 2.0 * float(stdtr(degrees, -abs(t))))
    if mean == 0.0:
        return PairedTest(0.0, 0.0, 0.0, degrees, 1.0)
    return PairedTest(mean, 0.0, float(np.copysign(np.inf, mean)), degrees, 0.0)


class McNemar(NamedTuple):
    """McNemar's test: trials that only the first and only the second got right, and two-sided ``p``."""

    only_first: int
    only_second: int
    p: float


def mcnemar(first: ArrayLike, second: ArrayLike) -> McNemar:
    """Test whether two classifiers that judged the same trials are right equally often.

    The test is exact: the binomial test on the trials in which they differ, whose counts are returned too.

    ``first`` and ``second`` (n,) tell whether each was right on each trial.

    Raises:
        ValueError: lists of different length.

    Source: McNemar, "Note on the sampling error of the difference between
    correlated proportions or percentages", 1947.
    """
    a, b = np.asarray(first, dtype=bool), np.asarray(second, dtype=bool)
    if a.ndim != 1 or a.shape != b.shape:
        raise ValueError("both lists must judge the same trials")
    only_first, only_second = int((a & ~b).sum()), int((b & ~a).sum())
    fewer, trials = min(only_first, only_second), only_first + only_second
    # The probability of at most this many heads in n tosses of a coin, in logarithms because n may be a
    # million.
    k = np.arange(fewer)
    ways = np.concatenate([[0.0], np.cumsum(np.log((trials - k) / (k + 1.0)))]) - trials * log(2.0)
    p = 1.0 if 2 * fewer == trials else min(1.0, 2.0 * float(np.exp(ways).sum()))
    return McNemar(only_first, only_second, p)


def paired_difference_interval(first: ArrayLike, second: ArrayLike, confidence: float = 0.95) -> Interval:
    """Compute the interval of the difference of two proportions that come from the same trials.

    ``first`` and ``second`` (n,) tell whether each succeeded in each trial; the difference is
    that of the first less the second.

    Raises:
        ValueError: lists of different length or none, or confidence out of range.

    Source: Bonett and Price, "Adjusted Wald confidence interval for a difference of
    binomial proportions based on paired data", 2012.
    """
    a, b = np.asarray(first, dtype=bool), np.asarray(second, dtype=bool)
    if a.ndim != 1 or a.shape != b.shape or len(a) == 0:
        raise ValueError("both lists must judge the same trials, and at least one")
    _check_count(0, len(a), confidence)
    z = NormalDist().inv_cdf(0.5 + confidence / 2.0)
    trials = len(a) + 2
    gained, lost = (int((a & ~b).sum()) + 1) / trials, (int((b & ~a).sum()) + 1) / trials
    half = z * sqrt((gained + lost - (gained - lost) ** 2) / trials)
    return Interval(max(-1.0, gained - lost - half), min(1.0, gained - lost + half))


_BETS = np.array([0.1, 0.3, 0.5, 0.7, 0.9])
"""Shares of what one has that are bet on the next value being negative."""


def surely_negative(values: ArrayLike, error: float = 0.05) -> int | None:
    """Return after how many values, looked at one by one, their mean is surely negative; None: never.

    For any number and distribution of values, a mean of 0 or more is called negative with a probability of at
    most ``error``, because a fair bet wins 1 / ``error`` times the stake with at most that probability.

    Args:
        values: (n,) in the order in which they came, each -1 to 1.
        error: 0 to 1, both excluded.

    Raises:
        ValueError: a value or the error is out of range.

    Source: Waudby-Smith and Ramdas, "Estimating means of bounded random variables by betting", 2024.
    """
    sample = np.asarray(values, dtype=np.float64)
    if sample.ndim != 1 or not (np.abs(sample) <= 1.0).all() or not 0.0 < error < 1.0:
        raise ValueError("needs a list of values from -1 to 1, and an error between 0 and 1")
    with np.errstate(over="ignore"):
        won = np.cumprod(1.0 - _BETS * sample[:, None], axis=0).mean(axis=1)
    over = np.flatnonzero(won >= 1.0 / error)
    return int(over[0]) + 1 if len(over) else None


def holm(p_values: Sequence[float]) -> list[float]:
    """Return ``p_values`` corrected for their number, in their order.

    Source: Holm, "A simple sequentially rejective multiple test procedure", 1979.
    """
    corrected, least = [0.0] * len(p_values), 0.0
    for rank, place in enumerate(sorted(range(len(p_values)), key=p_values.__getitem__)):
        least = max(least, min(1.0, p_values[place] * (len(p_values) - rank)))
        corrected[place] = least
    return corrected


@dataclass(frozen=True)
class ReliabilityBin:
    """Trials with predictions in ``low`` to ``high``.

    Attributes:
        low, high: the bin.
        trials: how many there are.
        predicted: their mean prediction.
        observed: the share of successes.
    """

    low: float
    high: float
    trials: int
    predicted: float
    observed: float


def reliability(probabilities: ArrayLike, outcomes: ArrayLike, bins: int = 10) -> list[ReliabilityBin]:
    """Compare predictions with outcomes; return the non-empty bins of equal width.

    ``probabilities`` (n,) were predicted; ``outcomes`` (n,) are 0 or 1.

    Raises:
        ValueError: lists of different length or none, no bin, or values outside [0, 1].
    """
    predicted, came = _forecasts(probabilities, outcomes)
    if bins < 1:
        raise ValueError(f"{bins} bins")
    places = np.minimum((predicted * bins).astype(int), bins - 1)
    return [
        ReliabilityBin(
            float(k / bins),
            float((k + 1) / bins),
            int((places == k).sum()),
            float(predicted[places == k].mean()),
            float(came[places == k].mean()),
        )
        for k in np.unique(places)
    ]


def calibration_error(probabilities: ArrayLike, outcomes: ArrayLike, bins: int = 10) -> float:
    """Return the expected calibration error: the mean gap of predicted and observed, weighted by trials.

    Arguments and errors as for :func:`reliability`.

    Source: Naeini, Cooper and Hauskrecht, "Obtaining well calibrated probabilities
    using Bayesian binning", 2015.
    """
    table = reliability(probabilities, outcomes, bins)
    total = sum(row.trials for row in table)
    return sum(row.trials * abs(row.predicted - row.observed) for row in table) / total


def _forecasts(
    probabilities: ArrayLike, outcomes: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    predicted, came = np.asarray(probabilities, dtype=np.float64), np.asarray(outcomes, dtype=np.float64)
    if predicted.ndim != 1 or predicted.shape != came.shape or len(predicted) == 0:
        raise ValueError("there must be as many outcomes as probabilities, and at least one")
    if not (((predicted >= 0.0) & (predicted <= 1.0)).all() and np.isin(came, (0.0, 1.0)).all()):
        raise ValueError("probabilities lie in [0, 1] and outcomes are 0 or 1")
    return predicted, came


def _check_count(successes: int, trials: int, confidence: float) -> None:
    if trials < 0 or not 0 <= successes <= trials:
        raise ValueError(f"{successes} successes of {trials} trials is not a count")
    if not 0.0 < confidence < 1.0:
        raise ValueError(f"confidence must lie between 0 and 1, not {confidence}")
