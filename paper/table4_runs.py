"""The runs of Table 4: each is played, kept and, by worker processes, shared out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import NamedTuple

from pydantic import ConfigDict

import paper.scripts  # noqa: F401  It registers the policies named script, in workers too.
from paper.table4_starts import SHOOTER, gap, minimum_times
from robobt import RobobtError
from robobt.engines import Work, run_tasks
from robobt.match import MatchLoop, RunError, Scenario, TrialsFile, WorldFactory, trial_seed
from robobt.sim import settings_from
from robobt.skills import HANDOVER_DISTANCE
from robobt.worlds import sim_world

Show = Callable[[MatchLoop], Callable[[], bool]]
"""Shows a match to a person and returns a function that plays its next tick and returns False at the end."""

_GOAL = "goal_blue"
_BESIDE = -1
"""The number of the run from the paper's start."""


@dataclass(frozen=True, slots=True)
class Attempt:
    """One run.

    Attributes:
        trial: its number, from 0.
        approach: start until robot and ball are 0.2 m apart, between two frames by their straight line [s].
        to_ball: time from the start until the ball is first in the mouth, as the paper counts [s].
        shoot: from then until the kick [s].
        goal: whether it went in.
        minimum: the shortest possible times from this start, as a :class:`Minimum`'s; None where the start
            was not seen.
        trace: hash over all that happened; equal for runs that repeat each other.

    Times are None for what never happened.
    """

    __pydantic_config__ = ConfigDict(extra="forbid", allow_inf_nan=False)

    trial: int
    approach: float | None
    to_ball: float | None
    shoot: float | None
    goal: bool
    minimum: dict[str, float] | None
    trace: str

    @property
    def pick_up(self) -> float | None:
        """Time from the end of the approach until the ball is in the mouth [s]."""
        return None if self.approach is None or self.to_ball is None else self.to_ball - self.approach

    @property
    def total(self) -> float | None:
        """Start to kick [s]."""
        return None if self.to_ball is None or self.shoot is None else self.to_ball + self.shoot

    def to_json(self) -> dict[str, object]:
        """Return plain data; the keys are the attributes' names."""
        return asdict(self)


@dataclass(frozen=True, slots=True)
class Series:
    """The runs of one row.

    Attributes:
        name: what they are called in errors.
        scenario: what is played.
        seed: seed of its runs.
        beside: what is played once more, from the paper's start; None for nothing.
        kept: file that keeps the runs as they finish; those that it holds are not played again.
        show: lets a person drive.
    """

    name: str
    scenario: Scenario
    seed: int
    beside: Scenario | None
    kept: Path | None = None
    show: Show | None = None


class _Task(NamedTuple):
    name: str
    place: int
    run: int

    def __str__(self) -> str:
        return f"{self.run} of {self.name}"


@dataclass(frozen=True, slots=True)
class _Job:
    """Everything that a worker needs to play any of the runs."""

    series: tuple[Series, ...]
    world: WorldFactory

    def play(self, task: _Task, _report: object) -> tuple[_Task, Attempt]:
        one = self.series[task.place]
        if task.run == _BESIDE and one.beside is not None:
            return task, play_attempt(one.beside, trial_seed(one.seed, 0), self.world)
        seed = trial_seed(one.seed, task.run)
        return task, play_attempt(one.scenario, seed, self.world, task.run, one.show)


def play_series(
    series: Sequence[Series],
    runs: int,
    workers: int,
    world: WorldFactory,
    progress: Callable[[], object],
) -> list[tuple[list[Attempt], Attempt | None]]:
    """Return the runs of each series, and the one from the paper's start.

    A run is the same whichever process plays it; what is shown to a person needs this one, and so 1 worker.

    Raises:
        ResultsFileError: a file holds runs of other settings.
        RobobtError: as a match raises.
        RunError: anything else that a run raised, or its worker died.
    """
    where = getattr(world, "address", None)
    found: list[dict[int, Attempt]] = []
    with ExitStack() as opened:
        files: list[TrialsFile[Attempt] | None] = []
        todo: list[_Task] = []
        for place, one in enumerate(series):
            file = None
            if one.kept is not None:
                file = opened.enter_context(TrialsFile(Attempt, one.kept, one.scenario, one.seed, where))
            files.append(file)
            held = {} if file is None else file.done
            found.append({run: held[run] for run in range(runs) if run in held})
            missing = [run for run in range(runs) if run not in held]
            missing += [] if one.beside is None else [_BESIDE]
            todo += [_Task(one.name, place, run) for run in missing]
            for _ in found[place]:
                progress()
        job = _Job(tuple(series), world)
        work: Work[_Task, object, tuple[_Task, Attempt]] = Work(
            job.play, "run", RunError, (RobobtError, OSError)
        )
        for task, attempt in run_tasks(work, todo, min(workers, len(todo))):
            file = files[task.place]
            if file is not None and task.run != _BESIDE:
                file.add(attempt)
            found[task.place][task.run] = attempt
            progress()
    return [([played[run] for run in range(runs)], played.get(_BESIDE)) for played in found]


def play_attempt(
    scenario: Scenario,
    seed: int,
    world: WorldFactory = sim_world,
    trial: int = 0,
    show: Show | None = None,
) -> Attempt:
    """Play one run to its end, as fast as can be or as it is shown."""
    approach: float | None = None
    with MatchLoop(scenario, seed, world) as match:
        before = match.world.truth()
        minimum: dict[str, float] | None = None
        if before.own:
            least = minimum_times(before, settings_from(scenario.simulator))
            minimum = {"to_ball": least["to_ball"], "to_kick": least["to_kick"]}
        tick = match.tick if show is None else show(match)
        while tick():
            now = match.world.truth()
            if not (now.own and before.own):
                # Over a network robots may be out of sight.
                before = now
                continue
            if approach is None and gap(now) <= HANDOVER_DISTANCE:
                way, left = gap(before) - gap(now), gap(before) - HANDOVER_DISTANCE
                share = min(1.0, max(0.0, left / way)) if way > 0.0 else 1.0
                approach = before.time + share * (now.time - before.time)
            before = now
        result = match.result()
    figures = result.robots[SHOOTER]
    goal = result.outcome == _GOAL
    return Attempt(trial, approach, figures.go_to_ball, figures.shoot, goal, minimum, result.trace)
