"""Nodes of users are set up before a match and shut down after it, however it ends."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest
from py_trees.behaviour import Behaviour

from robobt.match import MatchLoop, RunError, Scenario, run_trials_in
from robobt.match.scenario.scenario import scenario_from
from robobt.match.steering import Steering
from robobt.plays import PLAYS
from robobt.tree import Inverter, Status
from robobt.world import RobotId, Team
from tests.match.scripted import PlainWorld, data

DIARY: list[str] = []


class Connected(Behaviour):
    def __init__(self, name: str, breaks: bool) -> None:
        super().__init__(name)
        self.breaks = breaks

    def setup(self, **_: Any) -> None:
        if self.breaks:
            raise ConnectionError("no camera")
        DIARY.append(f"{self.name} set up")

    def shutdown(self) -> None:
        DIARY.append(f"{self.name} shut down")

    def update(self) -> Status:
        DIARY.append(f"{self.name} ticked")
        return Status.RUNNING


def _connected(*, breaks: bool = False, name: str = "leaf") -> Behaviour:
    return Inverter("not", Connected(name, breaks))


if "connected" not in PLAYS:
    PLAYS.register("connected")(_connected)


@pytest.fixture(autouse=True)
def diary() -> list[str]:
    DIARY.clear()
    return DIARY


def scenario(breaks: bool = False, **changes: Any) -> Scenario:
    given = data(ends={"time_limit": 0.06}, **changes)
    for number, broken in ((1, False), (2, breaks)):
        start = {"position": [-2.0, float(number)], "heading": 0.0}
        params = {"breaks": broken, "name": f"robot {number}"}
        given["robots"]["blue"].append(
            {"number": number, "play": "connected", "params": params, "start": start}
        )
    return scenario_from(given, "mine.yaml")


def test_each_trial_sets_its_trees_up_and_shuts_them_down(diary: list[str]) -> None:
    run_trials_in(scenario(), PlainWorld, 2)
    trial = [
        *("robot 1 set up", "robot 2 set up"),
        *["robot 1 ticked", "robot 2 ticked"] * 3,
        *("robot 1 shut down", "robot 2 shut down"),
    ]
    assert diary == trial * 2


def test_a_robot_that_could_not_be_set_up_stands_still_and_the_others_play() -> None:
    (result,) = run_trials_in(scenario(breaks=True), PlainWorld, 1).results
    assert [robot.errors for robot in result.robots.values()] == [0, 0, 3]
    assert str(result.robots["blue 2"].first_error).startswith(
        "not/robot 2: setup() failed: ConnectionError: no camera"
    )


def test_in_development_the_run_ends_with_the_robot_and_the_nodes_path(diary: list[str]) -> None:
    broken = scenario(breaks=True, on_error="raise")
    with pytest.raises(RunError, match=r"^mine\.yaml: trial 0: blue 2: not/robot 2: setup\(\) failed: "):
        run_trials_in(broken, PlainWorld, 1)
    assert diary == ["robot 1 set up", "robot 1 ticked", "robot 1 shut down"]


def test_trees_are_shut_down_once_when_a_match_breaks_off(diary: list[str]) -> None:
    with suppress(ZeroDivisionError), MatchLoop(scenario(), 0, PlainWorld) as match:
        match.tick()
        match.close()
        raise ZeroDivisionError
    assert diary[-2:] == ["robot 1 shut down", "robot 2 shut down"]
    assert len(diary) == 6


def test_trees_are_shut_down_where_the_match_cannot_be_recorded(diary: list[str], tmp_path: Path) -> None:
    with pytest.raises(OSError, match="Is a directory"):
        MatchLoop(scenario(), 0, PlainWorld, record=tmp_path)
    assert diary[-2:] == ["robot 1 shut down", "robot 2 shut down"]


def test_another_tree_in_the_middle_of_a_match_is_set_up_and_the_old_one_shut_down(diary: list[str]) -> None:
    with MatchLoop(scenario(), 0, PlainWorld) as match:
        steering, robot = Steering(match), RobotId(Team.BLUE, 2)
        match.tick()
        diary.clear()
        steering.play(robot, "connected", {"name": "new"})
        match.tick()
    assert [entry for entry in diary if not entry.startswith("robot 1")] == [
        *("new set up", "robot 2 shut down", "new ticked", "new shut down")
    ]
