"""Decorators that answer for their child at times: what the table of docs/control_nodes.md does not say."""

from __future__ import annotations

from typing import Any

import pytest

from robobt.tree import Sequence, Status
from robobt.tree.nodes import Cooldown, Delay, Gate, HoldSuccess, TickDivider, Timeout, Wait
from tests.tree.scripted import Scripted, Watched


@pytest.mark.parametrize("kind", [Cooldown, Delay, HoldSuccess, TickDivider, Timeout])
@pytest.mark.parametrize("seconds", [-0.1, float("nan"), float("inf")])
def test_a_time_has_to_be_one(kind: Any, seconds: float) -> None:
    with pytest.raises(ValueError, match="seconds must be 0 or more and finite, not"):
        kind("d", Scripted("a", "S"), seconds=seconds)


def test_a_wait_has_to_be_finite() -> None:
    with pytest.raises(ValueError, match="seconds must be finite, not inf"):
        Wait(seconds=float("inf"))


@pytest.mark.parametrize(
    ("kind", "letters"), [(Cooldown, "RRSF"), (Delay, "RRSF"), (HoldSuccess, "RRSF"), (TickDivider, "RRSF")]
)
def test_no_time_at_all_changes_nothing(kind: Any, letters: str) -> None:
    assert Watched(kind("d", Scripted("a", "RRSF"), seconds=0.0)).at([0.0, 0.0, 1.0, 1.0]) == letters


def test_a_timeout_of_nothing_still_ticks_once() -> None:
    assert Watched(Timeout("d", Scripted("a", "S"), seconds=0.0)).tick() == "S"
    assert Watched(Timeout("d", Scripted("a", "R"), seconds=0.0)).ticks(2) == "RF"


def test_the_tip_is_the_gate_that_answers() -> None:
    """The reason of a failure is found at the tip."""
    gate = Cooldown("rest", Scripted("kick", "S"), seconds=1.0)
    root = Sequence("root", memory=False, children=[gate])
    tree = Watched(root)
    tree.at([0.0, 0.5])
    assert root.tip() is gate
    assert gate.feedback_message == "pauses until 1.00 s"


def test_the_own_remark_goes_when_the_child_is_ticked_again() -> None:
    for gate in (
        Cooldown("d", Scripted("a", "S"), seconds=1.0),
        HoldSuccess("d", Scripted("a", "S"), seconds=1.0),
        Delay("d", Scripted("a", "S"), seconds=1.0),
    ):
        tree = Watched(gate)
        tree.at([0.0, 0.5])
        assert gate.feedback_message.endswith("until 1.00 s")
        tree.tick(1.0)
        assert gate.feedback_message == ""


def test_a_remark_does_not_change_at_every_tick() -> None:
    """A recording keeps what is new; a countdown would be new at every tick."""
    gate = Cooldown("d", Scripted("a", "S"), seconds=1.0)
    tree = Watched(gate)
    tree.tick(0.0)
    remarks = set()
    for time in (0.1, 0.2, 0.9):
        tree.tick(time)
        remarks.add(gate.feedback_message)
    assert len(remarks) == 1


def test_a_cooldown_takes_one_of_three_ends() -> None:
    with pytest.raises(ValueError, match="after must be one of either, success, failure, not 'done'"):
        Cooldown("d", Scripted("a", "S"), seconds=1.0, after="done")  # type: ignore[arg-type]


@pytest.mark.parametrize("how", [{}, {"every": 2, "seconds": 0.1}])
def test_a_divider_goes_by_ticks_or_by_time(how: Any) -> None:
    with pytest.raises(ValueError, match=r"give either every \(ticks\) or seconds"):
        TickDivider("d", Scripted("a", "S"), **how)


def test_a_divider_needs_a_whole_tick() -> None:
    with pytest.raises(ValueError, match="every must be 1 or more ticks, not 0"):
        TickDivider("d", Scripted("a", "S"), every=0)


def test_a_divider_survives_the_resets_of_a_reactive_sequence() -> None:
    """Its parent ends at every tick and resets it; only an interruption may make it forget."""
    divider = TickDivider("d", Scripted("rate", "S"), every=5)
    tree = Watched(Sequence("root", memory=False, children=[divider, Scripted("open", "F")]))
    ticked = 0
    for _ in range(20):
        tree.tick()
        ticked += "rate" in tree.ticked
    assert ticked == 4


def test_a_gate_that_runs_keeps_a_running_child_and_drops_a_finished_one() -> None:
    class Odd(Gate):
        """Ticks its child every other time and says RUNNING in between."""

        count = 0

        def answer(self) -> Status | None:
            self.count += 1
            return None if self.count % 2 else Status.RUNNING

    tree = Watched(Odd("d", Scripted("a", "RS")))
    seen = []
    for _ in range(4):
        tree.tick()
        seen.append(tree.statuses)
    assert seen == ["RR", "RR", "SS", "R-"]


def test_a_gate_without_an_answer_says_so() -> None:
    with pytest.raises(RuntimeError, match="Gate does not define answer"):
        Watched(Gate("d", Scripted("a", "S"))).tick()
