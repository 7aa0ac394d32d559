"""What the nodes of a play do in a match, counted."""

from __future__ import annotations

from pathlib import Path

import pytest

from robobt.match import ScenarioError, run_trials_in
from robobt.match.node_statistics import node_statistics
from robobt.match.scenario.scenario import scenario_from
from robobt.world import RobotId, Team
from tests.match.scripted import PlainWorld, data

BLUE_0 = RobotId(Team.BLUE, 0)


def scenario(**changes: object):
    return scenario_from(data(ends={"time_limit": 0.2}, **changes), "mine.yaml")


def test_every_tick_of_the_first_trial_is_counted() -> None:
    counted = node_statistics(scenario(), PlainWorld)
    (node,) = counted[BLUE_0].counts()
    assert node.path == "Scripted"
    assert node.ticks == node.runs == run_trials_in(scenario(), PlainWorld, 1).results[0].ticks - 1


def test_only_robots_with_the_play_are_counted() -> None:
    assert list(node_statistics(scenario(), PlainWorld, "scripted")) == [BLUE_0]
    with pytest.raises(
        ScenarioError, match=r"^mine\.yaml: robots: no robot plays 'goalkeeper'; they play scr"
    ):
        node_statistics(scenario(), PlainWorld, "goalkeeper")


def test_a_tree_file_is_known_by_any_path_to_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "still.yaml").write_text("play: still\ntree: Stop\n")
    robot = {"number": 0, "play": str(tmp_path / "still.yaml"), "start": {"position": [-2.0, 0.0]}}
    monkeypatch.chdir(tmp_path)
    played = scenario(robots={"blue": [robot], "yellow": []})
    assert list(node_statistics(played, PlainWorld, "still.yaml")) == [BLUE_0]
