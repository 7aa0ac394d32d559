"""Parameters that take something registered, by its name alone or with settings."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Annotated

import pytest
from pydantic import BaseModel, Field

from robobt.config.validation import Settings
from robobt.tree import Registry
from robobt.tree.by_name import ByName
from robobt.tree.parameters import Parameter, ParameterError


class Gait(Settings):
    step: float = Field(0.2, gt=0)
    feet: tuple[int, int] = (1, 1)


class Stumble:
    """A way to walk without settings."""


def crawl() -> None:
    """A way to walk without settings, as a function."""


GAITS: Registry[object] = Registry("gait")
for name, entry in (("walk", Gait), ("stumble", Stumble), ("crawl", crawl)):
    GAITS.register(name)(entry)

CLOSED = ByName(GAITS, Gait)
OPEN = ByName(GAITS, others=lambda name: name.endswith(".pt"), also="or give a file")
GAIT = Parameter("gait", Annotated[str | Mapping[str, object] | Gait, CLOSED])
ANY = Parameter("gait", Annotated[str | Mapping[str, object] | Callable[[], None], OPEN])


def test_a_mapping_becomes_what_it_names_and_a_name_stays_a_name() -> None:
    assert GAIT.convert({"name": "walk", "step": 1}) == Gait(step=1.0)
    assert GAIT.convert({"name": "walk"}) == Gait()
    assert GAIT.convert("walk") == "walk"


def test_it_is_said_by_what_is_registered() -> None:
    assert GAIT.kind == "gait"


@pytest.mark.parametrize("value", ["walk", Gait(), Gait(step=0.5, feet=(2, 3))])
def test_what_is_written_as_plain_data_comes_back(value: object) -> None:
    assert GAIT.convert(GAIT.plain(value)) == value


def test_only_settings_that_differ_from_their_defaults_are_written() -> None:
    assert GAIT.plain(Gait(step=0.5)) == {"name": "walk", "step": 0.5}


def test_what_is_made_already_stays_as_it_is() -> None:
    gait = Gait(step=0.5)
    assert GAIT.convert(gait) is gait
    assert CLOSED.make(gait) is gait


@pytest.mark.parametrize(
    ("value", "place", "problem"),
    [
        ("wlak", "gait", "no gait is called 'wlak'; .*did you mean walk"),
        ({"name": "wlak", "step": 1}, "gait.name", "no gait is called 'wlak'; .*did you mean walk"),
        ({"name": "walk", "stpe": 1}, "gait.stpe", "no such field; .*did you mean step"),
        ({"name": "walk", "step": -1}, "gait.step", "greater than 0"),
        ({"name": "walk", "step": "1.5"}, "gait.step", "valid number"),
        ({"name": "walk", "feet": [1, "x"]}, "gait.feet.1", "valid integer"),
        ({"walk": {"step": 1}}, "gait.name", "write {name: walk, SETTING: VALUE}"),
        ({"step": 1}, "gait.name", "is missing: write {name: NAME, SETTING: VALUE}"),
        ({"name": 3, "step": 1}, "gait.name", "takes the name of a gait, not 3"),
        ({"name": "crawl", "step": 1}, "gait.step", "gait crawl has no settings"),
        (3, "gait", "takes the name of a gait, or {name: NAME, SETTING: VALUE}, not 3"),
    ],
)
def test_what_does_not_fit_is_named(value: object, place: str, problem: str) -> None:
    with pytest.raises(ParameterError, match=problem) as caught:
        GAIT.convert(value)
    assert caught.value.parameter == place


def test_a_class_without_settings_is_made_and_a_function_used_as_it_is() -> None:
    assert isinstance(OPEN.make("stumble"), Stumble)
    assert OPEN.make({"name": "crawl"}) is crawl
    assert ANY.convert({"name": "crawl"}) == "crawl"


def test_a_name_may_be_known_elsewhere() -> None:
    assert ANY.convert("mine.pt") == OPEN.make("mine.pt") == OPEN.make({"name": "mine.pt"}) == "mine.pt"
    with pytest.raises(ParameterError, match="no settings"):
        ANY.convert({"name": "mine.pt", "step": 1})
    with pytest.raises(ParameterError, match=r"no gait is called 'mine'; .*; or give a file"):
        ANY.convert("mine")
    with pytest.raises(ParameterError, match="takes the name of a gait"):
        ANY.convert(3)


def test_a_field_of_a_model_takes_one_too() -> None:
    class Trip(BaseModel):
        gait: Annotated[str | Mapping[str, object] | Gait, CLOSED] = "walk"

    assert Trip.model_validate({"gait": {"name": "walk", "step": 2}}).gait == Gait(step=2.0)
    assert Trip(gait=Gait(step=3.0)).model_dump() == {"gait": {"name": "walk", "step": 3.0}}
