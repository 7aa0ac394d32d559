"""Table 4 of the paper: get the ball and shoot, with hand-written and learned skills in every combination."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import fmean, stdev
from typing import NamedTuple

from paper.table4_rows import (
    PAPER,
    Comparison,
    Minimum,
    PaperStart,
    Row,
    Spread,
    Table4,
    Trial,
)
from paper.table4_runs import Attempt, Series, Show, play_series
from paper.table4_starts import LIMITS, Starts, drawn_starts, table4_scenario
from robobt.match import Rate, WorldFactory
from robobt.statistics import mean_interval
from robobt.worlds import sim_world

TRIALS = ("1", "2")
"""The ball in the centre, and at (0, 1.5) m."""

COMBINATIONS: dict[str, dict[str, str | None] | None] = {
    "robobulls": None,
    "script, script": {"policy": "script", "shoot": "script", "pickup_speed": None},
    "geometric, script": {"policy": "geometric", "shoot": "script", "pickup_speed": None},
    "geometric, kick": {"policy": "geometric", "shoot": "kick_to_target"},
    "geometric, kick, quick": {"policy": "geometric", "shoot": "kick_to_target", "pickup_speed": None},
    "geometric, shoot": {"policy": "geometric", "shoot": "geometric"},
    "geometric, ddpg": {"policy": "geometric", "shoot": "ddpg"},
    "3-step ddpg, kick": {"policy": "ddpg", "shoot": "kick_to_target", "pickup_speed": None},
    "3-step ddpg, shoot": {"policy": "ddpg", "shoot": "geometric", "pickup_speed": None},
    "3-step ddpg, ddpg": {"policy": "ddpg", "shoot": "ddpg", "pickup_speed": None},
}
"""Parameters of the play go_to_ball_and_shoot, by who approaches and who shoots; None for RoboBulls' play.

Hand-written shots are KickToTarget ("kick") and the geometric Shoot ("shoot").

