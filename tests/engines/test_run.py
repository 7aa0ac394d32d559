"""Tasks run where the program was told to."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable
from typing import Any

from robobt.cli.common import cores
from robobt.engines.run import engine, run_tasks, running_on
from robobt.engines.work import Work


def double(task: int, _: Callable[[Any], None]) -> int:
    return 2 * task


WORK = Work(double, "double of", RuntimeError)


class Elsewhere:
    """Says how often it was asked."""

    workers = 7

    def __init__(self) -> None:
        self.asked = 0

    def run(
        self, work: Work[Any, Any, Any], tasks: Iterable[Any], workers: int, **_: object
    ) -> Generator[Any, None, None]:
        self.asked += 1
        return (work.attempt(task, print) for task in tasks)


def test_what_needs_processes_is_run_on_the_engine_and_nothing_else() -> None:
    elsewhere = Elsewhere()
    with running_on(elsewhere):
        assert engine() is elsewhere
        assert cores() == 7
        assert list(run_tasks(WORK, [1, 2], 2)) == [2, 4]
        assert elsewhere.asked == 1
        # A match over the network holds ports of this process.
        assert list(run_tasks(WORK, [1, 2], 1)) == [2, 4]
        assert elsewhere.asked == 1
        assert list(run_tasks(WORK, [1, 2], 1, lost=lambda task, _: task)) == [2, 4]
        assert elsewhere.asked == 2
    assert engine() is None
    assert list(run_tasks(WORK, [3], 1)) == [6]
