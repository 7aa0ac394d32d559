"""A robot may play a tree file that lies beside its scenario."""

from __future__ import annotations

from pathlib import Path

import pytest

from robobt.config.yaml import write_yaml
from robobt.match import ScenarioError, load_scenario, run_trials
from robobt.match.scenario.scenario import scenario_from
from robobt.plays import PLAYS
from robobt.skills import Stop
from robobt.worlds import sim_world

TREE = """
play: kicker
tree:
  Sequence:
    name: kicker
    memory: false
    children: [{children}]
"""


def scenario(folder: Path, children: str, play: str = "kicker.yaml") -> Path:
    (folder / "kicker.yaml").write_text(TREE.format(children=children))
    path = folder / "own.yaml"
    robot = {"number": 1, "play": play, "start": {"position": [-1.0, 0.0]}}
    path.write_text(write_yaml({"robots": {"blue": [robot]}, "ends": {"time_limit": 8.0}}))
    return path


@pytest.mark.integration
def test_it_is_played_by_workers_too(tmp_path: Path) -> None:
    loaded = load_scenario(scenario(tmp_path, "SelectShot, KickToTarget"))
    alone = run_trials(loaded, sim_world, trials=2)
    shared = run_trials(loaded, sim_world, trials=2, workers=2)
    assert [result.outcome for result in alone.results] == ["goal_blue"] * 2
    assert [result.trace for result in alone.results] == [result.trace for result in shared.results]


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match=r"own.yaml: robots.blue.0.play: .*nothing.yaml: cannot be read"):
        load_scenario(scenario(tmp_path, "SelectShot", play="nothing.yaml"))


def test_a_wrong_file_is_named_with_its_line(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match=r"robots.blue.0.play: .*kicker.yaml:7: .*SelectShort"):
        load_scenario(scenario(tmp_path, "SelectShort"))


def test_a_need_that_nothing_meets_is_told_before_the_match(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match=r"robots.blue.0.play: .*kicker/DribbleTo: reads 'target'"):
        load_scenario(scenario(tmp_path, "DribbleTo"))


def test_a_play_that_gives_every_robot_the_same_tree_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    shared = Stop()
    monkeypatch.setitem(PLAYS._entries, "shared", lambda: shared)
    robot = {"number": 1, "play": "shared", "start": {"position": [-1.0, 0.0]}}
    with pytest.raises(ScenarioError, match=r"robots.blue.0.play: shared returns the same nodes each time"):
        scenario_from({"robots": {"blue": [robot]}, "ends": {"time_limit": 1.0}}, "here")
