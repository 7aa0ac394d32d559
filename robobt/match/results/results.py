"""Results of one trial, and of many."""

from __future__ import annotations

import hashlib
import json
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields
from functools import cache
from html import escape
from statistics import fmean, variance
from typing import TypeVar

from pydantic import ConfigDict, TypeAdapter, ValidationError

from robobt.match.results.delays import DelayResult
from robobt.match.results.teams import TeamResult
from robobt.statistics import wilson_interval

T = TypeVar("T")

_AS_WRITTEN = ConfigDict(extra="forbid", allow_inf_nan=False)


@dataclass(slots=True)
class RobotResult:
    """One robot's figures in one trial.

    Attributes:
        go_to_ball: time from the start until it first had the ball in its mouth [s], or None.
        shoot: time from then until its first kick [s], or None.
        kicks: number of kicks.
        errors: number of ticks at which its tree failed and the robot was stopped.
        first_error: the first error, with the node's path; or None.
        always_failed: the node and the one reason for which its tree failed at every tick, else None.
    """

    __pydantic_config__ = _AS_WRITTEN

    go_to_ball: float | None = None
    shoot: float | None = None
    kicks: int = 0
    errors: int = 0
    first_error: str | None = None
    always_failed: str | None = None

    @property
    def total(self) -> float | None:
        """Time from the start to the first kick [s]."""
        return None if self.go_to_ball is None or self.shoot is None else self.go_to_ball + self.shoot


@dataclass(slots=True, frozen=True)
class MatchResult:
    """One trial.

    Attributes:
        scenario: name of the scenario.
        trial: number of the trial, from 0.
        seed: seed of the trial.
        outcome: how the trial ended, one of :class:`robobt.match.ends.Outcome`.
        time: simulated duration [s].
        blue_score, yellow_score: goals.
        in_play: share of the time with the ball in play, 0 to 1.
        ticks: number of control periods.
        robots: figures of each robot by its name ("blue 0").
        trace: hash over every true state; equal traces mean equal matches.
        wall_time: real time of playing, without compilation [s]; only this may differ between two runs.
        teams: figures of each team by its name ("blue"), if there was a referee.
        delays: where delays are measured, each robot's by its name; None if not seen enough.
    """

    __pydantic_config__ = _AS_WRITTEN

    scenario: str
    trial: int
    seed: int
    outcome: str
    time: float
    blue_score: int
    yellow_score: int
    in_play: float
    ticks: int
    robots: Mapping[str, RobotResult]
    trace: str
    wall_time: float = 0.0
    teams: Mapping[str, TeamResult] = field(default_factory=dict)
    delays: Mapping[str, DelayResult | None] = field(default_factory=dict)

    def _repr_html_(self) -> str:
        """Return the HTML for a notebook."""
        rows = [
            ("outcome", self.outcome),
            ("goals", f"blue {self.blue_score}, yellow {self.yellow_score}"),
            ("time", f"{self.time:.2f} s, ball in play {self.in_play:.0%} of it"),
            ("seed, trace", f"{self.seed}, {self.trace}"),
        ]
        body = "".join([f"<tr><th>{name}</th><td>{escape(value)}</td></tr>" for name, value in rows])
        return f"<table><caption>{escape(self.scenario)}, trial {self.trial}</caption>{body}</table>"

    def to_json(self) -> dict[str, object]:
        """Return plain data; the keys are the attributes' names."""
        return asdict(self)

    @classmethod
    def from_json(cls, data: Mapping[str, object]) -> MatchResult:
        """Return the result from the data of :meth:`to_json`.

        Raises:
            ValueError: the data is not such a result.
        """
        return result_from(_adapter(), data)


def result_from(kind: TypeAdapter[T], data: Mapping[str, object]) -> T:
    """Make one trial's result, a dataclass of that kind, of the plain data of its attributes.

    Raises:
        ValueError: the data is not such a result.
    """
    try:
        return kind.validate_json(json.dumps(data, allow_nan=False), strict=True)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        place = ".".join([str(part) for part in first["loc"]])
        raise ValueError(f"not the result of a trial: {place}: {first['msg']}") from error
    except (TypeError, ValueError, RecursionError) as error:
        raise ValueError(f"not the result of a trial: {error}") from error


@cache
def _adapter() -> TypeAdapter[MatchResult]:
    return TypeAdapter(MatchResult)


@dataclass(slots=True, frozen=True)
class Rate:
    """How often an event happened in trials.

    It happened in ``count`` trials, a share ``rate``, with the 95 % Wilson interval from ``low`` to ``high``.
    Repeated trials count once for the interval; if all trials are the same there is no interval.
    """

    count: int
    rate: float
    low: float | None
    high: float | None

    @classmethod
    def of(cls, happened: Sequence[bool], traces: Sequence[str]) -> Rate:
        """Return the rate of what ``happened`` in trials with these ``traces``; 0 without trials."""
        different = list(dict(zip(traces, happened, strict=True)).values())
        rate = sum(happened) / len(happened) if happened else 0.0
        if len(different) == 1 < len(happened):
            return cls(sum(happened), rate, None, None)
        return cls(sum(happened), rate, *wilson_interval(sum(different), len(different)))

    def interval(self, digits: int = 0) -> str:
        """Return the interval as text, in percent with ``digits`` after the point."""
        if self.low is None or self.high is None:
            return "none: one trial, repeated"
        return f"{self.low:.{digits}%} to {self.high:.{digits}%}"


