"""Users' code neither moves a match to another folder nor doubles it."""

from __future__ import annotations

import multiprocessing
import os
import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from robobt.match import MatchLoop, run_trials_in
from robobt.match.recording import load_recording
from robobt.match.scenario.scenario import Scenario, scenario_from
from robobt.match.steering import Steering
from robobt.plays import PLAYS
from robobt.skills.base import Skill
from robobt.tree import Behaviour, Status
from robobt.world import RobotId, Team
from tests.match.scripted import PlainWorld, data

DOES: dict[str, Callable[[], object]] = {"nothing": lambda: None}
ENDED: list[int] = []


class Strays(Skill):
    """Does something that concerns the whole process, at the second tick or already before the first one."""

    def __init__(self, does: str, when: str) -> None:
        super().__init__()
        self.does, self.when, self.ticks = does, when, 0
        self._do("building")

    def setup(self, **_: Any) -> None:
        self._do("setup")

    def shutdown(self) -> None:
        self._do("shutdown")

    def on_running(self) -> Status:
        self.ticks += 1
        if self.ticks == 2:
            self._do("ticking")
        return self.run()

    def _do(self, when: str) -> None:
        if when == self.when:
            DOES[self.does]()


def _strays(*, does: str = "nothing", when: str = "ticking") -> Behaviour:
    return Strays(does, when)


if "strays" not in PLAYS:
    PLAYS.register("strays")(_strays)


def scenario(does: str, when: str = "ticking") -> Scenario:
    given = data(ends={"time_limit": 0.1})
    start = {"position": [-2.0, 2.0], "heading": 0.0}
    robot = {"number": 1, "play": "strays", "params": {"does": does, "when": when}, "start": start}
    given["robots"]["blue"].append(robot)
    return scenario_from(given, "test.yaml")


@pytest.fixture
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder that a skill goes to; the match is played in another one."""
    away = tmp_path / "away"
    away.mkdir()
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    monkeypatch.setitem(DOES, "goes away", lambda: os.chdir(away))
    return away


@pytest.mark.parametrize("when", ["building", "setup", "ticking", "shutdown"])
def test_outputs_go_where_the_match_was_started_whatever_folder_a_skill_goes_to(
    when: str, elsewhere: Path, caplog: pytest.LogCaptureFixture
) -> None:
    here = Path.cwd()
    record = {trial: f"trial-{trial}.robobt.arrows" for trial in range(2)}
    run_trials_in(scenario("goes away", when), PlainWorld, 2, out=Path("results.jsonl"), record=record)
    assert Path.cwd() == here
    assert sorted(path.name for path in here.iterdir()) == ["results.jsonl", *record.values()]
    assert list(elsewhere.iterdir()) == []
    assert len(load_recording(here / record[1])) == 6
    assert re.search(r"change[sd] the working folder, which was (put back|restored); name files", caplog.text)


def test_a_recording_goes_on_in_the_folder_where_it_began(elsewhere: Path) -> None:
    here = Path.cwd()
    with MatchLoop(scenario("nothing"), 1, PlainWorld, record="match.robobt.arrows") as match:
        match.tick()
        os.chdir(elsewhere)
        Steering(match).play(RobotId(Team.BLUE, 1), "scripted", {})
        match.tick()
    assert sorted(path.name for path in here.iterdir()) == ["match-2.robobt.arrows", "match.robobt.arrows"]


def forks(child: Callable[[], object]) -> None:
    """Fork; the copy does something and goes on, where the skill's next line is."""
    number = os.fork()
    if number == 0:
        child()
    else:
        ENDED.append(os.waitstatus_to_exitcode(os.waitpid(number, 0)[1]))


def by_multiprocessing() -> None:
    process = multiprocessing.get_context("fork").Process(target=print)
    process.start()
    process.join()
    ENDED.append(-1 if process.exitcode is None else process.exitcode)


COPIES: dict[str, tuple[Callable[[], object], int]] = {
    "goes on": (lambda: forks(lambda: None), 0),
    "raises": (lambda: forks(lambda: 1 / 0), 0),
    "exits": (lambda: forks(lambda: sys.exit(3)), 3),
    "exits with words": (lambda: forks(lambda: sys.exit("no")), 1),
    "is interrupted": (lambda: forks(lambda: (_ for _ in ()).throw(KeyboardInterrupt)), 1),
    "ends by itself": (lambda: forks(lambda: os._exit(4)), 4),
    "of multiprocessing": (by_multiprocessing, 0),
}


@pytest.mark.skipif(not hasattr(os, "fork"), reason="needs fork")
@pytest.mark.filterwarnings("ignore:.*multi-threaded.*:DeprecationWarning")
@pytest.mark.parametrize("when", ["setup", "ticking"])
@pytest.mark.parametrize("copy", COPIES)
def test_a_copy_that_a_skill_forks_writes_nothing(
    copy: str, when: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    ENDED.clear()
    monkeypatch.setitem(DOES, copy, COPIES[copy][0])
    for does in ("nothing", copy):
        path = tmp_path / f"{does}.robobt.arrows"
        run_trials_in(scenario(does, when), PlainWorld, 1, out=tmp_path / f"{does}.jsonl", record={0: path})
    assert [COPIES[copy][1]] == ENDED
    plain, forked = [load_recording(tmp_path / f"{does}.robobt.arrows") for does in ("nothing", copy)]
    assert forked.complete
    assert list(forked.times) == list(plain.times)
    assert len((tmp_path / f"{copy}.jsonl").read_text().splitlines()) == 2
