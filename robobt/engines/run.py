"""Runs tasks on the selected engine, by default in processes of this machine."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Protocol

from robobt.engines.local import run_locally
from robobt.engines.work import ReportT, ResultT, TaskT, Work


class Engine(Protocol):
    """An engine that runs tasks.

    Attributes:
        workers: number of tasks that it runs at a time.
    """

    workers: int

    def run(
        self,
        work: Work[TaskT, ReportT, ResultT],
        tasks: Iterable[TaskT],
        workers: int,
        *,
        setup: Callable[[], object] | None = None,
        on_report: Callable[[ReportT], None] | None = None,
        lost: Callable[[TaskT, str], ResultT] | None = None,
    ) -> Generator[ResultT, None, None]:
        """Yield the result of every task; the arguments are those of :func:`run_tasks`."""


_engine: ContextVar[Engine | None] = ContextVar("engine", default=None)


@contextmanager
def running_on(engine: Engine) -> Iterator[None]:
    """Return a context in which what is done in several processes runs on ``engine``."""
    token = _engine.set(engine)
    try:
        yield
    finally:
        _engine.reset(token)


def engine() -> Engine | None:
    """Return the engine for tasks, None for processes of this machine."""
    return _engine.get()


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

    A task's result does not depend on where it runs. Close the generator to end earlier.

    Args:
        work: the work on each task.
        tasks: iterated when a worker has capacity, so that it may end once enough is done.
        workers: number of tasks at a time, each in its own process; 0 uses this process, and so does 1 unless
            ``lost`` is given.
        ahead: tasks a worker process holds at a time; more than one keeps it busy when tasks are short.
        setup: called in each worker before ``work`` is unpickled, to import what that needs.
        on_report: called in this process with what tasks report.
        lost: makes the result of a task whose worker died, of the task and what happened; another worker
            takes the dead one's place. Without it the death is an error.

    Raises:
        Exception: as ``work`` says; a note holds the worker's traceback.
    """
    elsewhere = _engine.get()
    if elsewhere is None or workers < (2 if lost is None else 1):
        return run_locally(work, tasks, workers, ahead=ahead, setup=setup, on_report=on_report, lost=lost)
    return elsewhere.run(work, tasks, workers, setup=setup, on_report=on_report, lost=lost)
