"""The linter finds what is seldom meant, and is silent about the rest."""

from __future__ import annotations

import pytest
from py_trees.behaviours import CheckBlackboardVariableExists, ProbabilisticBehaviour
from py_trees.decorators import StatusToBlackboard
from py_trees.decorators import Timeout as StockTimeout
from py_trees.timers import Timer as StockTimer

from robobt.plays import PLAYS
from robobt.skills import HasBall
from robobt.tree import Behaviour, Repeat, Retry, Sequence
from robobt.tree.devtools import lint_tree
from robobt.tree.nodes import Timeout


def found(root: Behaviour) -> list[tuple[str, str]]:
    """Rule and path of each finding."""
    return [(finding.rule, finding.path) for finding in lint_tree(root)]


@pytest.mark.parametrize("times", [-1, 10**9])
def test_repeating_and_retrying_without_a_bound_is_found(times: int) -> None:
    assert found(Repeat("again", HasBall(), times)) == [("unbounded", "again")]
    assert found(Retry("again", HasBall(), times)) == [("unbounded", "again")]
    assert found(Repeat("again", HasBall(), 3)) == found(Retry("again", HasBall(), 3)) == []


def test_what_a_seeded_match_cannot_repeat_and_two_robots_cannot_share_is_found() -> None:
    weights = [1.0, 1.0, 1.0]
    assert found(StockTimer("t")) == [("wall-clock", "t")]
    assert found(StockTimeout("in time", HasBall())) == [("wall-clock", "in time")]
    assert found(ProbabilisticBehaviour("maybe", weights)) == [("global-random", "maybe")]
    assert found(CheckBlackboardVariableExists("key", "key")) == [("shared-blackboard", "key")]
    assert found(StatusToBlackboard("s", HasBall(), "key")) == [("shared-blackboard", "s")]
    assert found(Timeout("in time", HasBall(), seconds=1.0)) == []


def test_findings_come_in_the_order_of_the_tree_and_read_as_lines() -> None:
    children = [Repeat("again", HasBall(), -1), StockTimer("t")]
    root = Sequence("all", memory=True, children=children)
    assert [str(finding) for finding in lint_tree(root)] == [
        "all/again: repeats its child for ever [unbounded]",
        "all/t: goes by the wall clock, not the match's; take robobt.tree.nodes.Wait [wall-clock]",
    ]


@pytest.mark.parametrize("play", list(PLAYS))
def test_nothing_is_found_in_the_shipped_plays(play: str) -> None:
    assert found(PLAYS[play]()) == []
