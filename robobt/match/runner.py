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
    """A trial could not be completed; the message is one line."""


@dataclass(slots=True, frozen=True)
class Recorded:
    """The file that a trial is recorded to, and the drawing layers to record."""

    file: str | Path | None
    layers: Container[str] = ()


@dataclass(slots=True)
class Run:
    """The trials of a run.

    Attributes:
        results: one per trial, in the order of their numbers.
        seed: seed of the run, from which the trials' seeds are derived.
        interrupted: whether it was stopped (Ctrl-C) before the last trial.
    """

    results: list[MatchResult]
    seed: int
    interrupted: bool

    def summary(self) -> Summary:
        """Summarise the trials."""
        return summarise(self.results, self.seed)


def trial_seed(seed: int, trial: int) -> int:
    """Return the seed of one trial, derived from the run's seed and the trial's number only."""
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

    A trial's result does not depend on the process or on the other trials. Ctrl-C ends the run and keeps the
    finished trials.

    Args:
        scenario: the scenario to play.
        world_factory: makes the world of each trial; with several workers it must be a function of a module,
            because it is sent by name.
        trials: number of trials; the scenario's by default.
        workers: number of processes; 1 plays in this process.
        seed: seed from which the trials' seeds are derived; the scenario's by default.
        out: file to append each result to; trials that it already holds are not played again.
        record: files to record trials to, by trial number; as :class:`Recorded` with drawing layers.
        on_result: called with the results in ``out`` first, then with each result when it finishes.
        referee: makes the referee of each trial; by default the scenario's own.
        play: function that plays a match to its end; a custom function runs only in this process, with one
            worker.

    Returns:
        The results, in the order of the trials.

    Raises:
        ScenarioError: the scenario does not fit the world, or its objects find no place.
        RunError: a trial raised or its worker died.
        ResultsFileError: ``out`` holds results of another run or other data.
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
    job = _TrialJob(
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
class _TrialJob:
    """Everything that a worker needs to play any trial.

    The registered plays are included because they are sent by name, so that a worker that receives them
    imports the modules that register them. Each worker reads tree files itself.
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
