"""A robot may play a tree file that lies beside its scenario."""

from __future__ import annotations

import pickle
from pathlib import Path

import pytest

from robobt.config.yaml import write_yaml
from robobt.match import ScenarioError, load_scenario, run_trials_in
from robobt.match.runner import RunError
from robobt.match.scenario.scenario import Scenario, scenario_from
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
    alone = run_trials_in(loaded, sim_world, trials=2)
    shared = run_trials_in(loaded, sim_world, trials=2, workers=2)
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


def with_robots(play: str, count: int) -> Scenario:
    robots = [
        {"number": number, "play": play, "start": {"position": [-1.0, number]}} for number in range(count)
    ]
    return scenario_from({"robots": {"blue": robots}, "ends": {"time_limit": 0.2}}, "here")


def test_a_play_that_gives_every_robot_the_same_tree_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    shared = Stop()
    monkeypatch.setitem(PLAYS._entries, "shared", lambda: shared)
    with pytest.raises(ScenarioError, match=r"robots.blue.1.play: .*'shared' returns the same nodes each"):
        with_robots("shared", 2)


def test_a_play_that_gives_every_match_the_same_tree_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    shared = Stop()
    monkeypatch.setitem(PLAYS._entries, "shared", lambda: shared)
    with pytest.raises(RunError, match="'shared' returns the same nodes each time"):
        run_trials_in(with_robots("shared", 1), sim_world, trials=2)


def test_a_tree_is_built_once_where_a_scenario_is_loaded_and_played_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    built: list[Stop] = []

    def counted() -> Stop:
        built.append(Stop())
        return built[-1]

    monkeypatch.setitem(PLAYS._entries, "counted", counted)
    scenario = with_robots("counted", 2)
    assert len(built) == 2
    again = pickle.loads(pickle.dumps(scenario))
    run_trials_in(scenario, sim_world, trials=1)
    assert len(built) == 2
    run_trials_in(scenario, sim_world, trials=1)
    run_trials_in(again, sim_world, trials=1)
    assert len(built) == 6


def test_a_changed_copy_of_a_robot_plays_a_tree_of_its_own() -> None:
    one = with_robots("goalkeeper", 1).robots.blue[0]
    other = one.model_copy(update={"play": "stand_still"})
    assert one == one.model_copy()
    assert other.build_tree().name == PLAYS["stand_still"]().name
    assert one.build_tree().name == PLAYS["goalkeeper"]().name
