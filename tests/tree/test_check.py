"""Wiring: what the nodes of a tree read has to be there, be written by somebody and be of the right type."""

from __future__ import annotations

import pickle
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import pytest

from robobt.plays import PLAYS
from robobt.skills import GoToBall, GoToPose, KickToTarget, SelectPass, SelectShot, ShotIsSteady
from robobt.skills.store import GIVEN, Store
from robobt.tree import Behaviour, Leaf, Parallel, Selector, Sequence, Status
from robobt.tree.check import WiringError, check_tree, entries_of


@dataclass(frozen=True)
class Shot:
    score: float


class FineShot(Shot):
    pass


@dataclass(slots=True)
class Board:
    clock: float
    shot: Shot | None = None
    target: tuple[float, float] | None = None
    count: int = 0
    ratio: float = 0.0
    anything: Any = None
    kinds: ClassVar[int] = 3

    @property
    def half(self) -> float:
        return self.ratio / 2.0

    def forget(self) -> None:
        self.shot = None


def leaf(
    reads: tuple[str, ...] | Mapping[str, Any] = (),
    writes: tuple[str, ...] | Mapping[str, Any] = (),
    optional: tuple[str, ...] = (),
    name: str = "leaf",
) -> Leaf[Board]:
    declared = {"reads": reads, "writes": writes, "optional": optional}
    return type("Made", (Leaf,), declared)(name)  # type: ignore[no-any-return]


def sequence(*children: Behaviour, name: str = "root") -> Behaviour:
    return Sequence(name, memory=False, children=list(children))


def problems(root: Behaviour, *given: str) -> tuple[str, ...]:
    try:
        check_tree(root, Board, given)
    except WiringError as error:
        return error.problems
    return ()


def test_what_one_node_writes_another_may_read_in_whatever_order_they_stand() -> None:
    writer, reader = leaf(writes=("shot",)), leaf(reads=("shot",))
    assert problems(sequence(writer, reader)) == ()
    assert problems(sequence(leaf(reads=("shot",)), leaf(writes=("shot",)))) == ()


def test_a_writer_anywhere_in_the_tree_will_do() -> None:
    deep = Selector("choose", memory=False, children=[sequence(leaf(writes=("shot",)))])
    assert problems(sequence(leaf(reads=("shot",)), deep)) == ()


def test_what_nobody_writes_is_an_error_with_path_and_entry() -> None:
    root = sequence(sequence(leaf(reads=("shot",), name="kick"), name="score"), name="striker")
    assert problems(root) == ("striker/score/kick: reads 'shot', but no other node of the tree writes it",)


def test_what_is_given_need_not_be_written() -> None:
    assert problems(leaf(reads=("clock",)), "clock") == ()
    assert len(problems(leaf(reads=("clock",)))) == 1


def test_what_is_optional_need_not_be_written() -> None:
    assert problems(leaf(reads=("shot",), optional=("shot",))) == ()


def test_a_node_that_only_passes_an_entry_on_is_no_source_of_it() -> None:

    def passes_on() -> Behaviour:
        return leaf(reads=("shot",), writes=("shot",))

    assert len(problems(passes_on())) == 1
    assert len(problems(sequence(passes_on(), passes_on()))) == 2
    remembers = leaf(reads=("shot",), writes=("shot",), optional=("shot",))
    assert problems(sequence(passes_on(), remembers)) == ()


@pytest.mark.parametrize("verb", ["reads", "writes"])
def test_an_entry_the_store_does_not_have_is_an_error(verb: str) -> None:
    declared: dict[str, Any] = {verb: ("goal",)}
    (problem,) = problems(leaf(**declared))
    assert problem == f"leaf: {verb} 'goal', but Board has no such entry"


@pytest.mark.parametrize("name", ["kinds", "forget", "__doc__"])
def test_methods_and_class_variables_are_no_entries(name: str) -> None:
    assert name not in entries_of(Board)
    assert len(problems(leaf(writes=(name,)))) == 1


def test_properties_are_entries_with_the_type_they_return() -> None:
    assert entries_of(Board)["half"] is float


@pytest.mark.parametrize(
    ("entry", "hint"),
    [
        ("shot", Shot),
        ("shot", Shot | None),
        ("shot", object),
        ("target", tuple[float, float]),
        ("count", int),
        ("count", float),
        ("count", int | str),
        ("anything", Shot),
        ("count", Any),
    ],
)
def test_a_type_that_takes_what_is_kept_may_be_read(entry: str, hint: Any) -> None:
    assert problems(leaf(reads={entry: hint}), entry) == ()


