"""What a program's command may name."""

from __future__ import annotations

from typing import Any

import pytest
from pydantic import ValidationError

from robobt.league.programs.program import PLACEHOLDERS, Program


def program(*command: str, **more: Any) -> Program:
    return Program(command=command, **more)


def test_places_are_filled_in_and_other_braces_stay() -> None:
    given = program("x", "--at={host}:{grsim}", "{{print}}", "${HOME}", '{"a":{"b":1}}', "a{2}")
    filled = given.words({"host": "127.0.0.1", "grsim": "20011"})
    assert filled == ["x", "--at=127.0.0.1:20011", "{print}", "${HOME}", '{"a":{"b":1}}', "a{2}"]


def test_a_place_that_is_not_there_is_told_with_those_that_are() -> None:
    with pytest.raises(ValidationError, match=r"nothing is filled in for {visoin}; there are {team}, {host}"):
        program("x", "{visoin}")
    assert program("x", *[f"{{{place}}}" for place in PLACEHOLDERS], lockstep=True)


def test_steps_are_for_lock_step() -> None:
    with pytest.raises(ValueError, match=r"{steps} is there with 'lockstep: true' only"):
        program("x", "{steps}")
    with pytest.raises(ValueError, match=r"needs {steps} in the command"):
        program("x", lockstep=True)


@pytest.mark.parametrize(
    ("words", "shared"),
    [
        (("{vision}", "{referee_port}"), {"referee"}),
        (("{vision_group}", "{vision_port}"), set()),
        (("{vision_port}", "{tracker_port}", "{tracker}"), {"vision"}),
        (("{grsim}",), set()),
    ],
)
def test_who_takes_a_port_alone_sees_the_leagues_group(words: tuple[str, ...], shared: set[str]) -> None:
    assert program("x", *words).league_groups == shared
