"""Tasks on a Ray cluster; left out where Ray is not installed."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from robobt.engines.cluster import ClusterError, RayEngine
from robobt.engines.run import run_tasks, running_on
from robobt.engines.work import Work

pytestmark = [
    pytest.mark.integration,
    pytest.mark.usefixtures("spawned_workers"),
    pytest.mark.filterwarnings("ignore"),
]


_MODULES: dict[str, Any] = sys.modules


class SquareError(Exception):
    pass


def _square(task: int, report: Callable[[str], None]) -> int:
    if task < 0:
        raise ValueError("negative")
    if task == 99:
        os._exit(7)
    report(f"{task} squared")
    return task * task


SQUARES = Work(_square, "square of", SquareError)


@pytest.fixture(scope="module")
def engine() -> Iterator[RayEngine]:
    pytest.importorskip("ray", reason="needs Ray: pip install 'robobt[ray]'")
    with RayEngine("ray") as engine:
        yield engine


def test_every_task_gives_one_result_and_its_reports(engine: RayEngine) -> None:
    reports: list[str] = []
    with running_on(engine):
        found = sorted(run_tasks(SQUARES, range(20), 2, on_report=reports.append))
    assert found == [task * task for task in range(20)]
    assert sorted(reports) == sorted(f"{task} squared" for task in range(20))


def _note(task: Path, report: Callable[[str], None]) -> str:
    task.write_text("done")
    return str(task)


def test_a_path_is_the_drivers_wherever_the_cluster_was_started(
    engine: RayEngine, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert list(engine.run(Work(_note, "note", OSError), [Path("here.txt")], 1)) == ["here.txt"]
    assert (tmp_path / "here.txt").read_text() == "done"


def test_a_task_that_raises_is_named(engine: RayEngine) -> None:
    with pytest.raises(SquareError, match=r"^square of -1: ValueError: negative") as raised:
        list(engine.run(SQUARES, [-1], 2))
    assert "in a worker of the cluster" in raised.value.__notes__[0]


def test_a_task_that_ends_its_worker_each_time_is_given_up(engine: RayEngine) -> None:
    found = engine.run(SQUARES, [1, 99, 2], 2, lost=lambda task, why: -task)
    assert sorted(found) == [-99, 1, 4]
    with pytest.raises(SquareError, match="square of 99: lost 4 times"):
        list(engine.run(SQUARES, [99], 1))


def test_tasks_are_asked_for_only_while_there_is_room(engine: RayEngine) -> None:
    asked: list[int] = []

    def tasks() -> Iterator[int]:
        for task in range(10):
            asked.append(task)
            yield task

    results = engine.run(SQUARES, tasks(), 2)
    next(results)
    assert len(asked) <= 4
    results.close()


def test_seeds_are_trained_on_a_cluster_as_in_this_process(engine: RayEngine, tmp_path: Path) -> None:
    from robobt.learning.training.settings import load_settings
    from robobt.learning.training.train import train_seeds
    from tests.learning.training.test_several_robots import TINY

    settings = load_settings("duel", "fast", TINY)
    here = train_seeds(settings, [3, 4], tmp_path / "here")
    with running_on(engine):
        there = train_seeds(settings, [3, 4], tmp_path / "there", workers=2)
    assert [run.figures["weights"] for run in there] == [run.figures["weights"] for run in here]
    assert here[0].figures["weights"] != here[1].figures["weights"]


def test_work_that_cannot_be_sent_is_told(engine: RayEngine) -> None:
    with pytest.raises(SquareError, match=r"square ofs cannot be sent"):
        list(engine.run(Work(lambda task, _: task, "square of", SquareError), [1], 2))


@pytest.mark.parametrize(
    ("address", "problem"),
    [
        ("rays", "an engine is local, ray, or ray://HOST:PORT"),
        ("ray?cpu=1", "cpu: there is no such option; there are cpus, ship"),
        ("ray?cpus=0", "cpus: is a number of cores above 0"),
        ("ray?cpus=many", "cpus: is a number of cores above 0"),
        ("ray?ship=perhaps", "ship: is yes or no"),
    ],
)
def test_a_wrong_address_is_told(address: str, problem: str) -> None:
    with pytest.raises(ClusterError, match=problem):
        RayEngine(address)


def test_without_ray_it_is_told_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(_MODULES, "ray", None)
    with pytest.raises(ClusterError, match=r"pip install \"robobt\[ray\]\""):
        RayEngine("ray")


def test_a_package_that_is_run_where_it_lies_is_sent_beside_robobt(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sent: set[str] = set()

    def init(**options: Any) -> None:
        sent.update(os.listdir(options["runtime_env"]["working_dir"]))

    cluster = SimpleNamespace(
        is_initialized=lambda: False, init=init, cluster_resources=dict, shutdown=lambda: None
    )
    (tmp_path / "tables").mkdir()
    (tmp_path / "tables" / "__main__.py").touch()
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(_MODULES, "ray", cluster)
    monkeypatch.setitem(_MODULES, "__main__", SimpleNamespace(__file__=str(tmp_path / "tables/__main__.py")))
    RayEngine("ray://127.0.0.1:10001").close()
    assert sent == {"robobt", "tables", "models", "examples"}


def test_a_head_that_does_not_answer_is_told_what_it_needs(monkeypatch: pytest.MonkeyPatch) -> None:
    def unreachable(**_: object) -> None:
        raise ConnectionError("ray client connection timeout")

    silent = SimpleNamespace(is_initialized=lambda: False, init=unreachable, shutdown=lambda: None)
    monkeypatch.setitem(_MODULES, "ray", silent)
    with pytest.raises(ClusterError, match=r"client port of a head that has \"ray\[client\]\"\?"):
        RayEngine("ray://127.0.0.1:10001?ship=no")
