"""The sequential test of pairs of matches: stop as soon as the evidence for better or not better is enough.

Two matches with one seed, either entrant once on either side, are one pair; its score is 0 to 1 in
quarters, five outcomes (hence pentanomial). What both matches owe to the seed cancels inside the pair.

Source: Wald, "Sequential tests of statistical hypotheses", 1945, for the test; Van den Bergh, "A practical
introduction to the GSPRT", 2020, for the likelihood ratio of the mean of a distribution that is not known.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence
from dataclasses import asdict, dataclass
from enum import StrEnum
from itertools import count
from math import log
from statistics import fmean

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robobt.config.wording import counted
from robobt.tournament.fixtures import Fixture
from robobt.tournament.played import PlayedMatch
from robobt.tournament.ratings import expected_score
from robobt.tournament.standings import rounds_of

SCORES = np.array([0.0, 0.25, 0.5, 0.75, 1.0])
"""Possible scores of a pair of matches."""

_PRIOR_PAIRS = 1e-3
"""Pairs that an outcome counts for before any was seen, so that none is thought impossible."""

_BISECTIONS = 60

_MOST_ELO = 1000.0
"""Largest strength that can be distinguished from never losing a match: a score of 99.7 % [Elo]."""


class Verdict(StrEnum):
    """The verdict of a sequential test."""

    BETTER = "better"
    NOT_BETTER = "not better"
    UNDECIDED = "undecided"


@dataclass(slots=True, frozen=True)
class SequentialTest:
    """Whether one is at least ``elo1`` points stronger than another, or at most ``elo0``.

    Attributes:
        elo0: of who is not better, in Elo points of single matches.
        elo1: of who is better; above ``elo0``, both within ±1000.
        alpha: how often at most "better" may be said of a difference of ``elo0`` or less.
        beta: how often at most "not better" may be said of a difference of ``elo1`` or more.
    """

    elo0: float
    elo1: float
    alpha: float = 0.05
    beta: float = 0.05

    def __post_init__(self) -> None:
        if not -_MOST_ELO <= self.elo0 < self.elo1 <= _MOST_ELO:
            raise ValueError(
                f"elo0 must be below elo1, both within ±{_MOST_ELO:g}, not {self.elo0:g} and {self.elo1:g}"
            )
        for name in ("alpha", "beta"):
            if not 0.0 < getattr(self, name) < 0.5:
                raise ValueError(f"{name} must lie between 0 and 0.5, not {getattr(self, name):g}")

    @property
    def bounds(self) -> tuple[float, float]:
        """The log-likelihood ratios at which it says "not better" and "better"."""
        return log(self.beta / (1.0 - self.alpha)), log((1.0 - self.beta) / self.alpha)

    def ratio(self, counts: ArrayLike) -> NDArray[np.float64]:
        """Return the log-likelihood ratio of "better" over "not better".

        ``counts`` (..., 5) are pairs by their score, worst first.
        """
        seen = np.asarray(counts, dtype=np.float64)
        total = seen.sum(-1)
        shares = (seen + _PRIOR_PAIRS) / (seen + _PRIOR_PAIRS).sum(-1, keepdims=True)
        likely = [_tilted(shares, expected_score(elo)) for elo in (self.elo0, self.elo1)]
        found: NDArray[np.float64] = total * (shares * np.log(likely[1] / likely[0])).sum(-1)
        return found

    def judge(self, pairs: Sequence[float]) -> tuple[Verdict, int, float]:
        """Judge pairs in their order, until the evidence is enough.

        Args:
            pairs: their scores, 0 to 1 in quarters.

        Returns:
            the verdict, the number of pairs it took, and the log-likelihood ratio there.
        """
        steps = np.zeros((len(pairs), len(SCORES)))
        steps[np.arange(len(pairs)), np.rint(np.asarray(pairs) * 4.0).astype(int)] = 1.0
        ratios = self.ratio(np.cumsum(steps, axis=0))
        low, high = self.bounds
        over = np.flatnonzero((ratios <= low) | (ratios >= high))
        if not len(over):
            return Verdict.UNDECIDED, len(pairs), float(ratios[-1]) if len(pairs) else 0.0
        at = int(over[0])
        verdict = Verdict.BETTER if ratios[at] >= high else Verdict.NOT_BETTER
        return verdict, at + 1, float(ratios[at])


class RunningTest:
    """A sequential test that runs while its matches are played.

    Which rounds count says :func:`scores_of`.

    Args:
        test: what is asked.
        first: the entrant that may be better.
        second: the entrant it is compared with.
        first_round: number of the first round that counts.

    Attributes:
        verdict: the verdict so far.
        rounds: number of rounds so far.
        ratio: the log-likelihood ratio there.
    """

    def __init__(self, test: SequentialTest, first: str, second: str, first_round: int = 0) -> None:
        self.verdict, self.rounds, self.ratio = Verdict.UNDECIDED, 0, 0.0
        self._test, self._first, self._second, self._first_round = test, first, second, first_round

    def enough(self, matches: Iterable[PlayedMatch], failed: Collection[Fixture] = ()) -> bool:
        """Return whether the evidence is enough.

        Args:
            matches: what was played so far.
            failed: what could not be played.
        """
        scores = scores_of(matches, self._first, self._second, failed, self._first_round)
        self.verdict, self.rounds, self.ratio = self._test.judge(list(scores.values()))
        return self.verdict is not Verdict.UNDECIDED

    def brief(self) -> str:
        """Return how far it is, in a few words."""
        low, high = self._test.bounds
        return f"{counted(self.rounds, 'round')}, {low:.2f} < {self.ratio:+.2f} < {high:.2f}"

    def line(self) -> str:
        """Return what it says, with its bounds."""
        test, (low, high) = self._test, self._test.bounds
        said = {
            Verdict.BETTER: f"{self._first} is better than {self._second}",
            Verdict.NOT_BETTER: f"{self._first} is not better than {self._second}",
            Verdict.UNDECIDED: f"undecided between {self._first} and {self._second}",
        }[self.verdict]
        return (
            f"Sequential test: {said} after {counted(self.rounds, 'round')}. "
            f"Log-likelihood ratio {self.ratio:+.2f} of {test.elo1:+g} to {test.elo0:+g} Elo, "
            f"bounds {low:.2f} (beta {test.beta:g}) and {high:.2f} (alpha {test.alpha:g})."
        )

    def to_json(self) -> dict[str, object]:
        """Return plain data."""
        found = {"verdict": self.verdict.value, "rounds": self.rounds, "ratio": self.ratio}
        return {**asdict(self._test), **found, "bounds": self._test.bounds}


def scores_of(
    matches: Iterable[PlayedMatch],
    first: str,
    second: str,
    failed: Collection[Fixture] = (),
    first_round: int = 0,
) -> dict[int, float]:
    """Return what the first entrant scores, 0 to 1, in each round that counts, by its number.

    Only rounds before the first that is still being played count, so that no verdict depends on which
    match ends first. A round with a match that could not be played is left out, and so is one that
    repeats another move for move.

    Args:
        matches: what was played so far.
        first: whose scores.
        second: whom it met.
        failed: what could not be played.
        first_round: number of the first round that counts.
    """
    pairs = rounds_of(matches, first, second)
    left_out = {fixture.round for fixture in failed if {first, second} == {fixture.blue, fixture.yellow}}
    scores: dict[tuple[object, ...], tuple[int, float]] = {}
    for number in count(first_round):
        if number in pairs:
            pair = pairs[number]
            traces = tuple([match.trace or match.round for match in pair])
            scores.setdefault(traces, (number, fmean(match.score(first) for match in pair)))
        elif number not in left_out:
            break
    return dict(scores.values())


def _tilted(shares: NDArray[np.float64], mean: float) -> NDArray[np.float64]:
    """Return the distributions with this mean that make pairs with these shares (..., 5) most likely.

    They are shares / (1 + t (score - mean)), with the t for which the mean is right: it
    is the root of a falling function between the poles.
    """
    gap = SCORES - mean
    low = np.full(shares.shape[:-1], -1.0 / gap[-1])
    high = np.full(shares.shape[:-1], -1.0 / gap[0])
    for _ in range(_BISECTIONS):
        tilt = 0.5 * (low + high)
        rest = (shares * gap / (1.0 + tilt[..., None] * gap)).sum(-1)
        low, high = np.where(rest > 0.0, tilt, low), np.where(rest > 0.0, high, tilt)
    found: NDArray[np.float64] = shares / (1.0 + (0.5 * (low + high))[..., None] * gap)
    return found