@dataclass(slots=True, frozen=True)
class Spread:
    """Mean and variance of a figure.

    ``n`` is the number of trials that have the figure; ``mean`` is None without any, the sample's
    ``variance`` is None with fewer than two.
    """

    n: int
    mean: float | None
    variance: float | None

    @classmethod
    def of(cls, values: Iterable[float | None]) -> Spread:
        """Return the spread of the values that are not None."""
        given = [value for value in values if value is not None]
        return cls(len(given), fmean(given) if given else None, variance(given) if len(given) > 1 else None)


@dataclass(slots=True, frozen=True)
class RobotSummary:
    """One robot's figures over all trials; times in seconds, kicks a trial; else as of one trial."""

    go_to_ball: Spread
    shoot: Spread
    total: Spread
    kicks: Spread
    errors: int
    first_error: str | None
    always_failed: str | None


@dataclass(slots=True, frozen=True)
class Summary:
    """All trials of a run together.

    Attributes:
        scenario: name of the scenario.
        seed: the run's seed, from which the trials' seeds are derived.
        trials: how many were played.
        distinct: how many of them differ from each other; the rest repeat one another.
        outcomes: rate of each outcome that happened.
        goals: goals of each team: ``total``, and ``trials`` in which it scored.
        time: simulated duration of the trials [s].
        in_play: mean share of the time with the ball in play.
        robots: figures by robot.
        real_time_factor: simulated time over wall time in each process, without compiling; load lowers it.
        trace: hash over the trials' traces, in order; equal for equal runs.
        teams: for each team the figures of :class:`~robobt.match.results.teams.TeamResult`, by name.
    """

    scenario: str
    seed: int
    trials: int
    distinct: int
    outcomes: Mapping[str, Rate]
    goals: Mapping[str, GoalCount]
    time: Spread
    in_play: float
    robots: Mapping[str, RobotSummary]
    real_time_factor: float
    trace: str
    teams: Mapping[str, Mapping[str, Spread]]

    def to_json(self) -> dict[str, object]:
        """Return plain data; the keys are the attributes' names."""
        return asdict(self)


@dataclass(slots=True, frozen=True)
class GoalCount:
    """A team's ``total`` of goals, and the ``trials`` in which it scored."""

    total: int
    trials: Rate


def summarise(results: Sequence[MatchResult], seed: int = 0) -> Summary:
    """Summarise trials of one scenario, in the order of their numbers.

    Args:
        results: one per trial.
        seed: the run's seed, reported with the figures.

    Raises:
        ValueError: there is no trial.
    """
    if not results:
        raise ValueError("no trial was played")
    ordered = sorted(results, key=lambda result: result.trial)
    outcomes = Counter(result.outcome for result in ordered)
    traces = [result.trace for result in ordered]
    wall_time = sum(result.wall_time for result in ordered)
    simulated = sum(result.time for result in ordered)
    return Summary(
        scenario=ordered[0].scenario,
        seed=seed,
        trials=len(ordered),
        distinct=len(set(traces)),
        outcomes={
            name: Rate.of([result.outcome == name for result in ordered], traces)
            for name, _ in outcomes.most_common()
        },
        goals={
            "blue": _goals([result.blue_score for result in ordered], traces),
            "yellow": _goals([result.yellow_score for result in ordered], traces),
        },
        time=Spread.of(result.time for result in ordered),
        in_play=fmean(result.in_play for result in ordered),
        robots={
            name: _robot([result.robots[name] for result in ordered if name in result.robots])
            for name in ordered[0].robots
        },
        real_time_factor=simulated / wall_time if wall_time > 0.0 else 0.0,
        trace=hashlib.blake2b("".join(traces).encode(), digest_size=16).hexdigest(),
        teams={
            name: _team([result.teams[name] for result in ordered if name in result.teams])
            for name in ordered[0].teams
        },
    )


def _team(results: Sequence[TeamResult]) -> dict[str, Spread]:
    return {
        figure.name: Spread.of(getattr(result, figure.name) for result in results)
        for figure in fields(TeamResult)
    }


def _goals(scores: Sequence[int], traces: Sequence[str]) -> GoalCount:
    return GoalCount(sum(scores), Rate.of([score > 0 for score in scores], traces))


def _robot(results: Sequence[RobotResult]) -> RobotSummary:
    errors = [result.first_error for result in results if result.first_error is not None]
    reasons = {result.always_failed for result in results}
    return RobotSummary(
        go_to_ball=Spread.of(result.go_to_ball for result in results),
        shoot=Spread.of(result.shoot for result in results),
        total=Spread.of(result.total for result in results),
        kicks=Spread.of(result.kicks for result in results),
        errors=sum(result.errors for result in results),
        first_error=errors[0] if errors else None,
        always_failed=reasons.pop() if len(reasons) == 1 else None,
    )
