"""Bradley-Terry ratings on the Elo scale, with intervals."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from math import log, sqrt
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ELO = 400.0 / log(10.0)
"""Elo points of one unit of log odds: 400 points are odds of ten to one."""

_PRIOR = 1.0
"""Prior draws of every entrant against an average one, so that winning all matches gives a finite rating."""

_NEWTON_STEPS = 100
"""Newton's steps at most; a fit takes about ten."""


@dataclass(slots=True, frozen=True)
class Rating:
    """Strength in Elo points above the reference, with its confidence interval.

    The interval of the reference itself is the point 0.
    """

    elo: float
    low: float
    high: float


def expected_score(elo: float) -> float:
    """Return the mean score, with a draw as half a win, of an entrant this many Elo points stronger."""
    return float(1.0 / (1.0 + 10.0 ** (-elo / 400.0)))


def bradley_terry(
    names: Sequence[str],
    scores: Iterable[tuple[str, str, float]],
    reference: str | None = None,
) -> dict[str, Rating]:
    """Fit the strengths under which the results are most likely.

    The probability that one scores against another is the logistic function of the
    difference of their strengths; a draw is half a win. One draw each with an average
    stranger is added as a prior, which keeps the strengths finite. Intervals follow
    from the curvature at the fit (Laplace); with draws they are slightly too wide, because a draw varies less
    than a win and a loss.

    Args:
        names: all rated entrants.
        scores: for each match the two that met, and the first one's score: 1, 0.5 or 0.
        reference: the entrant with strength 0; by default the mean strength is 0.

    Returns:
        the ratings by name.

    Raises:
        ValueError: a score is not between 0 and 1, or names somebody unknown.

    Source: Bradley and Terry, "Rank analysis of incomplete block designs: the method
    of paired comparisons", 1952; the prior after Coulom's BayesElo, 2005.
    """
    index = {name: number for number, name in enumerate(names)}
    met, won = np.zeros((len(names), len(names))), np.zeros(len(names))
    for first, second, score in scores:
        if first not in index or second not in index or not 0.0 <= score <= 1.0:
            raise ValueError(f"{first} v {second}: {score} is not a score of two that are rated")
        i, j = index[first], index[second]
        met[i, j] += 1.0
        met[j, i] += 1.0
        won[i] += score
        won[j] += 1.0 - score
    strength, precision = _fit(met, won)
    covariance = np.linalg.inv(precision)
    contrasts = np.eye(len(names))
    contrasts -= 1.0 / len(names) if reference is None else contrasts[index[reference]]
    elo = ELO * contrasts @ strength
    spread = ELO * np.sqrt(np.maximum(0.0, np.einsum("ij,jk,ik->i", contrasts, covariance, contrasts)))
    half = NormalDist().inv_cdf(0.975) * spread
    return {
        name: Rating(float(elo[number]), float(elo[number] - half[number]), float(elo[number] + half[number]))
        for name, number in index.items()
    }


def _fit(
    met: NDArray[np.float64], won: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the strengths (n,), in log odds, and the curvature of the likelihood (n, n) there.

    Args:
        met: how often each met each (n, n).
        won: points of each (n,).
    """
    strength = np.zeros(len(won))
    for _ in range(_NEWTON_STEPS):
        chance = 1.0 / (1.0 + np.exp(strength[None, :] - strength[:, None]))
        stranger = 1.0 / (1.0 + np.exp(-strength))
        slope = won - (met * chance).sum(1) + _PRIOR * (0.5 - stranger)
        weight = met * chance * (1.0 - chance)
        curvature = np.diag(weight.sum(1) + _PRIOR * stranger * (1.0 - stranger)) - weight
        step = np.linalg.solve(curvature, slope)
        # The likelihood is concave; a long step from far away could still pass the top.
        step *= min(1.0, 2.0 / max(1e-12, float(np.abs(step).max())))
        strength += step
        if sqrt(float(step @ step)) < 1e-10:
            break
    return strength, curvature
