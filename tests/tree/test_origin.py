"""What counts as robobt's own code."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property, partialmethod
from typing import Any

import pytest
from py_trees.decorators import EternalGuard, Inverter

from robobt.plays import PLAYS
from robobt.skills.aim.pass_rater import PassRater
from robobt.skills.aim.raters import RATERS
from robobt.skills.aim.raters.open_angle import OpenAngle
from robobt.skills.aim.select_pass import SelectPass
from robobt.skills.aim.select_shot import SelectShot
from robobt.skills.ball.go_to_ball import GoToBall
from robobt.skills.base import Skill
from robobt.skills.stop import Stop
from robobt.tree import Behaviour, Selector, Sequence, Status
from robobt.tree.namespace import Namespace, within
from robobt.tree.origin import only_own_code
from robobt.tree.registry import Registry
from robobt.tree.walk import preorder
from robobt.world.command import RobotCommand


@pytest.fixture(autouse=True)
def nothing_registered_by_other_tests(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Registry, "foreign", set())


class Theirs(Skill):
    def on_running(self) -> Status:
        return self.run()


class TheirStop(Stop):
    pass


def _own(tree: Behaviour) -> bool:
    return only_own_code(preorder(tree))


@pytest.mark.parametrize("play", ["team_player", "team_goalkeeper", "attack_main", "goalkeeper"])
def test_plays_that_ship_run_only_own_code(play: str) -> None:
    assert _own(PLAYS[play]())


def _patched() -> Behaviour:
    stop = Stop()
    stop.on_running = lambda: Status.RUNNING  # type: ignore[method-assign]
    return stop


def _with_method(node: Behaviour, name: str) -> Behaviour:
    setattr(node, name, lambda *_: Status.RUNNING)
    return node


@pytest.mark.parametrize(
    "make",
    [
        Theirs,
        TheirStop,
        _patched,
        lambda: _with_method(Stop(), "on_start"),
        lambda: _with_method(GoToBall(), "drive_to"),
        lambda: _with_method(Inverter("not", Stop()), "update"),
        lambda: _with_method(Sequence("all", memory=False, children=[Stop()]), "tick"),
        lambda: GoToBall(policy=lambda _store, _approach: RobotCommand()),
        lambda: EternalGuard("guard", Stop(), condition=lambda: True),
        lambda: Selector("any", memory=False, children=[Sequence("all", memory=False, children=[Theirs()])]),
    ],
)
def test_what_a_user_has_written_is_found(make: Callable[..., Any]) -> None:
    assert not _own(make())


@pytest.mark.parametrize("kind", [property, cached_property, partialmethod])
def test_a_users_function_in_a_property_is_found(kind: type, monkeypatch: pytest.MonkeyPatch) -> None:
    assert _own(GoToBall())
    monkeypatch.setattr(Skill, "ball", kind(lambda node: node.frame.ball))
    assert not _own(GoToBall())


def test_a_name_that_a_user_has_registered_is_found() -> None:
    undo = RATERS.undo_point()
    try:
        assert _own(SelectShot(rater="open_angle"))
        RATERS.register("their_rater")(type("TheirRater", (OpenAngle,), {"__module__": __name__}))
        assert not _own(SelectShot(rater="their_rater"))
        assert _own(SelectShot(rater="open_angle"))
    finally:
        undo()


def test_a_rater_within_another_is_found() -> None:
    theirs = type("TheirRater", (OpenAngle,), {"__module__": __name__})
    assert _own(SelectPass(rater=PassRater()))
    assert not _own(SelectPass(rater=PassRater(shot_rater=theirs())))


def test_a_method_that_a_user_has_put_into_a_class_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    assert _own(Stop())
    monkeypatch.setattr(Stop, "on_running", lambda _: Status.RUNNING)
    assert not _own(Stop())


def test_a_name_in_the_place_of_a_default_is_found() -> None:
    theirs = type("TheirRater", (OpenAngle,), {"__module__": __name__})
    with within(Namespace()):
        RATERS.register(str(SelectShot().parameters()["rater"]))(theirs)
        assert not _own(SelectShot())
