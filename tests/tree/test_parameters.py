"""Parameters read from signatures: what fits them, and how they are said and written."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import Annotated, Any, Literal

import pytest
from pydantic import BaseModel, Field, field_validator

from robobt.config.errors import short_repr
from robobt.tree.parameters import Parameter, ParameterError, check_parameters, parameters_of


class Limits(BaseModel):
    speed: float = Field(1.0, gt=0)
    turn: float | None = None

    @field_validator("turn")
    @classmethod
    def _odd(cls, turn: float | None) -> float | None:
        if turn == 13.0:
            raise RuntimeError("not this one")
        return turn


class Rater(BaseModel, ABC):
    @abstractmethod
    def rate(self) -> float: ...


def drive(
    *, speed: float, style: Literal["calm", "keen"] = "calm", limits: Limits | None = None, name: str = ""
) -> None:
    """Something with parameters."""


class Skill:
    def __init__(self, place: tuple[float, float], *, far: Annotated[float, Field(gt=0)] = 2.0) -> None:
        self.place, self.far = place, far


def test_parameters_are_listed_with_type_and_default() -> None:
    assert [str(parameter) for parameter in parameters_of(drive)] == [
        "speed: float",
        "style: 'calm' | 'keen' = 'calm'",
        "limits: Limits | none = null",
        "name: str = ''",
    ]
    assert [str(parameter) for parameter in parameters_of(Skill)] == [
        "place: tuple[float, float]",
        "far: float = 2.0",
    ]


@pytest.mark.parametrize(
    ("hint", "value", "converted"),
    [
        (float, 1, 1.0),
        (tuple[float, float], [1, 2], (1.0, 2.0)),
        (int | None, None, None),
        (Limits, {"speed": 2}, Limits(speed=2.0)),
        (Literal["a", "b"], "b", "b"),
        (Annotated[float, Field(gt=0)], 1.5, 1.5),
        (Annotated[float, Field(json_schema_extra={"unhashable": []})], 1.5, 1.5),
        (Any, {"a": [1]}, {"a": [1]}),
    ],
)
def test_plain_data_that_fits_is_converted_and_comes_back(hint: Any, value: Any, converted: Any) -> None:
    parameter = Parameter("it", hint)
    found = parameter.convert(value)
    assert found == converted
    assert type(found) is type(converted)
    assert parameter.convert(parameter.plain(found)) == converted


@pytest.mark.parametrize(
    ("hint", "value", "where"),
    [
        (float, "1.5", "it"),
        (float, float("nan"), "it"),
        (float, True, "it"),
        (tuple[float, float], [1, "x"], "it.1"),
        (Limits, {"speed": -1}, "it.speed"),
        (Limits, {"turn": 13.0}, "it"),
        (Rater, {}, "it"),
        (Literal["a"], "b", "it"),
        (Callable[[], None], "print", "it"),
        (object(), 1, "it"),
        (float, object(), "it"),
    ],
)
def test_what_does_not_fit_is_an_error_with_the_place(hint: Any, value: Any, where: str) -> None:
    with pytest.raises(ParameterError) as caught:
        Parameter("it", hint).convert(value)
    assert caught.value.parameter == where


@pytest.mark.parametrize(
    ("hint", "value"),
    [(float, float("inf")), (float, "x"), (Any, object()), (Limits, Limits.model_construct(speed=-1))],
)
def test_what_no_plain_data_makes_cannot_be_written(hint: Any, value: Any) -> None:
    with pytest.raises(ParameterError):
        Parameter("it", hint).plain(value)


def test_given_parameters_are_checked_against_a_signature() -> None:
    assert check_parameters("drive", drive, {"speed": 1, "style": "keen"}) == {"speed": 1.0, "style": "keen"}
    for given, problem in (
        ({}, "drive needs this parameter"),
        ({"speed": 1, "sped": 2}, "drive has no such parameter; it has speed, style, limits, name"),
        ({"speed": 1, "style": "wild"}, "'wild'"),
    ):
        with pytest.raises(ParameterError, match=problem):
            check_parameters("drive", drive, given)


def test_a_value_is_said_on_one_line_and_short() -> None:
    assert short_repr("a\nb") == "'a\\nb'"
    assert len(short_repr("x" * 1000)) == 60


def test_only_the_types_of_parameters_have_to_be_readable() -> None:
    def play(*, speed: float = 1.0) -> Elsewhere:  # type: ignore[name-defined]  # noqa: F821
        return speed

    assert [str(each) for each in parameters_of(play)] == ["speed: float = 1.0"]


def test_a_type_that_cannot_be_read_is_an_error_with_its_place() -> None:
    def play(*, speed: float = 1.0, team: Elsewhere = 1) -> None:  # type: ignore[name-defined]  # noqa: F821
        pass

    line = play.__code__.co_firstlineno
    said = rf"test_parameters\.py:{line}: .*play: the type 'Elsewhere' of 'team' cannot be read: NameError"
    with pytest.raises(ParameterError, match=said) as refused:
        parameters_of(play)
    assert refused.value.parameter == "team"


def test_a_type_that_cannot_be_read_is_named_in_a_dataclass_too() -> None:
    @dataclass
    class Base:
        speed: float = 1.0

    @dataclass
    class Chase(Base):
        team: Elsewhere | None = None  # type: ignore[name-defined]  # noqa: F821

    with pytest.raises(ParameterError, match=r"Chase: the type 'Elsewhere \| None' of 'team'"):
        parameters_of(Chase)