@pytest.mark.parametrize(
    ("entry", "hint"),
    [("shot", FineShot), ("shot", float), ("target", tuple[float, float, float]), ("ratio", int)],
)
def test_a_type_that_does_not_take_what_is_kept_may_not_be_read(entry: str, hint: Any) -> None:
    (problem,) = problems(leaf(reads={entry: hint}), entry)
    assert problem.startswith(f"leaf: reads {entry!r} as ")


@pytest.mark.parametrize(
    ("entry", "hint"), [("shot", FineShot), ("shot", None), ("shot", Shot | None), ("ratio", int)]
)
def test_a_type_that_fits_in_may_be_written(entry: str, hint: Any) -> None:
    assert problems(leaf(writes={entry: hint if hint is not None else type(None)})) == ()


@pytest.mark.parametrize(("entry", "hint"), [("shot", float), ("ratio", float | None), ("count", float)])
def test_a_type_that_does_not_fit_in_may_not_be_written(entry: str, hint: Any) -> None:
    (problem,) = problems(leaf(writes={entry: hint}))
    assert "but in Board it is" in problem


def test_a_parameter_of_the_entrys_name_takes_its_place() -> None:
    class Go(Leaf[Board]):
        reads: ClassVar[tuple[str, ...]] = ("target",)

        def __init__(self, *, target: tuple[float, float] | None = None, name: str = "") -> None:
            super().__init__(name)
            self.target = target

    assert problems(Go(target=(1.0, 0.0))) == ()
    assert len(problems(Go())) == 1


def test_control_nodes_are_checked_as_leaves_are() -> None:
    class Switch(Parallel):
        reads = ("clock",)

    root = Switch("switch", policy=None, children=[leaf()])  # type: ignore[arg-type]
    assert problems(root) == ("switch: reads 'clock', but no other node of the tree writes it",)
    assert problems(root, "clock") == ()


def test_everything_wrong_is_told_at_once() -> None:
    root = sequence(leaf(reads=("shot", "goal"), name="a"), leaf(writes={"count": str}, name="b"))
    found = problems(root)
    assert len(found) == 3
    with pytest.raises(WiringError, match=r"root/a: reads 'goal'.*root/a: reads 'shot'.*root/b: writes"):
        check_tree(root, Board)


def test_the_error_survives_the_way_between_processes() -> None:
    with pytest.raises(WiringError) as caught:
        check_tree(leaf(reads=("shot",)), Board)
    copy = pickle.loads(pickle.dumps(caught.value))
    assert copy.problems == caught.value.problems
    assert str(copy) == str(caught.value)


@pytest.mark.parametrize("play", list(PLAYS))
def test_every_play_that_ships_is_wired(play: str) -> None:
    check_tree(PLAYS[play](), Store, GIVEN)


def test_a_kick_needs_a_shot_or_a_pass_or_to_be_told() -> None:
    with pytest.raises(WiringError, match="reads 'shot' or 'pass_'"):
        check_tree(KickToTarget(), Store, GIVEN)
    check_tree(sequence(SelectShot(), KickToTarget()), Store, GIVEN)
    check_tree(sequence(SelectPass(), KickToTarget()), Store, GIVEN)
    check_tree(KickToTarget(target=(1.0, 0.0)), Store, GIVEN)


def test_a_shot_that_nobody_selects_does_not_become_steady() -> None:
    with pytest.raises(WiringError, match="ShotIsSteady"):
        check_tree(sequence(ShotIsSteady(), KickToTarget(target=(1.0, 0.0))), Store, GIVEN)


def test_the_way_to_the_ball_needs_nothing_and_the_way_to_a_place_needs_the_place() -> None:
    check_tree(GoToBall(approach="behind_target"), Store, GIVEN)
    check_tree(GoToPose(target=(0.0, 0.0)), Store, GIVEN)
    with pytest.raises(WiringError, match="GoToPose: reads 'target'"):
        check_tree(GoToPose(), Store, GIVEN)


class Silent(Leaf[Board]):
    def on_running(self) -> Status:
        return self.succeed()


def test_a_leaf_knows_what_it_was_made_from() -> None:
    shot = SelectShot(max_distance=3.0, name="look")
    made = shot.parameters()
    assert made["max_distance"] == 3.0
    assert made["rater"] == "segment_clearance"
    assert made["name"] == "look"
    assert Silent("quiet").parameters() == {"name": "quiet"}
