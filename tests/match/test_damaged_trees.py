"""A skill that makes something else of its tree stops its own robot and nobody else's match."""

from __future__ import annotations

from collections.abc import Callable
from math import nan
from pathlib import Path

import pytest
from py_trees.common import ParallelPolicy

from robobt.match import MatchLoop
from robobt.match.recording import load_recording
from robobt.match.scenario.scenario import ScenarioError, scenario_from
from robobt.plays import PLAYS
from robobt.skills.base import Skill
from robobt.tree import Behaviour, Inverter, Parallel, Selector, Sequence, Status, TreeError, TreeRunner
from robobt.world.command import RobotCommand
from tests.match.scripted import PlainWorld, data


class Runs(Skill):
    def on_running(self) -> Status:
        return self.run()


class Damages(Skill):
    """Does something to its tree at the third tick."""

    def __init__(self, damage: Callable[[Behaviour], object], name: str = "") -> None:
        super().__init__(name)
        self.damage, self.ticks = damage, 0

    def on_running(self) -> Status:
        self.ticks += 1
        if self.ticks == 3:
            self.damage(self)
        return self.run()


def main(me: Behaviour) -> Sequence:
    assert isinstance(me.parent, Sequence)
    return me.parent


def root(me: Behaviour) -> Selector:
    assert isinstance(main(me).parent, Selector)
    return main(me).parent


def first(me: Behaviour, child: object) -> None:
    main(me).children.insert(0, child)


def inverted(me: Behaviour) -> None:
    inverter = Inverter("inverter", Runs())
    first(me, inverter)
    inverter.decorated = root(me)


def in_parallel(me: Behaviour) -> None:
    parallel = Parallel("parallel", ParallelPolicy.SuccessOnAll())
    parallel.children.append(root(me))
    first(me, parallel)


def deepened(me: Behaviour) -> None:
    node: Behaviour = Runs()
    for _ in range(1200):
        above = Sequence("deep", memory=False)
        above.children.append(node)
        node = above
    first(me, node)


STOPS: dict[str, tuple[Callable[[Behaviour], object], str]] = {
    "the root below itself": (lambda me: first(me, root(me)), "root: is its own descendant"),
    "its parent below itself": (lambda me: first(me, main(me)), "root/main: is its own descendant"),
    "with a parent's mark": (lambda me: main(me).prepend_child(root(me)), "main/root: is its own descendant"),
    "below a decorator": (inverted, "root: is its own descendant"),
    "below a parallel": (in_parallel, "root: is its own descendant"),
    "too deep": (deepened, "root: a tree may be 200 nodes deep, and this one is deeper"),
    "a child of None": (lambda me: first(me, None), "root/main: one of its children is no node: None"),
    "a child of text": (lambda me: first(me, "GoToBall"), "one of its children is no node: 'GoToBall'"),
    "a class as a child": (lambda me: first(me, Runs), "one of its children is no node: <class"),
    "no list of children": (lambda me: setattr(main(me), "children", None), "no node: None"),
}
GOES_ON: dict[str, Callable[[Behaviour], object]] = {
    "itself removed": lambda me: main(me).remove_child(me),
    "itself removed from the list": lambda me: main(me).children.remove(me),
    "all removed": lambda me: main(me).remove_all_children(),
    "in two places": lambda me: root(me).children.append(me),
    "a status of another node that is none": lambda me: setattr(root(me).children[1], "status", None),
    "a name that is none": lambda me: setattr(main(me), "name", None),
}


def match_with(damage: str, record: Path | None = None) -> MatchLoop:
    given = data(ends={"time_limit": 0.2})
    (fine,) = given["robots"]["blue"]
    start = {"position": [-2.0, 2.0], "heading": 0.0}
    damaged = {"number": 1, "play": "damaged", "params": {"damage": damage}, "start": start}
    given["robots"]["blue"] = [fine, damaged]
    return MatchLoop(scenario_from(given, "test.yaml"), 1, PlainWorld, record=record)


def _damaged(*, damage: str = "all removed") -> Behaviour:
    does = STOPS[damage][0] if damage in STOPS else GOES_ON[damage]
    steps: list[Behaviour] = [Damages(does), Runs("after")]
    return Selector("root", memory=False, children=[Sequence("main", False, steps), Runs("rest")])


if "damaged" not in PLAYS:
    PLAYS.register("damaged")(_damaged)


@pytest.mark.parametrize("damage", STOPS)
def test_a_skill_that_makes_no_tree_of_its_tree_stops_its_robot_alone(damage: str, tmp_path: Path) -> None:
    path = tmp_path / "match.robobt.arrows"
    result = match_with(damage, path).play()
    assert result.ticks == len(load_recording(path)) == 11
    assert result.robots["blue 0"].errors == 0
    # From the tick after that on which it did so, at every one.
    assert result.robots["blue 1"].errors == 7
    assert STOPS[damage][1] in str(result.robots["blue 1"].first_error)


