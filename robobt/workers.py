"""Tasks in this process or spread over worker processes."""

from __future__ import annotations

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
from dataclasses import dataclass
from itertools import islice
from multiprocessing.connection import Connection, wait
from multiprocessing.process import BaseProcess
from typing import Generic, TypeVar

from robobt.config.errors import RobobtError
from robobt.config.telling import tell_warnings
from robobt.signals import TERMINATE, ending, let_go, uninterrupted

TaskT = TypeVar("TaskT")
ReportT = TypeVar("ReportT")
ResultT = TypeVar("ResultT")

MAX_WORKERS = 256
"""Most worker processes of a run."""

_REACTION = 0.4
"""How long a worker that is told to end may take to finish its files [s]."""


@dataclass(slots=True, frozen=True)
class Work(Generic[TaskT, ReportT, ResultT]):
    """What is done with each task, and how a failure is put into words.

    Attributes:
        do: called with a task and a function that reports on its progress. For several workers it
            must be a function of a module or another object that can be pickled.
        noun: what error messages call a task; its number or name follows.
        error: raised, with a message of one line, when a task raises, its worker dies or the work
            cannot be sent to a worker.
        passed: exceptions of a task that are raised as they are.
    """

    do: Callable[[TaskT, Callable[[ReportT], None]], ResultT]
    noun: str
    error: type[Exception]
    passed: tuple[type[Exception], ...] = ()

    def attempt(self, task: TaskT, report: Callable[[ReportT], None]) -> ResultT:
        """Do one task in this process."""
        try:
            return self.do(task, report)
        except (self.error, *self.passed):
            raise
        except Exception as error:
            # robobt's own errors are written for users; any other may be a bug.
            said = str(error) if isinstance(error, RobobtError) else f"{type(error).__name__}: {error}"
            raise self.error(f"{self.noun} {task}: {said}") from error


def run_tasks(
    work: Work[TaskT, ReportT, ResultT],
    tasks: Iterable[TaskT],
    workers: int,
    *,
    ahead: int = 1,
    setup: Callable[[], object] | None = None,
    on_report: Callable[[ReportT], None] | None = None,
    lost: Callable[[TaskT, str], ResultT] | None = None,
) -> Generator[ResultT, None, None]:
    """Yield the result of every task, in the order in which they finish.

    Worker processes are spawned, ignore Ctrl-C, use one thread each and end with this
    process, however it ends; a task in progress is ended by an exception, so that it can
    finish its files. Close the generator to end them earlier.

    Args:
        work: what is done with each task.
        tasks: asked for the next one whenever a worker has room, so that it may end once enough is done.
        workers: number of processes; 0 is this process itself, and so is 1 unless ``lost`` is given.
        ahead: tasks a worker holds at a time; more than one keeps it busy when tasks are short.
        setup: called in each worker before ``work`` is unpickled, to import what that needs.
        on_report: called in this process with what tasks report.
        lost: makes the result of a task whose worker died, of the task and what happened; another worker
            takes the dead one's place. Without it the death is an error.

    Raises:
        Exception: as ``work`` says; a note holds the worker's traceback.
    """
    report = on_report or _ignore
    if workers < (2 if lost is None else 1):
        for task in tasks:
            yield work.attempt(task, report)
        return
    try:
        packed = pickle.dumps(work)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        raise work.error(f"{work.noun}s cannot be sent to worker processes: {error}") from error
    waiting = iter(tasks)
    crew: list[_Worker[TaskT]] = []
    try:
        with _ignoring_interrupts():
            while len(crew) < workers and (first := list(islice(waiting, ahead))):
                with uninterrupted:
                    crew.append(_Worker(packed, setup, first))
        busy = {worker.connection: worker for worker in crew}
        while busy:
            for ready in wait(list(busy)):
                assert isinstance(ready, Connection)
                worker = busy[ready]
                try:
                    kind, content = ready.recv()
                except (EOFError, OSError):
                    worker.process.join()
                    died = f"its worker process died (exit code {worker.process.exitcode})"
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
    """End processes, by force where they do not react."""
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
    # The connection fails once the parent has closed its end: nobody waits for an answer any more.
    with ending(TERMINATE), suppress(EOFError, OSError):
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
    """Drop a report that nobody asked for."""
