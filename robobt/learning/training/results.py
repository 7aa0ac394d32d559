"""Results of training runs: evaluations in training, held-out figures, and summaries of several seeds."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from typing import TypedDict

import numpy as np
from numpy.typing import NDArray

from robobt.learning.agents.networks import Actor
from robobt.learning.training.settings import TrainSettings
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


BARS: dict[str, tuple[float, float]] = {"go_to_ball": (0.995, 1.04), "shoot": (0.98, 0.45)}
"""The bar for "learned": success rate, and time over the optimum or, for Shoot, until the kick [s]."""


@dataclass(frozen=True, slots=True)
class Validation:
    """An evaluation on the validation starts during training.

    Attributes:
        steps, updates: so far.
        success: share of the starts.
        mean_time: of the successes [s]; None without any.
        time_ratio: that time over the optimum; None where unknown.
        mean_return: undiscounted; no measure of how good the policy is.
        cpu_s: CPU time spent on collecting and learning.
        evaluation_cpu_s: CPU time spent on evaluations.
        wall_s: time passed, that of interrupted processes included.
        steps_per_second: environment steps by wall time since the last evaluation, evaluations not counted.
        losses: means since the last evaluation of what the learner reports (losses, gradient norms,
            approximate KL and so on, by name); None for a figure that is not finite, {} without updates.
        terms: mean contribution of each term of the reward to ``mean_return``, by its name.
    """

    steps: int
    updates: int
    success: float
    mean_time: float | None
    time_ratio: float | None
    mean_return: float
    cpu_s: float
    evaluation_cpu_s: float
    wall_s: float
    steps_per_second: float
    losses: dict[str, float | None] = field(default_factory=dict)
    terms: dict[str, float] = field(default_factory=dict)

    def score(self, enough: float = 1.0) -> tuple[float, float]:
        """Return the key by which policies are ranked: success up to ``enough``, then speed."""
        return (min(self.success, enough), float("-inf") if self.mean_time is None else -self.mean_time)

    def reaches(self, success: float, time: float = float("inf")) -> bool:
        """Return whether success rate and time (over the optimum where that is known) reach a bar."""
        taken = self.mean_time if self.time_ratio is None else self.time_ratio
        return self.success >= success and taken is not None and taken <= time


class HeldOutFigures(TypedDict):
    """The best actor on the held-out starts, with Wilson's 95 % interval of its success; times in s."""

    starts: int
    successes: int
    success: float
    low: float
    high: float
    mean_time: float | None
    optimum: float | None
    time_ratio: float | None


class Figures(TypedDict):
    """The content of ``result.json``.

    ``best_steps`` is the step at which the best actor was found, ``cpu_s`` the CPU time of collecting and
    learning, ``weights`` a hash of the agent's final weights, ``task_digest`` a hash of a user's task's code.
    """

    task: str
    preset: str
    seed: int
    robobt: str
    commit: str
    task_digest: str
    stopped_early: bool
    steps: int
    updates: int
    best_steps: int
    cpu_s: float
    evaluation_cpu_s: float
    wall_s: float
    held_out: HeldOutFigures
    weights: str


@dataclass(frozen=True, slots=True)
class TrainResult:
    """A finished run.

    Attributes:
        settings: of the run.
        folder: with its files.
        actor: the best actor by the validation starts: raw observation in SI units ->
            action in [-1, 1].
        validations: every evaluation on the validation starts.
        figures: the content of ``result.json``.
    """

    settings: TrainSettings
    folder: Path
    actor: Actor
    validations: list[Validation]
    figures: Figures


class SeedSpread(TypedDict):
    """Median and range over seeds."""

    median: float
    low: float
    high: float


class Reached(TypedDict):
    """How many seeds reached a bar, and at what cost; None unless all did."""

    reached: int
    cpu_s: SeedSpread | None
    steps: SeedSpread | None


class SeedSummary(TypedDict):
    """Summary of several seeds of a run.

    ``best_seed`` is chosen by the validation starts; ``to_99`` is the cost of reaching 99 % of them and
    ``to_bar`` that of reaching :data:`BARS`; ``success``, ``mean_time`` and ``time_ratio`` are on held-out
    starts.
    """

    task: str
    preset: str
    seeds: list[int]
    best_seed: int
    to_99: Reached
    to_bar: Reached
    success: SeedSpread | None
    mean_time: SeedSpread | None
    time_ratio: SeedSpread | None
    steps: SeedSpread | None
    cpu_s: SeedSpread | None
    evaluation_cpu_s: SeedSpread | None
    wall_s: SeedSpread | None


def held_out_figures(evaluation: Evaluation) -> HeldOutFigures:
    """Return the figures of an evaluation on the held-out starts."""
    return {
        "starts": len(evaluation.success),
        "successes": int(evaluation.success.sum()),
        "success": evaluation.rate,
        "low": evaluation.interval.low,
        "high": evaluation.interval.high,
        "mean_time": evaluation.mean_time,
        "optimum": evaluation.mean_optimum,
        "time_ratio": evaluation.time_ratio,
    }


def title_of(settings: TrainSettings) -> str:
    """Return the title of a run in pictures and tables."""
    return f"{settings.task}, {settings.preset}" if settings.preset else settings.task


def summary_of(results: Sequence[TrainResult]) -> SeedSummary:
    """Compute medians and ranges over the seeds of a run."""
    first = results[0].settings
    bar, enough = BARS.get(first.task, (0.99, float("inf"))), first.evaluation.enough
    figures = [result.figures for result in results]
    held_out = [each["held_out"] for each in figures]
    best = max(results, key=lambda result: max(v.score(enough) for v in result.validations))
    return {
        "task": first.task,
        "preset": first.preset,
        "seeds": [result.settings.seed for result in results],
        "best_seed": best.settings.seed,
        "to_99": _reached([first_reaching(result.validations, 0.99) for result in results]),
        "to_bar": _reached([first_reaching(result.validations, *bar) for result in results]),
        "success": _spread([each["success"] for each in held_out]),
        "mean_time": _spread([each["mean_time"] for each in held_out]),
        "time_ratio": _spread([each["time_ratio"] for each in held_out]),
        "steps": _spread([each["steps"] for each in figures]),
        "cpu_s": _spread([each["cpu_s"] for each in figures]),
        "evaluation_cpu_s": _spread([each["evaluation_cpu_s"] for each in figures]),
        "wall_s": _spread([each["wall_s"] for each in figures]),
    }


def figures_of(results: Sequence[TrainResult]) -> dict[str, object]:
    """Return every seed's figures and their summary as plain data."""
    return {
        "runs": [{**result.figures, "folder": str(result.folder)} for result in results],
        "together": summary_of(results),
    }


def first_reaching(
    validations: Sequence[Validation], success: float, time: float = float("inf")
) -> Validation | None:
    """Return the first evaluation that :meth:`~Validation.reaches` the bar; None without one."""
    return next((each for each in validations if each.reaches(success, time)), None)


def _reached(found: Sequence[Validation | None]) -> Reached:
    known = [each for each in found if each is not None]
    whole = len(known) == len(found)
    return {
        "reached": len(known),
        "cpu_s": _spread([each.cpu_s for each in known]) if whole else None,
        "steps": _spread([each.steps for each in known]) if whole else None,
    }


def _spread(values: Sequence[float | None]) -> SeedSpread | None:
    known = [value for value in values if value is not None]
    return {"median": median(known), "low": min(known), "high": max(known)} if known else None
