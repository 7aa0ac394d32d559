"""Many trials of one scenario, in this process or over several."""

from __future__ import annotations

import logging
import multiprocessing
import os
import pickle
import signal
import threading
from collections import deque
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
from pathlib import Path

import numpy as np

from robobt.match.loop import WorldFactory, play_match
from robobt.match.results import MatchResult
from robobt.match.results_file import ResultsFile
from robobt.match.scenario import MAX_TRIALS, Scenario, ScenarioError
from robobt.plays import PLAYS
from robobt.plays.base import Play
from robobt.plays.python_files import import_file, imported_files

MAX_WORKERS = 256
"""Most worker processes of a run."""


class RunError(RuntimeError):
    """A trial could not be played to its end; the message is one line."""


@dataclass(slots=True)
class Run:
    """What a run has come to.

    Attributes:
        results: the trials played, in the order of their numbers.
        interrupted: whether it was stopped (Ctrl-C) before the last trial.
    """

    results: list[MatchResult]
    interrupted: bool


def trial_seed(seed: int, trial: int) -> int:
    """The seed of one trial; it depends on nothing but the run's seed and the trial's number."""
    return int(np.random.SeedSequence([seed, trial]).generate_state(1, np.uint64)[0] >> np.uint64(11))


def run_trials(
    scenario: Scenario,
    world_factory: WorldFactory,
    trials: int | None = None,
    workers: int = 1,
    seed: int | None = None,
    out: str | Path | None = None,
    record: Mapping[int, str | Path] | None = None,
    on_result: Callable[[MatchResult], None] | None = None,
) -> Run:
    """Play a scenario many times.

    A trial's result is the same whichever process plays it and whatever else
    is played. Ctrl-C ends the run; what is finished is kept.

    Args:
        scenario: what is played.
        world_factory: makes the world of each trial; with several workers a function of a module,
            because it is sent to them by name.
        trials: how often; by default what the scenario says.
        workers: processes; one is this process itself.
        seed: what the trials' seeds follow from; by default what the scenario says.
        out: file to append each result to as it finishes; trials it holds already are not played again.
        record: files to record trials to, by trial number.
        on_result: called with each result as it finishes, and with those of ``out`` first.

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
        {trial: Path(path) for trial, path in record.items()},
        tuple({PLAYS[setup.play] for _, setup in scenario.robots if setup.play in PLAYS}),
    )
    file = None if out is None else ResultsFile(out, scenario, seed)
    results: dict[int, MatchResult] = {}
    interrupted = False
    try:
        if file is not None:
            for trial, result in sorted(file.done.items()):
                if trial < trials and trial not in record:
                    results[trial] = result
                    if on_result is not None:
                        on_result(result)
        todo = [trial for trial in range(trials) if trial not in results]
        many = min(workers, len(todo))
        for result in job.play_all(todo) if many <= 1 else _play_over_workers(job, todo, many):
            results[result.trial] = result
            if file is not None:
                file.add(result)
            if on_result is not None:
                on_result(result)
    except KeyboardInterrupt:
        interrupted = True
    finally:
        if file is not None:
            file.__exit__(None, None, None)
    return Run([results[trial] for trial in sorted(results)], interrupted)


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
    record: Mapping[int, Path]
    plays: tuple[Play, ...]

    def play(self, trial: int) -> MatchResult:
        try:
            return play_match(
                self.scenario,
                trial_seed(self.seed, trial),
                self.world_factory,
                self.record.get(trial),
                trial,
            )
        except (ScenarioError, OSError):
            raise
        except Exception as error:
            name = self.scenario.source
            raise RunError(f"{name}: trial {trial}: {type(error).__name__}: {error}") from error

    def play_all(self, trials: list[int]) -> Iterator[MatchResult]:
        for trial in trials:
            yield self.play(trial)


@dataclass(slots=True)
class _Worker:
    process: SpawnProcess
    connection: Connection
    trial: int


def _play_over_workers(job: _Job, trials: list[int], count: int) -> Iterator[MatchResult]:
    """Results in the order in which they finish."""
    try:
        packed = pickle.dumps(job)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        raise RunError(f"the match cannot be sent to worker processes: {error}") from error
    waiting = deque(trials)
    with _ignoring_interrupts():
        workers = [_start(packed, waiting.popleft()) for _ in range(count)]
    try:
        while workers:
            ready = wait([worker.connection for worker in workers])
            for worker in [worker for worker in workers if worker.connection in ready]:
                answer = _receive(worker)
                if isinstance(answer, Exception):
                    raise answer
                if waiting:
                    worker.trial = waiting.popleft()
                    worker.connection.send(worker.trial)
                else:
                    worker.connection.send(None)
                    workers.remove(worker)
                    worker.process.join()
                yield answer
    finally:
        for worker in workers:
            worker.process.terminate()
        for worker in workers:
            worker.process.join()


def _start(job: bytes, trial: int) -> _Worker:
    # Spawned, not forked: forking a process whose threads hold locks (torch, numba) can hang.
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    process = context.Process(target=_work, args=(imported_files(), job, theirs, trial), daemon=True)
    process.start()
    theirs.close()
    return _Worker(process, ours, trial)


def _receive(worker: _Worker) -> MatchResult | Exception:
    try:
        answer: MatchResult | Exception = worker.connection.recv()
    except (EOFError, OSError):
        worker.process.join()
        return RunError(
            f"a worker process died in trial {worker.trial} (exit code {worker.process.exitcode})"
        )
    return answer


def _work(files: tuple[Path, ...], packed: bytes, connection: Connection, trial: int | None) -> None:
    """A worker process: play what is asked for until told to stop."""
    threading.Thread(target=_leave_with_the_run, daemon=True).start()
    # One core a worker; numeric libraries that start threads of their own would take the others'.
    for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(variable, "1")
    # What trees raise is counted in the results; a line on stderr each tick helps nobody.
    logging.getLogger("robobt").setLevel(logging.ERROR)
    answer: MatchResult | Exception
    try:
        # First, for the job may name what these files define.
        for file in files:
            import_file(file)
        job: _Job = pickle.loads(packed)
    except Exception as error:
        what = "does not know what this one does; plays and worlds for it are defined in modules or files"
        connection.send(RunError(f"a worker process {what}: {type(error).__name__}: {error}"))
        return
    while trial is not None:
        try:
            answer = job.play(trial)
        except Exception as error:
            answer = error
        try:
            connection.send(answer)
            trial = connection.recv()
        except (EOFError, OSError):
            # The run is over without us.
            return


def _leave_with_the_run() -> None:
    """End this process as soon as the one that started it has; one that is killed tells nobody."""
    run = multiprocessing.parent_process()
    if run is not None:
        run.join()
        os._exit(1)


@contextmanager
def _ignoring_interrupts() -> Iterator[None]:
    """Processes started in here never see Ctrl-C; the run that started them ends them."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)
