"""Play runs of a challenge and judge them."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from robobt.challenges.challenge import CHALLENGES, Challenge, ChallengeAttempt, Figures
from robobt.engines.run import run_tasks
from robobt.engines.work import Work
from robobt.match.loop import MatchLoop, WorldFactory
from robobt.match.runner import RunError, trial_seed
from robobt.match.scenario.changes import changed, with_team
from robobt.match.scenario.scenario import ScenarioError
from robobt.plays import PLAYS
from robobt.plays.base import Play
from robobt.plays.private_files import sender
from robobt.world.game import Team


@dataclass(slots=True, frozen=True)
class ChallengeEntry:
    """Who takes a challenge, and in which conditions.

    Attributes:
        challenge: name of the challenge.
        blue: the play of blue's robots and its parameters.
        yellow: the play of yellow's robots and its parameters; None for the challenge's own.
        settings: changes of the scenario by field name, such as ``{"simulator.preset": "grsim"}``.
    """

    challenge: str
    blue: tuple[str, Mapping[str, object]]
    yellow: tuple[str, Mapping[str, object]] | None = None
    settings: Mapping[str, object] | None = None

    def of(self, attempt: ChallengeAttempt) -> ChallengeAttempt:
        """Return the attempt with these plays and settings.

        Raises:
            ScenarioError: a play, parameter or setting does not fit.
        """
        scenario = changed(attempt.scenario, self.settings or {})
        for team, entry in ((Team.BLUE, self.blue), (Team.YELLOW, self.yellow)):
            if entry is not None:
                scenario = with_team(scenario, team, *entry)
        return replace(attempt, scenario=scenario)


@dataclass(slots=True, frozen=True)
class RunResult:
    """One run of a challenge.

    Attributes:
        run: number of the run, from 0.
        seed: seed of the run.
        figures: what was counted; the first is the score.
        trace: hash over every true state of all attempts; equal for equal runs.
        errors: ticks in which a robot's tree failed.
        first_error: the first failure, and whose; None without one.
        recordings: the files that were recorded.
    """

    run: int
    seed: int
    figures: Figures
    trace: str
    errors: int = 0
    first_error: str | None = None
    recordings: tuple[str, ...] = ()

    @property
    def score(self) -> float:
        """The score."""
        return next(iter(self.figures.values()))


def play_runs(
    entry: ChallengeEntry,
    runs: int,
    seed: int,
    world_factory: WorldFactory,
    workers: int = 1,
    on_result: Callable[[RunResult], None] | None = None,
) -> list[RunResult]:
    """Play runs of a challenge; a run's result does not depend on the others or on the process.

    Args:
        entry: who takes which challenge.
        runs: number of runs.
        seed: seed from which the runs' seeds follow.
        world_factory: makes the world; with several workers it is a function of a module.
        workers: number of processes; 1 plays in this process.
        on_result: called with each result as it finishes.

    Returns:
        The results in the order of their numbers.

    Raises:
        ScenarioError: a play or setting does not fit.
        RunError: a run raised, or its worker died.
    """
    plays = [given[0] for given in (entry.blue, entry.yellow) if given is not None]
    job = _RunJob(
        entry,
        seed,
        world_factory,
        CHALLENGES[entry.challenge],
        tuple(PLAYS[play] for play in plays if play in PLAYS),
    )
    work: Work[int, object, RunResult] = Work(
        job.play, f"{entry.challenge}: run", RunError, (ScenarioError, OSError)
    )
    results = {}
    for result in run_tasks(work, range(runs), min(workers, runs), setup=sender(plays)):
        results[result.run] = result
        if on_result is not None:
            on_result(result)
    return [results[run] for run in sorted(results)]


@dataclass(slots=True, frozen=True)
class _RunJob:
    """What a worker needs to play any run; challenge and plays are there so that it imports their modules."""

    entry: ChallengeEntry
    seed: int
    world_factory: WorldFactory
    challenge: type[Challenge]
    plays: tuple[Play, ...]

    def play(self, run: int, _report: object) -> RunResult:
        return play_run(self.entry, run, self.seed, self.world_factory)


def play_run(
    entry: ChallengeEntry, run: int, seed: int, world_factory: WorldFactory, record: Path | None = None
) -> RunResult:
    """Play one run of a challenge.

    Args:
        entry: who takes which challenge.
        run: number of the run, from 0.
        seed: seed of all runs, from which the run's own follows.
        world_factory: makes the world.
        record: folder and beginning of the names of files to record the attempts to.

    Raises:
        ScenarioError: a play or setting does not fit.
    """
    challenge = CHALLENGES[entry.challenge]()
    own_seed = trial_seed(seed, run)
    draw, *rest = np.random.SeedSequence(own_seed).spawn(2)
    attempts = [entry.of(attempt) for attempt in challenge.attempts(np.random.default_rng(draw))]
    seeds = rest[0].generate_state(len(attempts), np.uint64) >> np.uint64(11)
    judged, traces, errors, files = [], [], 0, []
    first: str | None = None
    for attempt, attempt_seed in zip(attempts, seeds.tolist(), strict=True):
        file = None
        if record is not None:
            file = record.with_name(f"{record.name}-{attempt.name}.robobt.arrows")
            files.append(str(file))
        match = MatchLoop(attempt.scenario, attempt_seed, world_factory, file, run, attempt.referee)
        judge = attempt.judge()
        with match:
            going = True
            while going:
                truth = match.world.truth()
                going = match.tick()
                going = not judge.see(truth, match.game) and going
            result = match.result()
        judged.append(judge.figures())
        traces.append(result.trace)
        for name, robot in result.robots.items():
            errors += robot.errors
            if first is None and robot.first_error is not None:
                first = f"{name}: {robot.first_error}"
    trace = hashlib.blake2b("".join(traces).encode(), digest_size=16).hexdigest()
    return RunResult(run, own_seed, challenge.score(judged), trace, errors, first, tuple(files))
