"""Nodes are replaced by scripts, by the pattern of their paths, or one clear error says why not."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from py_trees.common import ParallelPolicy

from robobt.plays import PLAYS
from robobt.tree import (
    Behaviour,
    Inverter,
    Parallel,
    Selector,
    Sequence,
    Status,
    TreeRunner,
    node_path,
    preorder,
)
from robobt.tree.devtools import ScriptedLeaf, read_substitutions, substitute, substitutions
from robobt.tree.interop import TreeFileError
from robobt.tree.nodes import Switch
from tests.tree.scripted import Notes, Scripted, Watched, scripted

S, F, R = Status.SUCCESS, Status.FAILURE, Status.RUNNING


def tree() -> Behaviour:
    """root: (guard, not: inner, last)."""
    first, inner, last = scripted(guard="F", inner="F", last="R")
    return Sequence("root", memory=False, children=[first, Inverter("not", inner), last])


def paths(root: Behaviour) -> list[str]:
    return [node_path(node) for node in preorder(root)]


def test_a_node_becomes_a_leaf_of_its_name_with_a_fixed_status() -> None:
    root = tree()
    before = paths(root)
    assert substitute(root, {"root/guard": "SUCCESS"}) is root
    assert paths(root) == before
    watched = Watched(root)
    assert watched.ticks(2) == "RR"
    assert watched.ticked == "inner last"


def test_a_script_goes_on_tick_by_tick_and_stays_at_its_last_status() -> None:
    watched = Watched(substitute(tree(), {"*/guard": ["SUCCESS", "FAILURE", "RUNNING"]}))
    assert watched.ticks(5) == "RFRRR"


def test_an_interruption_does_not_begin_a_script_anew() -> None:
    guard = Scripted("guard", "FSF")
    script = ScriptedLeaf("script", [R, R, F])
    watched = Watched(Selector("root", memory=False, children=[guard, script]))
    assert [watched.tick() + ("+" if script.status is R else "-") for _ in range(4)] == [
        "R+",
        "S-",
        "R+",
        "F-",
    ]


def test_what_is_below_a_decorator_can_be_replaced() -> None:
    root = substitute(tree(), {"root/guard": S, "root/not/inner": [F, S]})
    assert Watched(root).ticks(2) == "RF"


def test_a_pattern_reaches_through_slashes_and_may_match_many() -> None:
    root = substitute(tree(), {"root/*n*": "FAILURE", "root/[gl]*": "SUCCESS"})
    assert [type(node) for node in root.children] == [ScriptedLeaf] * 3
    assert len(preorder(root)) == 4


def test_the_first_rule_that_matches_counts() -> None:
    root = substitute(tree(), {"*/guard": "RUNNING", "root/*": "SUCCESS"})
    assert Watched(root).tick() == "R"


def test_the_root_can_be_replaced() -> None:
    root = substitute(tree(), {"root": "SUCCESS"})
    assert isinstance(root, ScriptedLeaf)
    assert Watched(root).tick() == "S"


def test_a_case_of_a_switch_can_be_replaced() -> None:
    class Always(Switch):
        def case(self) -> str:
            return "here"

    root = Always("switch", {"here": Scripted("a", "F")})
    assert Watched(substitute(root, {"*/a": "SUCCESS"})).tick() == "S"


def test_a_selected_child_of_a_parallel_stays_selected() -> None:
    one, other = scripted(one="F", other="R")
    policy = ParallelPolicy.SuccessOnSelected([one], synchronise=False)
    root = substitute(Parallel("all", policy, [one, other]), {"all/one": "SUCCESS"})
    assert Watched(root).tick() == "S"


def test_the_rest_of_a_shipped_play_is_left_as_it_was() -> None:
    root = PLAYS["field_player"]()
    before = paths(root)
    substitute(root, {"*/get the ball": "RUNNING"})
    gone = set(before) - set(paths(root))
    assert {path.rpartition("/")[2] for path in gone} == {"GoToBall", "PickUpBall"}
    assert [path for path in before if path not in gone] == paths(root)


def test_rules_come_from_a_file(tmp_path: Path) -> None:
    file = tmp_path / "rules.yaml"
    file.write_text(
        '"*/guard": SUCCESS\n"*/inner": [RUNNING, FAILURE]\n'
        '"root/last": {script: [SUCCESS]}\n"x": {status: FAILURE}\n'
    )
    rules = read_substitutions(file)
    assert [(rule.pattern, rule.script, rule.line) for rule in rules] == [
        ("*/guard", (S,), 1),
        ("*/inner", (R, F), 2),
        ("root/last", (S,), 3),
        ("x", (F,), 4),
    ]
    root = substitute(tree(), rules[:3])
    runner = TreeRunner(root, Notes())
    assert [runner.tick(), runner.tick()] == [R, S]


WRONG = {
    "": "rules.yaml:1: rules map patterns of paths to statuses",
    "[SUCCESS]": "rules.yaml:1: rules map patterns",
    '"*/guard": SUCCES': "rules.yaml:1: */guard: 'SUCCES' is not SUCCESS, FAILURE or RUNNING",
    '"*/guard": INVALID': "'INVALID' is not SUCCESS",
    '"*/guard": 3': "3 is not SUCCESS",
    '"*/guard":': "None is not SUCCESS",
    '"*/guard": [SUCCESS,\n  [FAILURE]]': "rules.yaml:2: */guard: a list is not SUCCESS",
    '"*/guard": [SUCCESS, {a: b}]': "a mapping is not SUCCESS",
    '"*/guard": []': "rules.yaml:1: */guard: the script is empty",
    '"*/guard":\n  status: SUCCESS\n  ticks: 3': "rules.yaml:3: */guard: unknown key 'ticks'; a rule has",
    '"*/guard": {}': "a rule has either status or script",
    '"*/guard": {status: SUCCESS, script: [SUCCESS]}': "a rule has either status or script",
    '"*/guard": {status: [SUCCESS]}': "status is one status",
    '"*/guard": {script: SUCCESS}': "script is a list of statuses",
    '"*/guard": SUCCESS\n"*/gaurd": SUCCESS': "rules.yaml:2: no node of the tree is left for '*/gaurd'",
    '"*/not": SUCCESS\n"*/inner": SUCCESS': "rules.yaml:2: no node of the tree is left for '*/inner'",
    '"*/guard": SUCCESS\n"*/guard": FAILURE': "rules.yaml:2: the key '*/guard' is given twice",
    "*/guard: SUCCESS": "rules.yaml:1: ",
    "a: !!python/name:os.system": "rules.yaml:1: the tag",
}


@pytest.mark.parametrize("text", WRONG)
def test_a_wrong_file_is_one_clear_error_and_leaves_the_tree_alone(text: str, tmp_path: Path) -> None:
    file = tmp_path / "rules.yaml"
    file.write_text(text)
    root = tree()
    children = list(root.children)
    with pytest.raises(TreeFileError) as caught:
        substitute(root, file)
    assert WRONG[text] in str(caught.value)
    assert "\n" not in str(caught.value)
    assert root.children == children


def test_a_file_that_is_not_there_is_an_error_too(tmp_path: Path) -> None:
    with pytest.raises(TreeFileError, match=r"nowhere\.yaml: cannot be read"):
        read_substitutions(tmp_path / "nowhere.yaml")


@pytest.mark.parametrize("rules", [{}, {"a": "no"}, {"a": Status.INVALID}, {"a": {"b": S}}, {"*/x": S}])
def test_given_rules_are_checked_as_well(rules: dict[str, Any]) -> None:
    with pytest.raises(TreeFileError, match=r"^rules: "):
        substitute(tree(), rules)


def test_given_rules_may_be_checked_once_and_used_often() -> None:
    rules = substitutions({"*/guard": S, "*/inner": F}, "my test")
    assert [Watched(substitute(tree(), rules)).tick() for _ in range(2)] == ["R", "R"]


def test_a_script_has_at_least_one_status() -> None:
    with pytest.raises(ValueError, match="the script of 'x' is empty"):
        ScriptedLeaf("x", [])
