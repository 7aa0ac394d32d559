"""Plays the trials of a collection in worker processes."""

from __future__ import annotations

import logging
import multiprocessing
import os
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import islice
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
from typing import Any

from robobt.learning.shots.collect_balanced import balanced_attempt
from robobt.learning.shots.collect_paper import PARTS, paper_attempt
from robobt.learning.shots.collect_plan import CollectionSettings
from robobt.learning.shots.collect_watch import take_shot
from robobt.learning.shots.schema import complete_row
from robobt.worlds import sim_world

_CHUNK = 8


class CollectionError(RuntimeError):
    """A trial could not be played to its end; the message is one line."""


@dataclass(slots=True, frozen=True)
class Taken:
    """What came of one trial.

    Attributes:
        trial: which one.
        row: its shot, a row of the table, None without one.
        time: how long it lasted in the world [s].
    """

    trial: int
    row: dict[str, Any] | None
    time: float


def streams(settings: CollectionSettings) -> int:
    """How many series of trials the collection has: trial n is one of series n modulo this."""
    return len(PARTS) if settings.protocol == "paper" else 1


def play_trial(settings: CollectionSettings, trial: int) -> Taken:
    """Play one trial; the same settings and number give the same shot wherever it is played."""
    if settings.protocol == "paper":
        attempt = paper_attempt(settings, trial % len(PARTS), trial)
    else:
        attempt = balanced_attempt(settings, trial)
    shot, time = take_shot(attempt, sim_world, trial)
    return Taken(trial, None if shot is None else complete_row(shot), time)


def play_trials(settings: CollectionSettings, trials: Iterator[int], workers: int) -> Iterator[Taken]:
    """Play trials as they are asked for, in this process or in several.

    Results come in the order in which they finish; close the generator to end
    the workers.

    Args:
        trials: what to play; an iterator that is looked at again whenever a worker is free, so that
            it may end once enough has been played.
        workers: processes; one is this process itself.

    Raises:
        CollectionError: a trial raised or its worker died.
    """
    if workers == 1:
        for trial in trials:
            yield _played(settings, trial)
        return
    with _ignoring_interrupts():
        crew = [_start(settings) for _ in range(workers)]
    busy = dict(crew)
    try:
        for connection in list(busy):
            _ask(connection, trials, busy)
        while busy:
            ready = wait(list(busy))
            for connection in [connection for connection in busy if connection in ready]:
                answer = _receive(connection, busy[connection])
                if isinstance(answer, Exception):
                    raise answer
                if answer is None:
                    _ask(connection, trials, busy)
                else:
                    yield answer
    finally:
        for _, process in crew:
            process.terminate()
        for _, process in crew:
            process.join()


def _played(settings: CollectionSettings, trial: int) -> Taken:
    try:
        return play_trial(settings, trial)
    except Exception as error:
        raise CollectionError(f"trial {trial}: {type(error).__name__}: {error}") from error


def _ask(connection: Connection, trials: Iterator[int], busy: dict[Connection, SpawnProcess]) -> None:
    chunk = list(islice(trials, _CHUNK))
    if chunk:
        connection.send(chunk)
    else:
        del busy[connection]


def _start(settings: CollectionSettings) -> tuple[Connection, SpawnProcess]:
    # Spawned, not forked: forking a process whose threads hold locks (torch, numba) can hang.
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    process = context.Process(target=_work, args=(settings, theirs), daemon=True)
    process.start()
    theirs.close()
    return ours, process


def _receive(connection: Connection, process: SpawnProcess) -> Taken | Exception | None:
    try:
        answer: Taken | Exception | None = connection.recv()
    except (EOFError, OSError):
        process.join()
        return CollectionError(f"a worker process died (exit code {process.exitcode})")
    return answer


def _work(settings: CollectionSettings, connection: Connection) -> None:
    """A worker process: play what is asked for, then say that there is nothing left to do."""
    threading.Thread(target=_leave_with_the_run, daemon=True).start()
    for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(variable, "1")
    logging.getLogger("robobt").setLevel(logging.ERROR)
    try:
        while True:
            for trial in connection.recv():
                connection.send(_played(settings, trial))
            connection.send(None)
    except CollectionError as error:
        connection.send(error)
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