The learned approach hands over at full speed and the pick-up goes on as fast as the
dribbler takes the ball; "quick" is the hand-written approach with that pick-up.
"""

LEARNED = "3-step ddpg, ddpg"
HAND_WRITTEN = ("robobulls", "geometric, kick", "geometric, kick, quick", "geometric, shoot")

HUMAN = "human, game controller"
"""The row of a person who drives the robot in the live page."""


@dataclass(frozen=True)
class Conditions:
    """Under which conditions the runs are played.

    Attributes:
        preset: preset of the simulator.
        realism: level of noise, losses and delays; by default the scenarios' own little noise.
        limits: some of :data:`LIMITS`.
        starts: where runs start.
    """

    preset: str = "robobulls"
    realism: str | None = None
    limits: Sequence[str] = tuple(LIMITS)
    starts: Starts = "drawn"


def table4(
    runs: int = 25,
    seed: int | None = None,
    *,
    conditions: Conditions | None = None,
    combinations: Sequence[str] = tuple(COMBINATIONS),
    trials: Sequence[str] = TRIALS,
    progress: Callable[[], object] = lambda: None,
    world: WorldFactory = sim_world,
    out: Path | None = None,
    human: Show | None = None,
    workers: int = 1,
) -> Table4:
    """Play both trials with every combination.

    Run n of every combination has the same seed and start, so that differences are paired.
    Each combination has one run more, from the paper's start.

    Args:
        runs: number of runs of each.
        seed: seed of all runs; the scenarios' own by default.
        conditions: of all runs.
        combinations: some of :data:`COMBINATIONS`.
        trials: some of :data:`TRIALS`.
        progress: called after every run.
        world: where it is played.
        out: folder that keeps the runs as they finish; those that it holds are not played again.
        human: lets a person drive, for one more row, which has no run from the paper's start; takes 1 worker.
        workers: number of processes; a world of the league takes 1.

    Raises:
        KeyError: no such preset, realism level, combination or limits.
        ResultsFileError: the folder holds runs of other settings.
        ScenarioError: a play cannot be made, as where a model is missing.
        RunError: a run raised or its worker died.
    """
    conditions = conditions or Conditions()
    preset, realism, limits = conditions.preset, conditions.realism, conditions.limits
    given = (*combinations, *([] if human is None else [HUMAN]))
    rows = dict.fromkeys([_Place(name, trial, one) for name in limits for trial in trials for one in given])
    series = []
    for row in rows:
        # A person needs no play, but the rest of the scenario.
        params = COMBINATIONS.get(row.combination)
        scenario = table4_scenario(row.trial, params, preset, realism, LIMITS[row.limits])
        first = scenario.seed if seed is None else seed
        drawn = drawn_starts(scenario) if conditions.starts == "drawn" else scenario
        kept = None if out is None else out / row.file_name
        show = human if row.combination == HUMAN else None
        series.append(Series(str(row), drawn, first, None if show else scenario, kept, show))
    played = dict(zip(rows, play_series(series, runs, workers, world, progress), strict=True))
    found = {
        name: {
            trial: _trial_of({row.combination: of for row, of in played.items() if row[:2] == (name, trial)})
            for trial in trials
        }
        for name in limits
    }
    return Table4(
        runs=runs, preset=preset, realism=realism, starts=conditions.starts, paper=PAPER, limits=found
    )


class _Place(NamedTuple):
    """Where a row stands."""

    limits: str
    trial: str
    combination: str

    def __str__(self) -> str:
        return f"{self.combination!r} (trial {self.trial}, limits {self.limits})"

    @property
    def file_name(self) -> str:
        """Return the name of the file that keeps its runs."""
        return re.sub(r"[^\w.]+", "-", " ".join(self)) + ".jsonl"


def _row_of(attempts: Sequence[Attempt], beside: Attempt | None) -> Row:
    traces = [attempt.trace for attempt in attempts]
    return Row(
        approach=_spread(attempt.approach for attempt in attempts),
        pick_up=_spread(attempt.pick_up for attempt in attempts),
        to_ball=_spread(attempt.to_ball for attempt in attempts),
        shoot=_spread(attempt.shoot for attempt in attempts),
        total=_spread(attempt.total for attempt in attempts),
        goals=Rate.of([attempt.goal for attempt in attempts], traces),
        reached=Rate.of([attempt.to_ball is not None for attempt in attempts], traces),
        shots=Rate.of([attempt.shoot is not None for attempt in attempts], traces),
        ball_ratio=_ratio((one.to_ball, one.minimum["to_ball"]) for one in attempts if one.minimum),
        kick_ratio=_ratio((one.total, one.minimum["to_kick"]) for one in attempts if one.minimum),
        paper_start=PaperStart(to_ball=None, total=None, goal=False)
        if beside is None
        else PaperStart(to_ball=beside.to_ball, total=beside.total, goal=beside.goal),
    )


def _ratio(pairs: Iterable[tuple[float | None, float]]) -> float | None:
    known = [(time, least) for time, least in pairs if time is not None]
    return sum(time for time, _ in known) / sum(least for _, least in known) if known else None


def _spread(given: Iterable[float | None]) -> Spread:
    values = [value for value in given if value is not None]
    mean = fmean(values) if values else None
    # Runs that are all the same tell nothing of others.
    low, high = mean_interval(values) if len(set(values)) > 1 else (None, None)
    variance = stdev(values) ** 2 if len(values) > 1 else None
    return {"n": len(values), "mean": mean, "variance": variance, "low": low, "high": high}


def _trial_of(played: Mapping[str, tuple[list[Attempt], Attempt | None]]) -> Trial:
    """Compare the learned combination with the best hand-written one: most goals, then the first kick."""
    attempts = {name: runs for name, (runs, _) in played.items()}
    rows = {name: _row_of(runs, beside) for name, (runs, beside) in played.items()}
    minima = [one.minimum for played in attempts.values() for one in played if one.minimum is not None]
    minimum = None
    if minima:
        to_ball, to_kick = (fmean(one[key] for one in minima) for key in ("to_ball", "to_kick"))
        minimum = Minimum(to_ball=to_ball, to_kick=to_kick)
    times = {name: rows[name]["total"]["mean"] for name in HAND_WRITTEN if name in rows}
    kicked = {name: (-rows[name]["goals"].count, time) for name, time in times.items() if time is not None}
    best = min(kicked, key=kicked.__getitem__) if kicked else None
    found = Trial(minimum=minimum, rows=rows, best_hand_written=best, to_ball=None, to_kick=None)
    if best is not None and LEARNED in rows:
        pairs = list(zip(attempts[LEARNED], attempts[best], strict=True))
        found["to_ball"] = _compared((ours.to_ball, theirs.to_ball) for ours, theirs in pairs)
        found["to_kick"] = _compared((ours.total, theirs.total) for ours, theirs in pairs)
    return found


def _compared(pairs: Iterable[tuple[float | None, float | None]]) -> Comparison | None:
    differences = [ours - theirs for ours, theirs in pairs if ours is not None and theirs is not None]
    if not differences:
        return None
    # Times are multiples of the control period; what differs by less differs by rounding.
    mean, vary = fmean(differences), max(differences) - min(differences) > 1e-9
    low, high = mean_interval(differences) if vary else (None, None)
    effect = mean / stdev(differences) if vary else None
    return Comparison(n=len(differences), mean=mean, low=low, high=high, effect=effect)
