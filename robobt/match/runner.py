"""Many trials of one scenario, in this process or over several."""

from __future__ import annotations

from collections.abc import Callable, Container, Mapping
from contextlib import nullcontext
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from robobt.config.errors import RobobtError
from robobt.engines.run import run_tasks
from robobt.engines.work import MAX_WORKERS, Work
from robobt.match.loop import MatchLoop, WorldFactory
from robobt.match.refereeing import RefereeFactory, own_referee
from robobt.match.results.file import ResultsFile
from robobt.match.results.results import MatchResult, Summary, summarise
from robobt.match.scenario.scenario import MAX_TRIALS, Scenario, ScenarioError
from robobt.plays import PLAYS
from robobt.plays.base import Play
from robobt.plays.private_files import sender


class RunError(RobobtError, RuntimeError):
    """A trial could not be played to its end; the message is one line."""


@dataclass(slots=True, frozen=True)
class Recorded:
    """Where a trial is recorded to, and the layers of which what skills draw is recorded as well."""

    file: str | Path | None
    layers: Container[str] = ()


@dataclass(slots=True)
class Run:
    """The trials that a run has played.

    Attributes:
        results: one a trial, in the order of their numbers.
        seed: seed of the run, from which the trials' seeds follow.
        interrupted: whether it was stopped (Ctrl-C) before the last trial.
    """

    results: list[MatchResult]
    seed: int
    interrupted: bool

    def summary(self) -> Summary:
        """Summarise the trials."""
        return summarise(self.results, self.seed)


def trial_seed(seed: int, trial: int) -> int:
    """Return the seed of one trial, which depends only on the run's seed and the trial's number."""
    return int(np.random.SeedSequence([seed, trial]).generate_state(1, np.uint64)[0] >> np.uint64(11))


def run_trials_in(
    scenario: Scenario,
    world_factory: WorldFactory,
    trials: int | None = None,
    workers: int = 1,
    seed: int | None = None,
    out: str | Path | None = None,
    record: Mapping[int, str | Path | Recorded] | None = None,
    on_result: Callable[[MatchResult], None] | None = None,
    referee: RefereeFactory = own_referee,
    play: Callable[[MatchLoop], MatchResult] = MatchLoop.play,
) -> Run:
    """Play a scenario many times.

    A trial's result is the same whichever process plays it and whatever else
    is played. Ctrl-C ends the run; what is finished is kept.

    Args:
        scenario: the scenario to play.
        world_factory: makes the world of each trial; with several workers a function of a module,
            because it is sent to them by name.
        trials: number of trials; the scenario's by default.
        workers: number of processes; one is this process itself.
        seed: seed from which the trials' seeds follow; the scenario's by default.
        out: file to append each result to as it finishes; trials it holds already are not played again.
        record: files to record trials to, by trial number; with layers as :class:`Recorded`.
        on_result: called with each result as it finishes, and with those of ``out`` first.
        referee: makes the referee of each trial; by default the scenario's own.
        play: plays a match to its end; another than the usual one needs this process, and so one worker.

    Returns:
        The results, in the order of the trials.

    Raises:
        ScenarioError: the scenario does not fit the world, or its objects find no place.
        RunError: a trial raised or its worker died.
        ResultsFileError: ``out`` holds something else.
        OSError: a file cannot be written.
        ValueError: an argument is out of range.
    """
    trials = scenario.trials if trials is None else trials
    seed = scenario.seed if seed is None else seed
    record = {} if record is None else record
    if not 1 <= trials <= MAX_TRIALS:
        raise ValueError(f"trials must be 1 to {MAX_TRIALS}, not {trials}")
    if not 1 <= workers <= MAX_WORKERS:
        raise ValueError(f"workers must be 1 to {MAX_WORKERS}, not {workers}")
    for trial in record:
        if not 0 <= trial < trials:
            raise ValueError(f"there is no trial {trial} to record; they are 0 to {trials - 1}")
    job = _Job(
        scenario,
        world_factory,
        seed,
        referee,
        {trial: to if isinstance(to, Recorded) else Recorded(to) for trial, to in record.items()},
        tuple({PLAYS[setup.play] for _, setup in scenario.robots if setup.play in PLAYS}),
        play,
    )
    results: dict[int, MatchResult] = {}
    interrupted = False
    where = getattr(world_factory, "address", None), getattr(referee, "name", None)
    with ResultsFile(out, scenario, seed, *where) if out is not None else nullcontext() as file:
        try:
            for trial, result in sorted(file.done.items() if file is not None else ()):
                if trial < trials and trial not in record:
                    results[trial] = result
                    if on_result is not None:
                        on_result(result)
            todo = [trial for trial in range(trials) if trial not in results]
            work: Work[int, object, MatchResult] = Work(
                job.play, f"{scenario.source}: trial", RunError, (ScenarioError, OSError)
            )
            setup = sender([setup.play for _, setup in scenario.robots])
            for result in run_tasks(work, todo, min(workers, len(todo)), setup=setup):
                results[result.trial] = result
                if file is not None:
                    file.add(result)
                if on_result is not None:
                    on_result(result)
        except KeyboardInterrupt:
            interrupted = True
    return Run([results[trial] for trial in sorted(results)], seed, interrupted)


@dataclass(slots=True, frozen=True)
class _Job:
    """What a worker needs to play any of the trials.

    The registered plays are there because they are sent by name: a worker that
    receives them has imported the modules that register them. Tree files are read
    by each worker.
    """

    scenario: Scenario
    world_factory: WorldFactory
    seed: int
    referee: RefereeFactory
    record: Mapping[int, Recorded]
    plays: tuple[Play, ...]
    conduct: Callable[[MatchLoop], MatchResult]

    def play(self, trial: int, _report: object) -> MatchResult:
        seed = trial_seed(self.seed, trial)
        record = self.record.get(trial, Recorded(None))
        match = MatchLoop(
            self.scenario, seed, self.world_factory, record.file, trial, self.referee, layers=record.layers
        )
        return self.conduct(match)
