import os
import signal
import threading
import time
from collections.abc import Callable, Iterator

import pytest

from robobt.config.errors import RobobtError
from robobt.engines.run import run_tasks
from robobt.engines.work import Work

pytestmark = [pytest.mark.integration, pytest.mark.usefixtures("spawned_workers")]


class SquareError(Exception):
    pass


def _square(task: int, report: Callable[[str], None]) -> int:
    if task < 0:
        raise ValueError("negative")
    if task == 13:
        raise LookupError("unlucky")
    if task == 99:
        os._exit(7)
    if task == 98:
        child = os.fork()
        if not child:
            time.sleep(600)
        report(str(child))
        os._exit(8)
    report(f"{task} squared")
    return task * task


SQUARES = Work(_square, "square of", SquareError, passed=(LookupError,))


@pytest.mark.parametrize("workers", [1, 2])
def test_every_task_gives_one_result_and_its_reports(workers: int):
    reports: list[str] = []
    assert sorted(run_tasks(SQUARES, range(5), workers, ahead=2, on_report=reports.append)) == [
        0,
        1,
        4,
        9,
        16,
    ]
    assert sorted(reports) == [f"{task} squared" for task in range(5)]


@pytest.mark.parametrize("workers", [1, 2])
def test_a_task_that_raises_is_named(workers: int):
    with pytest.raises(SquareError, match=r"^square of -1: ValueError: negative"):
        list(run_tasks(SQUARES, [-1, -1], workers))


def test_a_task_whose_worker_dies_can_have_a_result_and_the_others_are_done_all_the_same():
    def lost(task: int, why: str) -> int:
        assert why == "its worker process died (exit code 7)"
        return -task

    tasks = [1, 99, 2, 99, 3, 4]
    for workers in (1, 2):
        found = sorted(run_tasks(SQUARES, tasks, workers, ahead=2, lost=lost))
        assert found == [-99, -99, 1, 4, 9, 16]


def test_an_error_of_robobt_says_what_is_wrong_without_its_class():
    def refuse(_: int, __: Callable[[str], None]) -> int:
        raise RobobtError("there is no such file")

    with pytest.raises(SquareError, match=r"^square of 1: there is no such file$"):
        list(run_tasks(Work(refuse, "square of", SquareError), [1], 1))


@pytest.mark.parametrize("workers", [1, 2])
def test_some_exceptions_are_raised_as_they_are(workers: int):
    with pytest.raises(LookupError, match=r"^unlucky"):
        list(run_tasks(SQUARES, [13, 13], workers))


def test_the_traceback_of_a_worker_comes_with_its_exception():
    with pytest.raises(SquareError) as caught:
        list(run_tasks(SQUARES, [-1], 2))
    assert 'raise ValueError("negative")' in caught.value.__notes__[0]


def test_a_worker_that_dies_is_named_with_the_task_it_died_in():
    with pytest.raises(SquareError, match=r"^square of 99: its worker process died \(exit code 7\)$"):
        list(run_tasks(SQUARES, [99, 1], 2, ahead=2))


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
def test_a_worker_that_dies_is_noticed_though_a_process_that_it_forked_lives_on():
    children: list[str] = []
    died = pytest.raises(SquareError, match=r"^square of 98: its worker process died \(exit code 8\)$")
    try:
        with died:
            list(run_tasks(SQUARES, [98], 2, on_report=children.append))
    finally:
        os.kill(int(children[0]), signal.SIGKILL)


def test_workers_are_started_outside_the_main_thread_too():
    results: list[int] = []
    thread = threading.Thread(target=lambda: results.extend(run_tasks(SQUARES, range(3), 2)))
    thread.start()
    thread.join()
    assert sorted(results) == [0, 1, 4]


@pytest.mark.parametrize("workers", [1, 2])
def test_tasks_are_asked_for_only_while_there_is_room(workers: int):
    asked: list[int] = []

    def tasks() -> Iterator[int]:
        for task in range(100):
            asked.append(task)
            yield task

    results = run_tasks(SQUARES, tasks(), workers)
    next(results)
    results.close()
    assert len(asked) <= 2 * workers
