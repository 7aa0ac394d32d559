"""The linter finds what is seldom meant, and is silent about what is."""

from __future__ import annotations

from typing import ClassVar

import pytest
from py_trees.behaviours import (
    CheckBlackboardVariableExists,
    Failure,
    ProbabilisticBehaviour,
    Running,
    StatusQueue,
    Success,
)
from py_trees.common import ParallelPolicy
from py_trees.decorators import FailureIsRunning, StatusToBlackboard
from py_trees.decorators import Timeout as StockTimeout
from py_trees.timers import Timer as StockTimer

from robobt.plays import PLAYS
from robobt.skills import GoToBall, HasBall, IsHalted, KickToTarget, SelectShot, Stop
from robobt.tree import (
    Behaviour,
    FailureIsSuccess,
    Inverter,
    Leaf,
    Parallel,
    Repeat,
    Retry,
    Selector,
    Sequence,
    Status,
    SuccessIsFailure,
)
from robobt.tree.devtools import Finding, lint_tree, outcomes
from robobt.tree.nodes import CommitFor, CommittingSelector, SequenceWithMemory, TickDivider, Timeout, Wait
from tests.tree.scripted import Scripted

S, F, R = Status.SUCCESS, Status.FAILURE, Status.RUNNING


def sequence(*children: Behaviour, memory: bool = False) -> Behaviour:
    return Sequence("all", memory=memory, children=list(children))


def selector(*children: Behaviour, memory: bool = False) -> Behaviour:
    return Selector("any", memory=memory, children=list(children))


def found(root: Behaviour) -> list[tuple[str, str]]:
    """Rule and path of each finding."""
    return [(finding.rule, finding.path) for finding in lint_tree(root)]


def letters(node: Behaviour) -> str:
    return "".join(sorted(status.value[0] for status in outcomes(node)))


def test_a_condition_before_an_action_is_forgotten_under_memory() -> None:
    (finding,) = lint_tree(sequence(HasBall(), KickToTarget(), memory=True))
    assert finding == Finding(
        "all/HasBall",
        "forgotten-condition",
        "is not asked again while 'KickToTarget' runs: 'all' has memory",
    )
    assert found(SequenceWithMemory("all", [HasBall(), KickToTarget()])) == [
        ("forgotten-condition", "all/HasBall")
    ]


def test_a_condition_may_be_a_tree_of_conditions() -> None:
    either = Selector("either", memory=False, children=[HasBall(), Inverter("not", IsHalted())])
    assert found(sequence(either, KickToTarget(), memory=True)) == [("forgotten-condition", "all/either")]


def test_a_condition_is_not_forgotten_without_memory_behind_the_action_or_without_action() -> None:
    assert found(sequence(HasBall(), KickToTarget())) == []
    assert found(sequence(KickToTarget(), HasBall(), memory=True)) == []
    assert found(sequence(HasBall(), SelectShot(), memory=True)) == []


def test_what_selects_is_no_condition_for_its_choice_is_meant_to_stay() -> None:
    assert found(sequence(SelectShot(), KickToTarget(), memory=True)) == []


def test_of_two_actions_in_a_reactive_sequence_the_first_interrupts_the_others() -> None:
    assert found(sequence(GoToBall(), HasBall(), KickToTarget())) == [("two-actions", "all/KickToTarget")]
    assert found(sequence(GoToBall(), KickToTarget(), memory=True)) == []
    assert found(selector(KickToTarget(), GoToBall())) == []


def test_a_branch_that_may_run_is_an_action_too() -> None:
    assert found(sequence(selector(HasBall(), GoToBall()), KickToTarget())) == [
        ("two-actions", "all/KickToTarget")
    ]


@pytest.mark.parametrize(
    "always", [Success("s"), FailureIsSuccess("ok", HasBall()), Running("r"), Stop(), SequenceWithMemory("e")]
)
def test_nothing_is_reached_behind_what_never_fails_in_a_selector(always: Behaviour) -> None:
    assert found(selector(IsHalted(), always, HasBall(), SelectShot())) == [("unreachable", "any/HasBall")]


@pytest.mark.parametrize("never", [Failure("f"), SuccessIsFailure("no", HasBall()), Running("r")])
def test_nothing_is_reached_behind_what_never_succeeds_in_a_sequence(never: Behaviour) -> None:
    assert found(sequence(IsHalted(), never, SelectShot())) == [("unreachable", "all/SelectShot")]


def test_the_last_child_may_always_succeed_or_always_fail() -> None:
    assert found(selector(HasBall(), Success("s"))) == []
    assert found(sequence(HasBall(), Failure("f"))) == []


def test_a_committing_selector_is_a_selector() -> None:
    branch = CommitFor("a while", KickToTarget(), seconds=1.0)
    assert found(CommittingSelector("any", [branch, Stop(), GoToBall()])) == [("unreachable", "any/GoToBall")]


