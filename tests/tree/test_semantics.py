"""The table of docs/control_nodes.md, row by row: ``test_7_...`` is the test of row 7."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, Literal

import py_trees
import pytest
from py_trees.behaviours import Running
from py_trees.common import OneShotPolicy, ParallelPolicy
from py_trees.decorators import (
    Condition,
    Count,
    EternalGuard,
    FailureIsRunning,
    ForEach,
    PassThrough,
    RunningIsFailure,
    RunningIsSuccess,
    StatusToBlackboard,
    SuccessIsRunning,
)
from py_trees.decorators import Timeout as StockTimeout
from py_trees.visitors import VisitorBase

from robobt.skills.restarts.referee_switch import RefereeSwitch
from robobt.testing import frame, robot
from robobt.tree import (
    Behaviour,
    FailureIsSuccess,
    FastTree,
    Inverter,
    OneShot,
    Parallel,
    Repeat,
    Retry,
    Selector,
    Sequence,
    SuccessIsFailure,
    TreeError,
    TreeRunner,
    preorder,
)
from robobt.tree.nodes import (
    CommitFor,
    CommittingSelector,
    Cooldown,
    Delay,
    HoldSuccess,
    ParallelCount,
    SequenceWithMemory,
    Switch,
    TickDivider,
    Timeout,
    Wait,
)
from robobt.world import Team
from tests.skills.fixed_world import Alone
from tests.skills.refereed import STOP, free_kick
from tests.tree.random_trees import Log, Told
from tests.tree.scripted import INVALID, F, Notes, R, S, Scripted, Watched, scripted

TABLE = Path(__file__).parents[2] / "docs" / "control_nodes.md"
ONE_SIXTIETH = 1.0 / 60.0


def rows() -> list[int]:
    return [int(row) for row in re.findall(r"^\| (\d+) \|", TABLE.read_text(encoding="utf-8"), re.MULTILINE)]


def test_every_row_of_the_table_has_its_test() -> None:
    assert rows() == list(range(1, len(rows()) + 1))
    tested = sorted(int(name.split("_")[1]) for name in globals() if re.match(r"test_\d+_", name))
    assert tested == rows()


class Cases(Switch):
    """A switch that does what it is told."""

    present = "a"

    def case(self) -> str:
        return self.present


# Leaves


def test_1_a_leaf_starts_runs_and_ends() -> None:
    tree = Watched(Scripted("a", "RS"))
    tree.tick()
    assert tree.diary == ["a starts", "a ticked"]
    tree.tick()
    assert tree.diary == ["a ticked", "a ends S"]


def test_2_only_a_running_leaf_is_interrupted() -> None:
    work = Sequence("work", memory=False, children=scripted(done="S", running="R", never="R"))
    tree = Watched(Selector("root", memory=False, children=[Scripted("guard", "FS"), work]))
    tree.ticks(2)
    assert [entry for entry in tree.diary if "interrupted" in entry] == ["running interrupted"]


def test_3_the_interrupting_branch_is_ticked_first() -> None:
    tree = Watched(Selector("root", memory=False, children=scripted(new="FR", old="R")))
    tree.ticks(2)
    assert tree.diary == ["new starts", "new ticked", "old interrupted"]


def test_4_terminate_with_invalid_also_comes_after_an_end() -> None:
    log: Log = []
    root = Sequence("root", memory=False, children=[Told("a", [S], log), Told("b", [S], log)])
    tree = Watched(root)
    tree.tick()
    log.clear()
    tree.tick()
    assert log[:2] == [("a", "terminate", S, INVALID), ("b", "terminate", S, INVALID)]


def test_5_what_is_no_status_becomes_invalid(monkeypatch: pytest.MonkeyPatch) -> None:
    said: list[str] = []
    monkeypatch.setattr("py_trees.logging.Logger.error", lambda _, text: said.append(text))
    tree = Watched(Told("a", ["yes"], []))
    assert tree.tick() == "I"
    assert "invalid status" in said[0]


def test_6_a_wait_takes_its_time() -> None:
    tree = Watched(Wait(seconds=0.5))
    assert tree.at([1.0, 1.4, 1.5]) == "RRS"
    assert tree.at([2.0, 2.4, 2.5]) == "RRS"


# Sequences


@pytest.mark.parametrize("memory", [False, True])
def test_7_a_sequence_goes_on_as_long_as_its_children_succeed(memory: bool) -> None:
    def sequence(**scripts: str) -> Watched:
        return Watched(Sequence("root", memory=memory, children=scripted(**scripts)))

    assert sequence(a="S", b="S").tick() == "S"
    for letter in "FR":
        tree = sequence(a="S", b=letter, c="S")
        assert tree.tick() == letter
        assert tree.ticked == "a b"


@pytest.mark.parametrize("memory", [False, True])
def test_8_a_sequence_without_children_succeeds(memory: bool) -> None:
    assert Watched(Sequence("root", memory=memory)).tick() == "S"


@pytest.mark.parametrize("memory", [False, True])
def test_9_a_sequence_that_starts_anew_resets_its_children(memory: bool) -> None:
    tree = Watched(Sequence("root", memory=memory, children=scripted(a="SSF", b="S", c="F")))
    tree.tick()
    assert tree.statuses == "FSSF"
    tree.ticks(2)
    assert tree.statuses == "FF--"


def test_10_a_sequence_without_memory_asks_its_first_child_at_every_tick() -> None:
    tree = Watched(Sequence("root", memory=False, children=scripted(guard="SSF", work="R")))
    assert tree.ticks(2) == "RR"
    assert tree.ticked == "guard work"
    assert tree.tick() == "F"


@pytest.mark.parametrize("guard", ["SF", "SR"])
def test_11_a_sequence_without_memory_interrupts_what_it_does_not_reach(guard: str) -> None:
    tree = Watched(Sequence("root", memory=False, children=scripted(guard=guard, work="R")))
    tree.ticks(2)
    assert tree.diary[-1] == "work interrupted"


def test_12_a_sequence_with_memory_goes_on_where_it_was() -> None:
    tree = Watched(Sequence("root", memory=True, children=scripted(first="SF", work="RS")))
    assert tree.ticks(2) == "RS"
    assert tree.ticked == "work"


def test_13_a_sequence_with_memory_begins_anew_after_a_failure() -> None:
    tree = Watched(Sequence("root", memory=True, children=scripted(first="S", work="FS")))
    assert tree.ticks(2) == "FS"
    assert tree.ticked == "first work"


def test_14_a_sequence_with_memory_loses_its_place_when_interrupted() -> None:
    work = Sequence("work", memory=True, children=scripted(first="S", second="R"))
    tree = Watched(Selector("root", memory=False, children=[Scripted("guard", "FSF"), work]))
    assert tree.ticks(3) == "RSR"
    assert tree.ticked == "guard first second"


def test_15_a_sequence_that_keeps_its_place_tries_again_what_failed() -> None:
    tree = Watched(SequenceWithMemory("root", scripted(first="S", second="FS", third="S")))
    assert tree.tick() == "F"
    assert tree.tick() == "S"
    assert tree.diary[0] == "second starts"
    assert tree.ticked == "second third"


def test_16_a_sequence_that_keeps_its_place_goes_on_after_an_interruption() -> None:
    work = SequenceWithMemory("work", scripted(first="S", second="R"))
    tree = Watched(Selector("root", memory=False, children=[Scripted("guard", "FSF"), work]))
    assert tree.ticks(2) == "RS"
    assert tree.diary[-1] == "second interrupted"
    tree.tick()
    assert tree.diary[2:] == ["guard ends F", "second starts", "second ticked"]


def test_17_a_sequence_that_keeps_its_place_begins_anew_when_done_or_told_to() -> None:
    root = SequenceWithMemory("root", scripted(first="S", second="SR"))
    tree = Watched(root)
    assert tree.ticks(2) == "SR"
    assert tree.ticked == "first second"
    tree.store.diary.clear()
    root.restart()
    assert tree.store.diary == ["second interrupted"]
    tree.tick()
    assert tree.ticked == "first second"


# Selectors


@pytest.mark.parametrize("memory", [False, True])
def test_18_a_selector_goes_on_until_a_child_does_not_fail(memory: bool) -> None:
    def selector(**scripts: str) -> Watched:
        return Watched(Selector("root", memory=memory, children=scripted(**scripts)))

    assert selector(a="F", b="F").tick() == "F"
    for letter in "SR":
        tree = selector(a="F", b=letter, c="S")
        assert tree.tick() == letter
        assert tree.ticked == "a b"


@pytest.mark.parametrize("memory", [False, True])
def test_19_a_selector_without_children_fails(memory: bool) -> None:
    assert Watched(Selector("root", memory=memory)).tick() == "F"


@pytest.mark.parametrize("letter", ["S", "R"])
def test_20_in_a_selector_without_memory_higher_priorities_interrupt(letter: str) -> None:
    tree = Watched(Selector("root", memory=False, children=scripted(high="FF" + letter, low="R")))
    assert tree.ticks(3) == "RR" + letter
    assert tree.diary[-1] == "low interrupted"
    assert tree.statuses == letter + letter + "-"


def test_21_a_selector_with_memory_does_not_ask_higher_priorities() -> None:
    tree = Watched(Selector("root", memory=True, children=scripted(high="FS", low="R")))
    assert tree.ticks(50) == "R" * 50
    assert tree.ticked == "low"


def test_22_a_selector_with_memory_tries_only_lower_priorities_when_its_child_fails() -> None:
    tree = Watched(Selector("root", memory=True, children=scripted(high="FS", low="RF", last="F")))
    assert tree.ticks(2) == "RF"
    assert tree.ticked == "low last"
    assert tree.tick() == "S"
    assert tree.ticked == "high"


def committing(high: str = "FR", low: str = "R", last: str = "R") -> Watched:
    """A selector whose second of three branches commits for 0.3 s."""
    first, second, third = scripted(high=high, low=low, last=last)
    return Watched(CommittingSelector("root", [first, CommitFor("commit", second, seconds=0.3), third]))


def test_23_without_a_commitment_a_committing_selector_is_reactive() -> None:
    tree = Watched(CommittingSelector("root", scripted(high="FFFS", low="FRR")))
    assert tree.ticks(4) == "FRRS"
    assert tree.diary[-1] == "low interrupted"
    assert Watched(CommittingSelector("root")).tick() == "F"


def test_24_a_committed_branch_is_not_interrupted_by_higher_priorities() -> None:
    tree = committing()
    assert tree.at([0.0, 0.1, 0.2]) == "RRR"
    assert tree.ticked == "low"


def test_25_after_its_time_a_commitment_is_over() -> None:
    tree = committing(high="FFR")
    tree.at([0.0, 0.2])
    tree.tick(0.3)
    assert tree.ticked == "high low"
    tree.tick(0.4)
    assert tree.diary == ["high starts", "high ticked", "low interrupted"]


def test_26_when_the_committed_branch_fails_higher_priorities_come_before_lower_ones() -> None:
    tree = committing(high="FFR", low="RF")
    tree.at([0.0, 0.1])
    assert tree.ticked == "low high last"
    tree = committing(high="FR", low="RF")
    tree.at([0.0, 0.1])
    assert tree.ticked == "low high"


def test_27_a_committed_branch_may_finish_and_be_interrupted_from_above() -> None:
    tree = committing(high="FR", low="RS")
    assert tree.at([0.0, 0.1, 0.2]) == "RSR"
    assert tree.ticked == "high"
    inner = committing().root
    above = Watched(Selector("above", memory=False, children=[Scripted("guard", "FS"), inner]))
    above.at([0.0, 0.1])
    assert above.diary[-1] == "low interrupted"


def test_28_in_a_committing_selector_a_child_that_was_not_ticked_is_invalid() -> None:
    tree = committing(high="FF", low="RRF", last="F")
    tree.at([0.0])
    assert tree.statuses == "RFRR-"
    tree.at([0.1])
    assert tree.statuses == "R-RR-"


def test_29_a_commitment_without_its_selector_is_an_error() -> None:
    tree = Watched(Selector("root", memory=False, children=[CommitFor("c", Scripted("a", "R"), seconds=1.0)]))
    with pytest.raises(TreeError, match="root/c: RuntimeError: a CommitFor has to be a branch of a Commit"):
        tree.tick()
    branch = Inverter("not", CommitFor("c", Scripted("a", "R"), seconds=1.0))
    tree = Watched(CommittingSelector("root", [Scripted("high", "FR"), branch]))
    tree.at([0.0, 0.5])
    assert tree.ticked == "a"


def test_30_a_switch_ticks_the_child_of_its_case() -> None:
    first, second, rest = scripted(first="R", second="F", rest="S")
    switch = Cases("root", {"a": first, "b": second, "c": first}, otherwise=rest)
    tree = Watched(switch)
    for case, letter, ticked in [("a", "R", "first"), ("c", "R", "first"), ("b", "F", "second")]:
        switch.present = case
        assert tree.tick() == letter
        assert tree.ticked == ticked
    switch.present = "z"
    assert tree.tick() == "S"
    assert tree.statuses == "S--S"


def test_31_a_switch_interrupts_the_old_case_before_the_new_one() -> None:
    first, second = scripted(first="R", second="R")
    switch = Cases("root", {"a": first, "b": second})
    tree = Watched(switch)
    tree.tick()
    switch.present = "b"
    tree.tick()
    assert tree.diary == ["first interrupted", "second starts", "second ticked"]


def test_32_a_switch_fails_in_a_case_without_a_child() -> None:
    switch = Cases("root", {"a": Scripted("first", "R")})
    tree = Watched(switch)
    tree.tick()
    switch.present = "b"
    assert tree.tick() == "F"
    assert tree.diary == ["first interrupted"]
    assert switch.feedback_message == "nothing to do in b"


@pytest.mark.parametrize(
    ("game", "case"),
    [
        (STOP, "stop"),
        (free_kick(Team.YELLOW, (1.0, 1.0)), "their_free_kick"),
    ],
)
def test_33_the_referees_word_is_the_case(game: Any, case: str) -> None:
    switch = RefereeSwitch("root", {case: Told("child", [R], [])}, otherwise=Told("rest", [F], []))
    assert Alone(switch).tick(frame(robot(), game=game)) is R


# Parallels


def all_policies(children: list[Behaviour]) -> list[Any]:
    return [
        ParallelPolicy.SuccessOnAll(synchronise=True),
        ParallelPolicy.SuccessOnAll(synchronise=False),
        ParallelPolicy.SuccessOnOne(),
        ParallelPolicy.SuccessOnSelected(children[:1], synchronise=True),
        ParallelPolicy.SuccessOnSelected(children[:1], synchronise=False),
    ]


def parallel(policy: Any, **scripts: str) -> Watched:
    return Watched(Parallel("root", policy, scripted(**scripts)))


@pytest.mark.parametrize("which", range(5))
def test_34_a_parallel_ticks_all_and_fails_with_any(which: int) -> None:
    children = scripted(a="S", b="R", c="RF")
    tree = Watched(Parallel("root", all_policies(children)[which], children))
    first = tree.tick()
    assert tree.ticked == "a b c"
    if first == "R":
        assert tree.tick() == "F"
    children = scripted(a="S", b="F", c="R")
    tree = Watched(Parallel("root", all_policies(children)[which], children))
    assert tree.tick() == "F"
    assert tree.ticked == "a b c"


def test_35_a_parallel_without_children_succeeds() -> None:
    for policy in (ParallelPolicy.SuccessOnAll(), ParallelPolicy.SuccessOnOne()):
        assert parallel(policy).tick() == "S"


@pytest.mark.parametrize("end", ["S", "F"])
def test_36_a_parallel_that_ends_interrupts_its_children(end: str) -> None:
    tree = parallel(ParallelPolicy.SuccessOnOne(), a="R", b="R" + end)
    assert tree.ticks(2) == "R" + end
    assert tree.diary[-1] == "a interrupted"


def test_37_success_on_all_takes_all() -> None:
    assert parallel(ParallelPolicy.SuccessOnAll(), a="S", b="RS").ticks(2) == "RS"


def test_38_success_on_one_takes_one_and_no_failure() -> None:
    assert parallel(ParallelPolicy.SuccessOnOne(), a="R", b="RS").ticks(2) == "RS"
    assert parallel(ParallelPolicy.SuccessOnOne(), a="S", b="F").tick() == "F"


def test_39_success_on_selected_takes_those_selected() -> None:
    children = scripted(a="RS", b="S", c="R")
    tree = Watched(Parallel("root", ParallelPolicy.SuccessOnSelected(children[:2]), children))
    assert tree.ticks(2) == "RS"


@pytest.mark.parametrize("selected", [[], [Scripted("stranger", "S")]])
def test_40_a_wrong_selection_is_an_error(selected: list[Behaviour], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("py_trees.logging.Logger.error", lambda *_: None)
    tree = parallel(ParallelPolicy.SuccessOnSelected(selected), a="S")
    with pytest.raises(TreeError, match="SuccessOnSelected"):
        tree.tick()


def test_41_a_synchronised_parallel_does_not_tick_what_has_succeeded() -> None:
    tree = parallel(ParallelPolicy.SuccessOnAll(synchronise=True), a="SF", b="RRS")
    assert tree.ticks(2) == "RR"
    assert tree.ticked == "b"
    assert tree.tick() == "S"


def test_42_otherwise_it_ticks_it_again() -> None:
    tree = parallel(ParallelPolicy.SuccessOnAll(synchronise=False), a="SF", b="R")
    assert tree.ticks(2) == "RF"
    assert tree.diary[:2] == ["a starts", "a ticked"]


def counting(success_count: int, failure_count: int, **scripts: str) -> Watched:
    return Watched(
        ParallelCount(
            "root", success_count=success_count, failure_count=failure_count, children=scripted(**scripts)
        )
    )


def test_43_a_counting_parallel_ticks_what_has_not_finished() -> None:
    tree = counting(3, 3, a="S", b="F", c="R", d="R", e="R")
    tree.tick()
    assert tree.ticked == "a b c d e"
    tree.tick()
    assert tree.ticked == "c d e"


def test_44_enough_successes_count_before_failures() -> None:
    assert counting(2, 1, a="S", b="R", c="RS").ticks(2) == "RS"
    assert counting(1, 1, a="F", b="S").tick() == "S"


def test_45_enough_failures_or_too_few_left_is_a_failure() -> None:
    assert counting(1, 2, a="F", b="RF", c="R").ticks(2) == "RF"
    assert counting(3, 3, a="R", b="RF", c="S").ticks(2) == "RF"


@pytest.mark.parametrize(("count", "needed"), [(-1, 4), (-2, 3), (-4, 1), (2, 2)])
def test_46_a_negative_count_is_from_the_end(count: int, needed: int) -> None:
    for succeeded in range(5):
        letters = "S" * succeeded + "R" * (4 - succeeded)
        tree = counting(count, -1, **dict(zip("abcd", letters, strict=True)))
        assert tree.tick() == ("S" if succeeded >= needed else "R")
        tree = counting(-4, count, **dict(zip("abcd", letters.replace("S", "F"), strict=True)))
        assert tree.tick() == ("F" if succeeded >= needed else "R")


def test_47_a_counting_parallel_that_ends_interrupts_and_starts_all_anew() -> None:
    tree = counting(1, 1, a="R", b="RS")
    assert tree.ticks(2) == "RS"
    assert tree.diary[-1] == "a interrupted"
    tree.tick()
    assert tree.diary == ["a starts", "a ticked", "b starts", "b ticked", "b ends S", "a interrupted"]


def test_48_a_count_has_to_fit_the_children() -> None:
    assert Watched(ParallelCount("root", success_count=2)).tick() == "S"
    for count in (0, 3, -3):
        with pytest.raises(ValueError, match=f"a count of {count} does not fit 2 children"):
            counting(count, 1, a="S", b="S")
        with pytest.raises(ValueError, match=f"a count of {count} does not fit 2 children"):
            counting(1, count, a="S", b="S")
    root = ParallelCount("root", success_count=2)
    root.add_child(Scripted("a", "S"))
    with pytest.raises(TreeError, match="root: ValueError: a count of 2 does not fit 1 children"):
        Watched(root).tick()


# Decorators


STOCK_DECORATORS: list[Callable[[Behaviour], Behaviour]] = [
    lambda child: Inverter("d", child),
    lambda child: Repeat("d", child, 2),
    lambda child: Retry("d", child, 2),
    lambda child: PassThrough("d", child),
    lambda child: Count("d", child),
    lambda child: FailureIsSuccess("d", child),
    lambda child: FailureIsRunning("d", child),
    lambda child: SuccessIsFailure("d", child),
    lambda child: SuccessIsRunning("d", child),
    lambda child: RunningIsFailure("d", child),
    lambda child: RunningIsSuccess("d", child),
    lambda child: Condition("d", child, S),
    lambda child: EternalGuard("d", child, lambda: True),
    lambda child: OneShot("d", child, OneShotPolicy.ON_COMPLETION),
    lambda child: StockTimeout("d", child, 1000.0),
]


@pytest.mark.parametrize("decorate", STOCK_DECORATORS)
def test_49_a_stock_decorator_ticks_its_child_first_and_ends_with_it(decorate: Any) -> None:
    tree = Watched(decorate(Scripted("a", "R")))
    letters = tree.ticks(2)
    assert tree.ticked == "a"
    assert ("a interrupted" in tree.diary) is (letters != "RR")


@pytest.mark.parametrize("decorate", STOCK_DECORATORS)
def test_50_stopping_a_stock_decorator_reaches_a_child_that_never_ran(decorate: Any) -> None:
    log: Log = []
    decorate(Told("a", [R], log)).stop(INVALID)
    assert log == [("a", "terminate", INVALID, INVALID)]


def translated(decorate: Callable[[Behaviour], Behaviour]) -> str:
    """What a decorator makes of SUCCESS, FAILURE and RUNNING."""
    return "".join(Watched(decorate(Scripted("a", letter))).tick() for letter in "SFR")


def test_51_an_inverter_inverts() -> None:
    assert translated(lambda child: Inverter("d", child)) == "FSR"


def test_52_repeat_starts_its_child_until_it_has_succeeded_often_enough() -> None:
    tree = Watched(Repeat("d", Scripted("a", "SRSS"), 3))
    assert tree.tick() == "R"
    assert tree.tick() == "R"
    assert tree.diary == ["a starts", "a ticked"]
    assert tree.ticks(2) == "RS"
    assert Watched(Repeat("d", Scripted("a", "SF"), 3)).ticks(2) == "RF"
    assert Watched(Repeat("d", Scripted("a", "S"), -1)).ticks(100) == "R" * 100


def test_53_retry_starts_its_child_until_it_has_failed_often_enough() -> None:
    tree = Watched(Retry("d", Scripted("a", "FRFF"), 3))
    assert tree.tick() == "R"
    assert tree.tick() == "R"
    assert tree.diary == ["a starts", "a ticked"]
    assert tree.ticks(2) == "RF"
    assert Watched(Retry("d", Scripted("a", "FS"), 3)).ticks(2) == "RS"


@pytest.mark.parametrize("end", ["S", "F"])
def test_54_one_shot_repeats_how_its_child_ended(end: str) -> None:
    tree = Watched(OneShot("d", Scripted("a", "R" + end + "R"), OneShotPolicy.ON_COMPLETION))
    assert tree.ticks(4) == "R" + end * 3
    assert tree.ticked == ""


def test_55_a_failure_may_not_count_as_the_one_shot() -> None:
    tree = Watched(OneShot("d", Scripted("a", "FSR"), OneShotPolicy.ON_SUCCESSFUL_COMPLETION))
    assert tree.ticks(4) == "FSSS"


def test_56_an_eternal_guard_asks_before_every_tick() -> None:
    answers = iter([True, False, S, F])
    tree = Watched(EternalGuard("d", Scripted("a", "R"), lambda: next(answers)))
    assert tree.ticks(2) == "RF"
    assert tree.diary == ["a interrupted"]
    assert tree.ticks(2) == "RF"


def test_57_a_condition_waits_for_a_status() -> None:
    assert Watched(Condition("d", Scripted("a", "RSF"), F)).ticks(3) == "RRS"


def test_58_count_counts() -> None:
    count = Count("d", Scripted("a", "RSFS"))
    tree = Watched(Sequence("root", memory=False, children=[count, Scripted("b", "S")]))
    assert tree.ticks(4) == "RSFS"
    assert (count.total_tick_count, count.running_count) == (4, 1)
    assert (count.success_count, count.failure_count) == (2, 1)
    # Nothing was ever interrupted.
    assert count.interrupt_count == 2


def test_59_a_pass_through_changes_nothing() -> None:
    assert translated(lambda child: PassThrough("d", child)) == "SFR"


@pytest.fixture
def blackboard() -> Any:
    """The process-wide one, clean before and after."""
    py_trees.blackboard.Blackboard.clear()
    client = py_trees.blackboard.Client(name="test")
    for key in ("items", "item", "status"):
        client.register_key(key, py_trees.common.Access.WRITE)
    yield client
    client.unregister()
    py_trees.blackboard.Blackboard.clear()


def test_60_for_each_starts_its_child_for_every_item(blackboard: Any) -> None:
    blackboard.items = [1, 2, 3]
    tree = Watched(ForEach("d", Scripted("a", "SRSS"), "items", "item"))
    seen = []
    for _ in range(4):
        seen.append(blackboard.item if blackboard.exists("item") else None)
        tree.tick()
    assert seen[1:] == [2, 2, 3]
    assert tree.statuses == "SS"
    assert Watched(ForEach("d", Scripted("a", "SF"), "items", "item")).ticks(2) == "RF"


def test_61_for_each_ticks_its_child_for_an_empty_list_and_ends_at_none(blackboard: Any) -> None:
    blackboard.items = []
    tree = Watched(ForEach("d", Scripted("a", "F"), "items", "item"))
    assert tree.tick() == "S"
    assert tree.ticked == "a"
    blackboard.items = [1, None, 3]
    assert Watched(ForEach("d", Scripted("a", "S"), "items", "item")).tick() == "S"


def test_62_a_status_on_the_blackboard_is_there_for_the_whole_process(blackboard: Any) -> None:
    assert translated(lambda child: StatusToBlackboard("d", child, "status")) == "SFR"
    assert blackboard.status is R


@pytest.mark.parametrize(("kind", "letters"), [(RunningIsFailure, "SFF")])
def test_63_running_as_failure_interrupts(kind: Any, letters: str) -> None:
    assert translated(lambda child: kind("d", child)) == letters
    tree = Watched(kind("d", Scripted("a", "R")))
    tree.ticks(2)
    assert tree.diary == ["a starts", "a ticked", "a interrupted"]


@pytest.mark.parametrize(("kind", "letters"), [(RunningIsSuccess, "SFS")])
def test_64_running_as_success_interrupts(kind: Any, letters: str) -> None:
    test_63_running_as_failure_interrupts(kind, letters)


def test_65_failure_is_success() -> None:
    assert translated(lambda child: FailureIsSuccess("d", child)) == "SSR"


def test_66_failure_is_running() -> None:
    assert translated(lambda child: FailureIsRunning("d", child)) == "SRR"


def test_67_success_is_failure() -> None:
    assert translated(lambda child: SuccessIsFailure("d", child)) == "FFR"


def test_68_success_is_running() -> None:
    assert translated(lambda child: SuccessIsRunning("d", child)) == "RFR"


def test_69_the_stock_timeout_looks_at_the_wall_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = iter([100.0, 100.0, 100.9, 101.1])
    monkeypatch.setattr("py_trees.decorators.time.monotonic", lambda: next(clock))
    tree = Watched(StockTimeout("d", Scripted("a", "R"), 1.0))
    assert tree.ticks(3) == "RRF"
    assert tree.diary == ["a ticked", "a interrupted"]


def test_70_a_timeout_interrupts_what_takes_too_long() -> None:
    tree = Watched(Timeout("d", Scripted("a", "R"), seconds=0.5))
    assert tree.at([1.0, 1.4, 1.5]) == "RRF"
    assert tree.diary == ["a interrupted"]
    assert tree.root.feedback_message == "not done within 0.5 s"
    assert Watched(Timeout("d", Scripted("a", "RS"), seconds=0.5)).at([0.0, 0.4]) == "RS"


def test_71_the_time_of_a_timeout_runs_anew_in_each_run() -> None:
    tree = Watched(Timeout("d", Scripted("a", "R"), seconds=0.5))
    assert tree.at([0.0, 0.5, 0.6, 1.0, 1.1]) == "RFRRF"
    tree.tick(2.0)
    tree.stop()
    assert tree.at([2.4, 2.8, 2.9]) == "RRF"


def test_72_a_delay_lets_its_child_wait() -> None:
    tree = Watched(Delay("d", Scripted("a", "RF"), seconds=0.2))
    assert tree.at([1.0, 1.1]) == "RR"
    assert tree.diary == []
    assert tree.at([1.2, 1.3, 1.4]) == "RFR"
    assert tree.diary == []


@pytest.mark.parametrize("end", ["S", "F"])
def test_73_a_cooldown_pauses_after_each_end(end: str) -> None:
    tree = Watched(Cooldown("d", Scripted("a", "R" + end + "R"), seconds=0.5))
    assert tree.at([0.0, 1.0]) == "R" + end
    assert tree.at([1.1, 1.4]) == "FF"
    assert tree.diary == []
    assert tree.root.feedback_message == "pauses until 1.50 s"
    assert tree.tick(1.5) == "R"


@pytest.mark.parametrize(("after", "end"), [("success", "S"), ("failure", "F")])
def test_74_a_cooldown_may_follow_one_end_only(after: Any, end: str) -> None:
    other = "F" if end == "S" else "S"
    tree = Watched(Cooldown("d", Scripted("a", other + end + "R"), seconds=0.5, after=after))
    assert tree.at([0.0, 0.1]) == other + end
    assert tree.ticked == "a"
    assert tree.at([0.2]) == "F"
    assert tree.ticked == ""


def test_75_an_interruption_neither_begins_nor_ends_a_pause() -> None:
    tree = Watched(Cooldown("d", Scripted("a", "RSR"), seconds=0.5))
    tree.tick(0.0)
    tree.stop()
    assert tree.tick(0.1) == "S"
    tree.stop()
    assert tree.at([0.2, 0.6]) == "FR"


def test_76_a_success_is_held() -> None:
    tree = Watched(HoldSuccess("d", Scripted("a", "FRSF"), seconds=0.3))
    assert tree.at([0.0, 0.1, 0.2]) == "FRS"
    assert tree.at([0.3, 0.4]) == "SS"
    assert tree.diary == []
    assert tree.at([0.5]) == "F"


def test_77_a_divider_ticks_its_child_only_so_often() -> None:
    tree = Watched(TickDivider("d", Scripted("a", "FSR"), every=3))
    ticked = []
    letters = ""
    for _ in range(9):
        letters += tree.tick()
        ticked.append(tree.ticked)
    assert letters == "FFFSSSRRR"
    assert ticked == ["a", "", ""] * 3


def test_78_a_divider_may_go_by_time() -> None:
    tree = Watched(TickDivider("d", Scripted("a", "FSRF"), seconds=0.1))
    assert tree.at([1.0, 1.05, 1.1, 1.15, 1.5, 1.55]) == "FFSSRR"


@pytest.mark.parametrize("how", [{"every": 10}, {"seconds": 10.0}])
def test_79_an_interrupted_divider_ticks_its_child_next(how: Any) -> None:
    tree = Watched(TickDivider("d", Scripted("a", "RS"), **how))
    assert tree.ticks(2) == "RR"
    tree.stop()
    assert tree.diary == ["a interrupted"]
    assert tree.ticks(2) == "SS"


GATES: list[Callable[[Behaviour], Behaviour]] = [
    lambda child: Timeout("d", child, seconds=0.5),
    lambda child: Delay("d", child, seconds=0.5),
    lambda child: Cooldown("d", child, seconds=0.5),
    lambda child: HoldSuccess("d", child, seconds=0.5),
    lambda child: TickDivider("d", child, seconds=0.5),
]


@pytest.mark.parametrize("decorate", GATES)
def test_80_a_child_that_is_not_ticked_shows_no_old_status(decorate: Any) -> None:
    unticked = 0
    for script in ("SF", "FS", "RF", "R"):
        tree = Watched(decorate(Scripted("a", script)))
        for time in (0.0, 0.1, 0.2, 0.5, 0.6, 1.0, 1.1):
            tree.tick(time)
            if not tree.ticked:
                unticked += 1
                assert tree.statuses[1] in ("R-" if tree.statuses[0] == "R" else "-")
    assert unticked > 0


@pytest.mark.parametrize("decorate", GATES)
def test_81_stopping_a_gate_does_not_reach_a_child_that_never_ran(decorate: Any) -> None:
    log: Log = []
    decorate(Told("a", [R], log)).stop(INVALID)
    assert log == []


# Time and errors


@pytest.mark.parametrize("ticks", [1, 6, 7, 30, 59])
def test_82_a_multiple_of_the_control_period_takes_so_many_ticks(ticks: int) -> None:
    seconds = ticks * ONE_SIXTIETH
    # A sum, as clocks are.
    times = list(itertools.accumulate([1234.5, *[ONE_SIXTIETH] * (ticks + 1)]))
    assert Watched(Wait(seconds=seconds)).at(times) == "R" * ticks + "S" + "R"
    assert Watched(Timeout("d", Scripted("a", "R"), seconds=seconds)).at(times) == "R" * ticks + "F" + "R"
    delayed = Watched(Delay("d", Scripted("a", "S"), seconds=seconds))
    assert delayed.at(times[:-1]) == "R" * ticks + "S"
    cooling = Watched(Cooldown("d", Scripted("a", "S"), seconds=seconds))
    assert cooling.at(times[:-1]) == "S" + "F" * (ticks - 1) + "S"
    holding = Watched(HoldSuccess("d", Scripted("a", "SF"), seconds=seconds))
    assert holding.at(times[:-1]) == "S" * ticks + "F"
    dividing = Watched(TickDivider("d", Scripted("a", "SF"), seconds=seconds))
    assert dividing.at(times[:-1]) == "S" * ticks + "F"
    committed = committing(high="FR")
    ticked = []
    for time in itertools.accumulate([5.0, 0.1, 0.1, 0.1]):
        committed.tick(time)
        ticked.append(committed.ticked)
    assert ticked == ["high low", "low", "low", "high"]


def test_83_a_clock_that_goes_backwards_ends_every_time() -> None:
    assert Watched(Wait(seconds=5.0)).at([100.0, 0.0]) == "RS"
    assert Watched(Timeout("d", Scripted("a", "R"), seconds=5.0)).at([100.0, 0.0]) == "RF"
    assert Watched(Delay("d", Scripted("a", "S"), seconds=5.0)).at([100.0, 0.0]) == "RS"
    assert Watched(Cooldown("d", Scripted("a", "S"), seconds=5.0)).at([100.0, 0.0]) == "SS"
    assert Watched(HoldSuccess("d", Scripted("a", "SF"), seconds=5.0)).at([100.0, 0.0]) == "SF"
    assert Watched(TickDivider("d", Scripted("a", "SF"), seconds=5.0)).at([100.0, 0.0]) == "SF"
    committed = committing(high="FR")
    committed.at([100.0, 0.0])
    assert committed.ticked == "high"


def broken_tree(script: str = "!") -> Behaviour:
    """Its second leaf raises while the first one runs."""
    policy = ParallelPolicy.SuccessOnAll()
    both = Parallel("both", policy, scripted(fine="R", broken=script))
    return Selector("root", memory=False, children=[Scripted("guard", "F"), both])


def test_84_an_exception_stops_the_tree_and_says_where() -> None:
    store = Notes()
    runner = TreeRunner(broken_tree("!R"), store)
    assert runner.tick() is INVALID
    assert re.fullmatch(r"root/both/broken: ZeroDivisionError: no \(scripted\.py:\d+\)", str(runner.error))
    store.diary.clear()
    assert runner.tick() is R
    assert runner.error is None
    assert store.diary[:2] == ["guard starts", "guard ticked"]


def test_85_an_exception_may_be_raised_with_its_path() -> None:
    runner = TreeRunner(broken_tree(), Notes(), on_error="raise")
    with pytest.raises(TreeError, match=r"^root/both/broken: ZeroDivisionError: no \(") as raised:
        runner.tick()
    assert isinstance(raised.value.__cause__, ZeroDivisionError)
    assert str(raised.value) == runner.error
    assert "R" not in runner.statuses()


@pytest.mark.parametrize("script", ["!", "R!"])
def test_86_after_an_exception_nothing_runs(script: str, caplog: pytest.LogCaptureFixture) -> None:
    class Stubborn(Scripted):
        def on_interrupt(self) -> None:
            super().on_interrupt()
            raise KeyError("never")

    root = broken_tree(script)
    both = root.children[1]
    assert isinstance(both, Parallel)
    both.insert_child(Stubborn("stubborn", "R"), 0)
    store = Notes()
    runner = TreeRunner(root, store)
    for _ in script:
        store.diary.clear()
        runner.tick()
    assert runner.error is not None
    failed, *others = sorted(preorder(root), key=lambda node: node.name != "broken")
    assert (failed.name, failed.status) == ("broken", F)
    assert f"broken: {failed.feedback_message}" in runner.error
    assert {node.status for node in others} == {INVALID}
    for name in ("stubborn", "fine"):
        assert store.diary.count(f"{name} interrupted") == 1
    assert "'stubborn' raised again" in caplog.text


class OwnError(BaseException):
    """Not even an Exception."""


class Breaking(Scripted):
    """Raises something when it runs, and something else when it is interrupted."""

    def __init__(
        self, name: str, running: BaseException | None, interrupted: BaseException | None = None
    ) -> None:
        super().__init__(name, "R")
        self.running, self.interrupted = running, interrupted

    def on_running(self) -> Any:
        if self.running is not None:
            raise self.running
        return super().on_running()

    def on_interrupt(self) -> None:
        if self.interrupted is not None:
            raise self.interrupted


def side_by_side(*children: Behaviour) -> Behaviour:
    return Parallel("root", ParallelPolicy.SuccessOnAll(), children=[*children])


@pytest.mark.parametrize("what", [GeneratorExit(), OwnError("odd"), StopIteration(), RecursionError()])
def test_rows_84_to_86_hold_for_whatever_a_node_raises(what: BaseException) -> None:
    runner = TreeRunner(side_by_side(Breaking("again", None, OwnError()), Breaking("b", what)), Notes())
    assert runner.tick() is INVALID
    assert runner.statuses() == "--F"
    assert str(runner.error).startswith(f"root/b: {type(what).__name__}: ")
    runner.root.children[0].status = R
    runner.stop()
    assert runner.statuses() == "---"


@pytest.mark.parametrize("on_error", ["stop", "raise"])
@pytest.mark.parametrize("what", [SystemExit("bye"), KeyboardInterrupt()])
def test_89_what_ends_the_program_is_no_failure(
    what: BaseException, on_error: Literal["stop", "raise"]
) -> None:
    runner = TreeRunner(side_by_side(Breaking("a", None), Breaking("b", what)), Notes(), on_error)
    with pytest.raises(type(what)) as raised:
        runner.tick()
    assert raised.value is what
    assert runner.error is None
    assert runner.statuses() == "---"


@pytest.mark.parametrize("what", [SystemExit("bye"), KeyboardInterrupt()])
def test_row_89_holds_while_a_tree_is_being_stopped(what: BaseException) -> None:
    runner = TreeRunner(side_by_side(Breaking("a", None, what), Breaking("b", None)), Notes())
    runner.tick()
    with pytest.raises(type(what)):
        runner.stop()
    assert runner.statuses() == "---"
    runner = TreeRunner(side_by_side(Breaking("a", None, what), Breaking("b", ValueError())), Notes())
    with pytest.raises(type(what)):
        runner.tick()
    assert runner.statuses() == "---"


def test_87_a_fast_tree_finalises_its_visitors_when_a_node_raises() -> None:
    class Visits(VisitorBase):
        calls = ""

        def initialise(self) -> None:
            self.calls += "i"

        def run(self, behaviour: Behaviour) -> None:
            self.calls += "r"

        def finalise(self) -> None:
            self.calls += "f"

    root = broken_tree()
    Watched(root)
    tree = FastTree(root)
    visits = Visits()
    tree.add_visitor(visits)
    with pytest.raises(ZeroDivisionError):
        tree.tick()
    assert visits.calls == "irrf"
    assert {node.status for node in preorder(root)} == {INVALID}


def test_row_87_holds_for_ctrl_c() -> None:
    class Interrupted(Behaviour):
        def update(self) -> Any:
            raise KeyboardInterrupt

    root = Parallel("root", ParallelPolicy.SuccessOnAll(), children=[Running("runs"), Interrupted("i")])
    with pytest.raises(KeyboardInterrupt):
        FastTree(root).tick()
    assert {node.status for node in preorder(root)} == {INVALID}


def test_88_nothing_of_a_tree_is_shared_by_the_process() -> None:
    def build() -> Behaviour:
        children = [Cooldown("rest", Scripted("kick", "S"), seconds=1.0), Scripted("go", "R")]
        return Selector("root", memory=False, children=children)

    board = py_trees.blackboard.Blackboard
    before = (dict(board.storage), dict(board.clients))
    first, second = Watched(build()), Watched(build())
    assert first.at([0.0, 0.5]) == "SR"
    assert second.at([0.5]) == "S"
    assert before == (board.storage, board.clients)
