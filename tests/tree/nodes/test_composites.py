"""Composites of the package: what the table of docs/control_nodes.md does not say."""

from __future__ import annotations

import pytest
from py_trees.decorators import FailureIsRunning

from robobt.tree import Parallel, Selector, Sequence, TreeError, tree_text
from robobt.tree.nodes import CommitFor, CommittingSelector, ParallelCount, SequenceWithMemory, Switch
from tests.tree.scripted import Scripted, Watched, scripted


def test_they_are_what_py_trees_draws_them_as() -> None:
    assert isinstance(SequenceWithMemory("s"), Sequence)
    assert isinstance(CommittingSelector("s"), Selector)
    assert isinstance(ParallelCount("p"), Parallel)
    text = tree_text(CommittingSelector("choose", scripted(a="S")))
    assert "choose" in text


def test_a_place_is_kept_when_a_child_is_replaced() -> None:
    root = SequenceWithMemory("root", scripted(first="S", second="F", third="S"))
    tree = Watched(root)
    tree.tick()
    other = Scripted("other", "S")
    other.store = tree.store
    root.replace_child(root.children[1], other)
    assert tree.tick() == "S"
    assert tree.ticked == "other third"


def test_only_the_branch_that_says_so_is_committed() -> None:
    high, low = Scripted("high", "FR"), Scripted("low", "R")
    inner = Sequence("inner", memory=False, children=[CommitFor("c", low, seconds=1.0)])
    tree = Watched(CommittingSelector("root", [high, inner]))
    with pytest.raises(TreeError, match="root/inner/c"):
        tree.tick()


def test_two_commitments_do_not_disturb_each_other() -> None:
    shoot, hand_over = Scripted("shoot", "FRRF"), Scripted("pass", "RRF")
    tree = Watched(
        CommittingSelector(
            "root",
            [CommitFor("shooting", shoot, seconds=0.2), CommitFor("passing", hand_over, seconds=0.3)],
        )
    )
    turns = []
    for tick in range(6):
        tree.tick(0.1 * tick)
        turns.append(tree.ticked)
    # The pass until 0.3 s, or its end; then the shot until 0.2 s later.
    assert turns == ["shoot pass", "pass", "pass shoot", "shoot", "shoot pass", "shoot pass"]


def test_a_commitment_counts_from_each_start() -> None:
    tree = Watched(
        CommittingSelector(
            "root", [Scripted("high", "FSFR"), CommitFor("c", Scripted("low", "R"), seconds=0.2)]
        )
    )
    turns = []
    for time in (1.0, 1.2, 1.3, 1.4, 1.5):
        tree.tick(time)
        turns.append(tree.ticked)
    assert turns == ["high low", "high", "high low", "low", "high"]


def test_a_commitment_ends_with_its_run_although_the_branch_goes_on() -> None:
    branch = FailureIsRunning("keep", CommitFor("c", Scripted("low", "RF"), seconds=1.0))
    tree = Watched(CommittingSelector("root", [Scripted("high", "FR"), branch]))
    turns = []
    for time in (1.0, 1.1, 1.2):
        tree.tick(time)
        turns.append(tree.ticked)
    assert turns == ["high low", "low", "high"]


class Told(Switch):
    present = "a"

    def case(self) -> str:
        return self.present


def test_a_case_names_its_child_even_after_it_was_replaced() -> None:
    first, second, other = scripted(first="R", second="R", other="S")
    switch = Told("root", {"a": first, "b": second}, otherwise=first)
    assert switch.cases == {"a": first, "b": second}
    assert switch.otherwise is first
    tree = Watched(switch)
    tree.tick()
    other.store = tree.store  # type: ignore[attr-defined]
    switch.replace_child(first, other)
    assert switch.cases["a"] is switch.otherwise is other
    assert tree.tick() == "S"


def test_a_switch_says_its_case() -> None:
    switch = Told("root", {"a": Scripted("first", "R")})
    tree = Watched(switch)
    tree.tick()
    assert switch.feedback_message == "a"


def test_a_switch_without_a_case_says_so() -> None:
    with pytest.raises(TreeError, match="Switch does not define case"):
        Watched(Switch("root", {"a": Scripted("first", "R")})).tick()


def test_a_counting_parallel_says_how_many_failed() -> None:
    root = ParallelCount("root", success_count=1, failure_count=2, children=scripted(a="F", b="F", c="R"))
    tree = Watched(root)
    assert tree.tick() == "F"
    assert root.feedback_message == "2 of 3 failed"
    assert root.current_child is root.children[1]