@pytest.mark.parametrize("times", [-1, 10**9])
def test_repeating_and_retrying_without_a_bound_is_found(times: int) -> None:
    assert found(Repeat("again", HasBall(), times)) == [("unbounded", "again")]
    assert found(Retry("again", HasBall(), times)) == [("unbounded", "again")]
    assert found(Repeat("again", HasBall(), 3)) == found(Retry("again", HasBall(), 3)) == []


def test_what_makes_running_of_failure_tries_for_ever_unless_its_child_cannot_fail() -> None:
    assert found(FailureIsRunning("again", HasBall())) == [("unbounded", "again")]
    assert found(FailureIsRunning("never", Success("s"))) == []


def test_what_a_seeded_match_cannot_repeat_and_two_robots_cannot_share_is_found() -> None:
    weights = [1.0, 1.0, 1.0]
    assert found(StockTimer("t")) == [("wall-clock", "t")]
    assert found(StockTimeout("in time", HasBall())) == [("wall-clock", "in time")]
    assert found(ProbabilisticBehaviour("maybe", weights)) == [("global-random", "maybe")]
    assert found(CheckBlackboardVariableExists("key", "key")) == [("shared-blackboard", "key")]
    assert found(StatusToBlackboard("s", HasBall(), "key")) == [("shared-blackboard", "s")]
    assert found(Timeout("in time", HasBall(), seconds=1.0)) == []


def test_a_robot_stands_still_while_its_skill_is_not_ticked() -> None:
    moved = sequence(HasBall(), KickToTarget())
    assert found(TickDivider("now and then", moved, every=3)) == [
        ("divided-motion", "now and then/all/KickToTarget")
    ]
    assert found(TickDivider("now and then", Stop(), seconds=0.1)) == [
        ("divided-motion", "now and then/Stop")
    ]
    assert found(TickDivider("now and then", SelectShot(), every=3)) == []
    assert found(TickDivider("always", Stop(), every=1)) == []


def test_other_stores_have_other_entries_for_one_tick() -> None:
    tree = TickDivider("now and then", SelectShot(), every=3)
    assert [finding.rule for finding in lint_tree(tree, per_tick=("shot",))] == ["divided-motion"]


def test_a_finding_reads_as_a_line() -> None:
    (finding,) = lint_tree(Repeat("again", HasBall(), -1))
    assert str(finding) == "again: repeats its child for ever [unbounded]"


ON_PURPOSE = {
    # Two skills share a motion: the first keeps what the second relies on, and gives way once it is so.
    ("two-actions", "PickUpBall"),
    ("two-actions", "off the ball"),
    ("two-actions", "Wall"),
    ("two-actions", "CoverAngle"),
    ("two-actions", "DrawGoalkeeper"),
    # PrepareRestart succeeds for good once the restart may be taken.
    ("two-actions", "KickToTarget"),
    # The ball may be touched until the restart is over, and then it is not a restart.
    ("forgotten-condition", "MayTouchBall"),
}


@pytest.mark.parametrize("play", list(PLAYS))
def test_of_the_shipped_plays_only_what_is_on_purpose_is_found(play: str) -> None:
    assert {(rule, path.rpartition("/")[2]) for rule, path in found(PLAYS[play]())} <= ON_PURPOSE


def test_a_leaf_comes_to_the_statuses_its_methods_name() -> None:
    assert letters(HasBall()) == "FS"
    assert letters(Stop()) == "RS"
    assert letters(Wait(seconds=1.0)) == "RS"
    assert letters(StatusQueue("q", [S], eventually=None)) == "FRS"


def test_a_leaf_that_names_no_status_can_come_to_all() -> None:
    assert letters(Scripted("x", "S")) == "FRS"


def test_a_leaf_may_say_what_it_comes_to() -> None:
    class Guard(Scripted):
        outcomes: ClassVar[frozenset[Status]] = frozenset((S, F))

    assert letters(Guard("x", "S")) == "FS"
    assert found(sequence(Guard("x", "S"), GoToBall(), memory=True)) == [("forgotten-condition", "all/x")]


def test_a_function_of_the_leafs_module_is_looked_into() -> None:
    assert letters(Indirect()) == "FR"


def test_control_nodes_come_to_what_their_children_leave() -> None:
    assert letters(sequence(Failure("f"), Running("r"))) == "F"
    assert letters(selector(HasBall(), Running("r"))) == "RS"
    assert letters(Inverter("i", Success("s"))) == "F"
    assert letters(Repeat("r", Success("s"), -1)) == "R"
    assert letters(Repeat("r", HasBall(), 2)) == "FRS"
    assert letters(Retry("r", HasBall(), 1)) == "FS"
    assert letters(Parallel("p", ParallelPolicy.SuccessOnAll(), [Success("s"), Running("r")])) == "R"


class Indirect(Leaf[None]):
    def on_running(self) -> Status:
        return elsewhere()


def elsewhere() -> Status:
    return Status.RUNNING if id(object()) else Status.FAILURE
