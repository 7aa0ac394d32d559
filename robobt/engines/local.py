"""Tasks in this process or spread over worker processes of this machine."""

from __future__ import annotations

import gc
import multiprocessing
import os
import pickle
import signal
import threading
import time
import traceback
from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import contextmanager, suppress
from itertools import islice
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import Generic

from robobt.config.telling import tell_warnings
from robobt.engines.work import ReportT, ResultT, TaskT, Work
from robobt.signals import TERMINATE, ending, let_go, uninterrupted

_REACTION = 0.4
"""Time for a worker to finish its files when asked to end [s]."""

_UNGUARDED_EXIT = 86
"""Exit status of a worker process in which the main script, imported again, would start workers itself."""

_WORKER_POLL = 1.0
"""Interval for checking workers whose connection stays open after their end, held by a forked process [s]."""


def run_locally(
    work: Work[TaskT, ReportT, ResultT],
    tasks: Iterable[TaskT],
    workers: int,
    *,
    ahead: int = 1,
    setup: Callable[[], object] | None = None,
    on_report: Callable[[ReportT], None] | None = None,
    lost: Callable[[TaskT, str], ResultT] | None = None,
) -> Generator[ResultT, None, None]:
    """Yield the result of every task; :func:`robobt.engines.run.run_tasks` says what the arguments are.

    Worker processes are spawned, ignore Ctrl-C, use one thread each and end with this
    process, however it ends; a task in progress is ended by an exception, so that it can
    finish its files.
    """
    report = on_report or _ignore
    if workers > 1 and getattr(multiprocessing.current_process(), "_inheriting", False):
        os._exit(_UNGUARDED_EXIT)
    if workers < (2 if lost is None else 1):
        for task in tasks:
            yield work.attempt(task, report)
        return
    packed = work.packed()
    waiting = iter(tasks)
    crew: list[_Worker[TaskT]] = []
    try:
        with _ignoring_interrupts():
            while len(crew) < workers and (first := list(islice(waiting, ahead))):
                with uninterrupted:
                    crew.append(_Worker(packed, setup, first))
        busy = {worker.connection: worker for worker in crew}
        while busy:
            for ready in wait(list(busy), _WORKER_POLL) or [
                answer for answer, worker in busy.items() if not worker.process.is_alive()
            ]:
                assert isinstance(ready, Connection)
                worker = busy[ready]
                try:
                    if not ready.poll():
                        raise EOFError
                    kind, content = ready.recv()
                except (EOFError, OSError):
                    worker.process.join()
                    died = f"its worker process died (exit code {worker.process.exitcode})"
                    if worker.process.exitcode == _UNGUARDED_EXIT:
                        died = (
                            "its worker process ran the script that starts the workers; put the script's "
                            'calls under if __name__ == "__main__":'
                        )
                    if lost is None:
                        raise work.error(f"{work.noun} {worker.held[0]}: {died}") from None
                    crew.remove(worker)
                    del busy[ready]
                    ready.close()
                    given_up = worker.held.popleft()
                    if left := [*worker.held, *islice(waiting, 1)]:
                        with _ignoring_interrupts(), uninterrupted:
                            crew.append(_Worker(packed, setup, left))
                        busy[crew[-1].connection] = crew[-1]
                    yield lost(given_up, died)
                    continue
                if kind == "report":
                    report(content)
                elif kind == "result":
                    worker.held.popleft()
                    worker.give(islice(waiting, 1))
                    if not worker.held:
                        del busy[ready]
                    yield content
                elif kind == "raised":
                    raise content
                else:
                    raise work.error(f"a worker process does not know what this one does: {content}")
    finally:
        let_go()
        _end([worker.process for worker in crew])


def _end(processes: list[BaseProcess]) -> None:
    """End processes, by force if they do not react."""
    for process in processes:
        process.terminate()
    end = time.monotonic() + _REACTION
    for process in processes:
        process.join(max(0.0, end - time.monotonic()))
    for process in processes:
        process.kill()
        process.join()


class _Worker(Generic[TaskT]):
    """A worker process and the tasks it holds, the one in progress first."""

    def __init__(self, packed: bytes, setup: Callable[[], object] | None, tasks: Iterable[TaskT]) -> None:
        # Forking a process whose threads hold locks (torch, numba) can hang.
        context = multiprocessing.get_context("spawn")
        self.connection, theirs = context.Pipe()
        self.process = context.Process(target=_serve, args=(setup, packed, theirs), daemon=True)
        self.process.start()
        theirs.close()
        self.held: deque[TaskT] = deque()
        self.give(tasks)

    def give(self, tasks: Iterable[TaskT]) -> None:
        for task in tasks:
            self.held.append(task)
            # A worker that has died is noticed where its answer is awaited.
            with suppress(OSError):
                self.connection.send(task)


def _serve(setup: Callable[[], object] | None, packed: bytes, connection: Connection) -> None:
    """Do tasks in a worker process until the connection ends."""
    threading.Thread(target=_end_with_parent, daemon=True).start()
    # One core a worker; numeric libraries that start threads of their own would take the others'.
    for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ.setdefault(variable, "1")
    tell_warnings()
    # What tasks import stays; looking through it for garbage takes a tenth of the start.
    gc.set_threshold(400_000, *gc.get_threshold()[1:])
    # The connection fails once the parent has closed its end and no longer waits for an answer.
    with _nothing_taken_apart(), ending(TERMINATE), suppress(EOFError, OSError):
        try:
            if setup is not None:
                setup()
            work: Work[object, object, object] = pickle.loads(packed)
        except Exception as error:
            needs = "what it needs must be defined in modules or files"
            connection.send(("unknown", f"{needs}: {type(error).__name__}: {error}"))
            return

        def report(message: object) -> None:
            connection.send(("report", message))

        while True:
            task = connection.recv()
            try:
                answer = "result", work.attempt(task, report)
            except Exception as error:
                error.add_note(f"in a worker process:\n{traceback.format_exc()}")
                connection.send(("raised", error))
                return
            connection.send(answer)


@contextmanager
def _nothing_taken_apart() -> Iterator[None]:
    """Let all objects end with the process: taking them apart one by one takes longer than a short task."""
    try:
        yield
    finally:
        gc.freeze()


def _end_with_parent() -> None:
    """End this process as soon as its parent has ended; a parent that is killed cannot say so."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os.kill(os.getpid(), signal.SIGTERM)
        time.sleep(_REACTION)
        os._exit(1)


@contextmanager
def _ignoring_interrupts() -> Iterator[None]:
    """Start processes that never see Ctrl-C: their parent does, and ends them."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def _ignore(message: object) -> None:
    """Drop a report that was not requested."""
