"""What every play keeps to."""

from __future__ import annotations

import inspect

import pytest

from robobt.plays import PLAYS
from robobt.tree import preorder

NAMES = [name for name in PLAYS if PLAYS[name].__module__.startswith("robobt.")]


def test_the_plays_of_the_attack_and_the_goalkeeper_are_there() -> None:
    assert {"attack_main", "attack_support", "goalkeeper", "go_to_ball_and_shoot"} <= set(NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_it_says_what_it_does(name: str) -> None:
    assert inspect.getdoc(PLAYS[name])


@pytest.mark.parametrize("name", NAMES)
def test_every_parameter_is_by_keyword_and_has_a_default(name: str) -> None:
    for parameter in inspect.signature(PLAYS[name]).parameters.values():
        assert parameter.kind is inspect.Parameter.KEYWORD_ONLY
        assert parameter.default is not inspect.Parameter.empty


@pytest.mark.parametrize("name", NAMES)
def test_two_robots_get_trees_of_their_own(name: str) -> None:
    first, second = preorder(PLAYS[name]()), preorder(PLAYS[name]())
    assert len(first) == len(second)
    assert not {id(node) for node in first} & {id(node) for node in second}


@pytest.mark.parametrize("name", NAMES)
def test_siblings_can_be_told_apart(name: str) -> None:
    for node in preorder(PLAYS[name]()):
        names = [child.name for child in node.children]
        assert len(names) == len(set(names)), f"{node.name}: {names}"
