"""Nodes of a match's trees that follow a script instead."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from robobt.config.yaml import write_yaml
from robobt.match import Scenario, ScenarioError, load_scenario, run_trials_in
from robobt.match.results.file import ResultsFileError
from robobt.match.scenario.scenario import scenario_from
from robobt.match.scenario.substitution import substituted
from robobt.tree import preorder
from robobt.tree.devtools import ScriptedLeaf
from tests.match.scripted import PlainWorld, data


def two_robots(**first: Any) -> dict[str, Any]:
    robots = [
        {"number": 0, "play": "attack_main", "start": {"position": [-2.0, 0.0], "heading": 0.0}, **first},
        {"number": 1, "play": "goalkeeper", "start": {"position": [-4.0, 0.0], "heading": 0.0}},
    ]
    return data(robots={"blue": robots, "yellow": []}, ends={"time_limit": 0.1})


def scripted_nodes(scenario: Scenario) -> dict[str, list[str]]:
    return {
        str(robot): [node.name for node in preorder(setup.build_tree()) if isinstance(node, ScriptedLeaf)]
        for robot, setup in scenario.robots
    }


def test_a_scenario_says_which_nodes_follow_a_script() -> None:
    rules = {"*/GoToBall": "FAILURE", "*/PickUpBall": ["RUNNING", "SUCCESS"]}
    scenario = scenario_from(two_robots(substitute=rules), "mine.yaml")
    assert scripted_nodes(scenario) == {"blue 0": ["GoToBall", "PickUpBall"], "blue 1": []}


def test_the_rules_may_be_in_a_file_beside_the_scenario(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "rules.yaml").write_text('"*/GoToBall": FAILURE\n')
    (tmp_path / "mine.yaml").write_text(write_yaml(two_robots(substitute="rules.yaml")))
    scenario = load_scenario(str(tmp_path / "mine.yaml"))
    assert scripted_nodes(scenario)["blue 0"] == ["GoToBall"]
    out = tmp_path / "results.jsonl"
    run_trials_in(scenario, PlainWorld, 1, out=out)
    (tmp_path / "rules.yaml").write_text('"*/GoToBall": SUCCESS\n')
    with pytest.raises(ResultsFileError, match="another version of the scenario"):
        run_trials_in(scenario, PlainWorld, 1, out=out)


@pytest.mark.parametrize(
    ("rules", "said"),
    [
        ({"*/Nobody": "SUCCESS"}, r"substitute: no node of the tree is left for '\*/Nobody'"),
        ({"*/GoToBall": "DONE"}, r"substitute: \*/GoToBall: 'DONE' is not SUCCESS, FAILURE or RUNNING"),
        ({"*/SelectShot": "SUCCESS"}, "play: .*reads 'shot', but no other node of the tree writes it"),
        ("nowhere.yaml", "substitute: nowhere.yaml: cannot be read"),
        (3, "substitute"),
    ],
)
def test_what_is_wrong_is_told_with_its_field(rules: object, said: str) -> None:
    with pytest.raises(ScenarioError, match=rf"^mine\.yaml: robots\.blue\.0\.{said}"):
        scenario_from(two_robots(substitute=rules), "mine.yaml")


def test_rules_can_be_given_for_one_robot_or_a_team() -> None:
    scenario = scenario_from(two_robots(), "mine.yaml")
    one = substituted(scenario, [("blue 1", "goalkeeper", "RUNNING")])
    assert scripted_nodes(one) == {"blue 0": [], "blue 1": ["goalkeeper"]}
    both = substituted(scenario, [("blue", "*/KickToTarget", "FAILURE")])
    assert all(set(names) == {"KickToTarget"} for names in scripted_nodes(both).values())
    assert scripted_nodes(scenario) == {"blue 0": [], "blue 1": []}
    assert both.source == "mine.yaml"


def test_given_rules_come_before_the_scenarios_own() -> None:
    scenario = scenario_from(two_robots(substitute={"*/GoToBall": "FAILURE"}), "mine.yaml")
    tree = substituted(scenario, [("blue 0", "*/GoToBall", "SUCCESS")]).robots.blue[0].build_tree()
    (leaf,) = [node for node in preorder(tree) if isinstance(node, ScriptedLeaf)]
    assert leaf.script[0].value == "SUCCESS"


@pytest.mark.parametrize(
    ("rule", "said"),
    [
        (("blue 7", "*", "SUCCESS"), "no robot 'blue 7' to substitute nodes of; there are blue 0, blue 1"),
        (("yellow", "*", "SUCCESS"), "no robot 'yellow'"),
        (("blue", "*/GoToBall", "SUCCESS"), r"blue 1: no node of the tree is left for '\*/GoToBall'"),
        (("blue 0", "*/SelectShot", "SUCCESS"), "blue 0: .*reads 'shot', but no other node"),
    ],
)
def test_a_rule_that_does_not_fit_is_told_with_the_robot(rule: tuple[str, str, str], said: str) -> None:
    with pytest.raises(ScenarioError, match=said):
        substituted(scenario_from(two_robots(), "mine.yaml"), [rule])


def test_rules_in_a_file_are_not_mixed_with_others(tmp_path: Path) -> None:
    rules = tmp_path / "rules.yaml"
    rules.write_text('"*/GoToBall": FAILURE\n')
    scenario = scenario_from(two_robots(substitute=str(rules)), "mine.yaml")
    with pytest.raises(ScenarioError, match=r"blue 0 has its rules in .*rules\.yaml; add yours there"):
        substituted(scenario, [("blue 0", "*/PickUpBall", "FAILURE")])