@pytest.mark.parametrize("damage", GOES_ON)
def test_a_skill_that_makes_another_tree_of_its_tree_plays_on(damage: str, tmp_path: Path) -> None:
    path = tmp_path / "match.robobt.arrows"
    result = match_with(damage, path).play()
    assert result.ticks == len(load_recording(path)) == 11
    assert [robot.errors for robot in result.robots.values()] == [0, 0]


def test_a_store_without_a_command_is_a_fault_of_its_tree() -> None:
    match = match_with("all removed")
    tick = match.players[1].runner.tick

    def deletes() -> Status:
        status = tick()
        del match.players[1].store.command
        return status

    match.players[1].runner.tick = deletes  # type: ignore[method-assign]
    result = match.play()
    assert "command is no RobotCommand: None" in str(result.robots["blue 1"].first_error)
    assert result.ticks == 11


class Raises:
    """Raises whatever is done with it."""

    def __str__(self) -> str:
        raise RuntimeError("no text")

    __repr__ = __str__


class Ends(BaseException):
    """An exception of a skill's own that is no Exception."""


class LateCommand(RobotCommand):
    """A command whose numbers cannot be read, nor itself be shown."""

    def __getattribute__(self, name: str) -> object:
        raise KeyError(name)


class EndingCommand(RobotCommand):
    def finite(self) -> bool:
        raise Ends


class Unclassed(Raises):
    @property
    def __class__(self) -> type:  # type: ignore[override]
        raise RuntimeError("no class")


COMMANDS: dict[str, tuple[Callable[[], object], str]] = {
    "no command, without text": (Raises, "command is no RobotCommand: a Raises whose text is a RuntimeError"),
    "no command, without class": (Unclassed, "command cannot be read: RuntimeError"),
    "a number without text": (
        lambda: 10**5000,
        "RobotCommand: a int whose text is a ValueError",
    ),
    "not finite, without text": (
        lambda: RobotCommand(nan, kick_trigger=Raises()),  # type: ignore[arg-type]
        "command is not finite: a RobotCommand whose text is a RuntimeError",
    ),
    "without numbers": (LateCommand, "command cannot be read: KeyError"),
    "one that ends": (EndingCommand, "command cannot be read: Ends"),
}


@pytest.mark.parametrize("what", COMMANDS)
def test_a_command_that_raises_when_it_is_read_stops_its_robot_alone(what: str, tmp_path: Path) -> None:
    command, said = COMMANDS[what]
    path = tmp_path / "match.robobt.arrows"
    match = match_with("all removed", path)
    player = match.players[1]
    tick = player.runner.tick

    def commands() -> Status:
        status = tick()
        player.store.command = command()  # type: ignore[assignment]
        return status

    player.runner.tick = commands  # type: ignore[method-assign]
    result = match.play()
    assert said in str(result.robots["blue 1"].first_error)
    assert result.ticks == len(load_recording(path)) == 11
    assert result.robots["blue 0"].errors == 0


def unnamed(me: Behaviour) -> None:
    me.name = Raises()  # type: ignore[assignment]
    raise ValueError("unnamed")


def unnamed_above(me: Behaviour) -> None:
    main(me).name = Raises()  # type: ignore[assignment]
    raise ValueError("unnamed")


def without_a_name(me: Behaviour) -> None:
    def name(_: object) -> str:
        raise Ends

    me.__class__ = type("Nameless", (Damages,), {"name": property(name)})
    raise ValueError("unnamed")


def unnamed_and_unstoppable(me: Behaviour) -> None:
    def stop(_: Status) -> None:
        raise RuntimeError("goes on")

    me.stop = stop  # type: ignore[assignment, method-assign]
    unnamed(me)


@pytest.mark.parametrize("damage", [unnamed, unnamed_above, without_a_name, unnamed_and_unstoppable])
def test_a_node_whose_name_raises_stops_its_robot_alone(
    damage: Callable[[Behaviour], None], tmp_path: Path
) -> None:
    path = tmp_path / "match.robobt.arrows"
    match = match_with("all removed", path)
    damages = match.players[1].runner.root.children[0].children[0]
    assert isinstance(damages, Damages)
    damages.damage = damage
    result = match.play()
    said = str(result.robots["blue 1"].first_error)
    assert "whose text is a" in said
    assert "ValueError: unnamed" in said
    assert result.ticks == len(load_recording(path)) == 11
    assert result.robots["blue 0"].errors == 0


def looped() -> Behaviour:
    tree = Sequence("loop", memory=False, children=[Runs()])
    tree.children.append(tree)
    return tree


def doubled() -> Behaviour:
    node: Behaviour = Runs("shared")
    for _ in range(60):
        above = Sequence("above", memory=False)
        above.children += [node, node]
        node = above
    return node


@pytest.mark.parametrize(
    ("build", "said"),
    [(looped, "loop: is its own descendant"), (doubled, "is a child twice of '.*'; make a node for each")],
)
def test_nodes_that_are_no_tree_are_refused_before_the_match(
    build: Callable[[], Behaviour], said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(PLAYS._entries, "damaged", lambda *, damage="": build())
    with pytest.raises(ScenarioError, match=said):
        match_with("")
    with pytest.raises(TreeError, match=said):
        TreeRunner(build(), None)
