"""Error rates and durations of a sequential test, from many tests of entrants of known strength."""

from __future__ import annotations

from dataclasses import dataclass
from math import exp

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from robobt.statistics import Interval, wilson_interval
from robobt.tournament.ratings import ELO, expected_score
from robobt.tournament.sequential import SCORES, SequentialTest

_QUADRATURE_NODES = 41
"""Points at which the effect of the starts is averaged."""


@dataclass(slots=True, frozen=True)
class Simulated:
    """Many tests of one strength.

    Attributes:
        elo: by how much the entrant is stronger.
        tests: how many were made.
        better, not_better: how many said so; the others were undecided at the cap.
        better_interval, not_better_interval: 95 % intervals of these shares (Wilson).
        mean_rounds, median_rounds: how long they took.
    """

    elo: float
    tests: int
    better: int
    not_better: int
    better_interval: Interval
    not_better_interval: Interval
    mean_rounds: float
    median_rounds: float


def round_chances(elo: float, draws: float, spread: float) -> NDArray[np.float64]:
    """Return how likely each score of a round is, worst first (5,).

    A match between equals is drawn with the chance ``draws``; otherwise chances are those of
    Davidson's model. Starts favour one side by an advantage that is normal with the deviation
    ``spread``, the same in both matches of a round. Both are averaged so that a match's
    mean score is the one of ``elo``.

    Args:
        elo: by how much the entrant is stronger [Elo].
        draws: 0 to below 1.
        spread: [Elo].

    Source: Davidson, "On extending the Bradley-Terry model to accommodate ties in paired
    comparison experiments", 1970.
    """
    nodes, weights = np.polynomial.hermite_e.hermegauss(_QUADRATURE_NODES)
    weights = weights / weights.sum()
    tie = 2.0 * draws / (1.0 - draws)

    def match(edge: float) -> NDArray[np.float64]:
        """Return the chances to lose, draw and win with an edge in log odds."""
        chances = np.array([exp(-edge / 2.0), tie, exp(edge / 2.0)])
        found: NDArray[np.float64] = chances / chances.sum()
        return found

    def chances(edge: float) -> NDArray[np.float64]:
        total = np.zeros(len(SCORES))
        for node, weight in zip(nodes, weights, strict=True):
            start = node * spread / ELO
            total += weight * np.convolve(match(edge + start), match(edge - start))
        return total

    def off(edge: float) -> float:
        return float(chances(edge) @ SCORES) - expected_score(elo)

    return chances(float(brentq(off, -20.0, 20.0)))


def simulate(
    test: SequentialTest,
    elo: float,
    tests: int,
    most_rounds: int,
    rng: np.random.Generator,
    draws: float = 0.25,
    spread: float = 100.0,
) -> Simulated:
    """Simulate many tests of an entrant that is stronger by ``elo`` points. Return the results.

    Args:
        test: what is asked.
        elo: by how much the entrant is stronger [Elo].
        tests: how many are made.
        most_rounds: number of rounds after which a test is given up.
        rng: source of randomness.
        draws: share of draws between equals, as for :func:`round_chances`.
        spread: standard deviation of the starts' advantage, as for :func:`round_chances` [Elo].
    """
    chances = round_chances(elo, draws, spread)
    low, high = test.bounds
    counts = np.zeros((tests, len(SCORES)))
    going = np.arange(tests)
    better = not_better = 0
    lengths = np.full(tests, most_rounds)
    for number in range(1, most_rounds + 1):
        scores = rng.choice(len(SCORES), size=len(going), p=chances)
        counts[going, scores] += 1.0
        ratio = test.ratio(counts[going])
        up, down = ratio >= high, ratio <= low
        better += int(up.sum())
        not_better += int(down.sum())
        lengths[going[up | down]] = number
        going = going[~(up | down)]
        if not len(going):
            break
    return Simulated(
        elo,
        tests,
        better,
        not_better,
        wilson_interval(better, tests),
        wilson_interval(not_better, tests),
        float(lengths.mean()),
        float(np.median(lengths)),
    )
