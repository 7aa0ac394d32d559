"""Comparison of variants of one scenario, paired by trials with the same starts."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from statistics import fmean

from robobt.match.results.results import MatchResult, Rate, Spread
from robobt.statistics import holm, mcnemar, mean_interval, paired_difference_interval


@dataclass(frozen=True)
class Difference:
    """A paired difference to the first variant, with its 95 % interval.

    Attributes:
        n: number of distinct pairs of trials in which both have the figure.
        mean: mean difference, this variant minus the first; None without such a pair.
        low, high: its interval; None if all trials, or all differences, are equal.
    """

    n: int
    mean: float | None
    low: float | None
    high: float | None


@dataclass(frozen=True)
class AgainstFirst:
    """One variant compared with the first, paired by trial.

    Attributes:
        scored: difference in the share of trials in which blue scores.
        only_this, only_first: trials in which blue scores with this variant alone, and with the first alone.
        p: p value of McNemar's exact two-sided test; ``holm`` is corrected for the number of variants.
        goals: difference in blue's goals minus yellow's, per trial.
        to_ball, to_kick: difference in the time until blue's first robot has the ball, and until it has
            kicked [s].
    """

    scored: Difference
    only_this: int
    only_first: int
    p: float
    holm: float
    goals: Difference
    to_ball: Difference
    to_kick: Difference


@dataclass(frozen=True)
class Compared:
    """One variant's figures.

    Attributes:
        trials: how many were played.
        distinct: number of different trials among them; the others repeat these.
        scored: trials in which blue scores.
        outcomes: how the trials ended.
        to_ball, to_kick: as in :class:`AgainstFirst` [s].
        errors: number of ticks in which a robot's tree failed; ``first_error`` is the first error, or None.
        against_first: None for the first variant.
    """

    trials: int
    distinct: int
    scored: Rate
    outcomes: Mapping[str, int]
    to_ball: Spread
    to_kick: Spread
    errors: int
    first_error: str | None
    against_first: AgainstFirst | None


def compare_results(variants: Mapping[str, Sequence[MatchResult]]) -> dict[str, Compared]:
    """Return the figures of ``variants``, each compared with the first by trial number.

    Raises:
        ValueError: a variant has no trial, or none in common with the first.
    """
    (first, baseline), *others = variants.items()
    pairs = {label: _paired(results, baseline) for label, results in others}
    for label, results in variants.items():
        if not results or not pairs.get(label, [()]):
            raise ValueError(f"{label} has no trial to compare with")
    tests = {
        label: mcnemar([_scores(a) for a, _ in pair], [_scores(b) for _, b in pair])
        for label, pair in pairs.items()
    }
    corrected = dict(zip(tests, holm([test.p for test in tests.values()]), strict=True))
    found = {first: _figures(baseline, None)}
    for label, pair in pairs.items():
        test = tests[label]
        alike = len(pair) == 1
        against = AgainstFirst(
            _share_difference(pair, alike),
            test.only_first,
            test.only_second,
            test.p,
            corrected[label],
            _difference(((_lead(a), _lead(b)) for a, b in pair), alike),
            _difference(((_to_ball(a), _to_ball(b)) for a, b in pair), alike),
            _difference(((_to_kick(a), _to_kick(b)) for a, b in pair), alike),
        )
        found[label] = _figures(variants[label], against)
    return found


def _paired(
    results: Sequence[MatchResult], baseline: Sequence[MatchResult]
) -> list[tuple[MatchResult, MatchResult]]:
    """Return the distinct pairs of trials; a repeated pair gives no new information."""
    by_trial = {result.trial: result for result in baseline}
    pairs = [(result, by_trial[result.trial]) for result in results if result.trial in by_trial]
    return list({(this.trace, first.trace): (this, first) for this, first in pairs}.values())


def _figures(results: Sequence[MatchResult], against: AgainstFirst | None) -> Compared:
    failed = [(name, robot) for result in results for name, robot in result.robots.items() if robot.errors]
    return Compared(
        len(results),
        len({result.trace for result in results}),
        Rate.of([_scores(result) for result in results], [result.trace for result in results]),
        dict(Counter(result.outcome for result in results).most_common()),
        Spread.of(map(_to_ball, results)),
        Spread.of(map(_to_kick, results)),
        sum(robot.errors for _, robot in failed),
        f"{failed[0][0]}: {failed[0][1].first_error}" if failed else None,
        against,
    )


def _scores(result: MatchResult) -> bool:
    return result.blue_score > 0


def _lead(result: MatchResult) -> float:
    return result.blue_score - result.yellow_score


def _to_ball(result: MatchResult) -> float | None:
    return _soonest(robot.go_to_ball for name, robot in result.robots.items() if name.startswith("blue"))


def _to_kick(result: MatchResult) -> float | None:
    return _soonest(robot.total for name, robot in result.robots.items() if name.startswith("blue"))


def _soonest(times: Iterable[float | None]) -> float | None:
    return min((time for time in times if time is not None), default=None)


def _share_difference(pair: Sequence[tuple[MatchResult, MatchResult]], alike: bool) -> Difference:
    this, first = [_scores(a) for a, _ in pair], [_scores(b) for _, b in pair]
    mean = fmean(this) - fmean(first)
    if alike:
        return Difference(len(pair), mean, None, None)
    return Difference(len(pair), mean, *paired_difference_interval(this, first))


def _difference(values: Iterable[tuple[float | None, float | None]], alike: bool) -> Difference:
    gaps = [this - first for this, first in values if this is not None and first is not None]
    if not gaps:
        return Difference(0, None, None, None)
    if alike or len(set(gaps)) == 1:
        return Difference(len(gaps), fmean(gaps), None, None)
    return Difference(len(gaps), fmean(gaps), *mean_interval(gaps))
