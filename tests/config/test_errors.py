"""One way to name a file, a line and a field."""

from __future__ import annotations

import pickle
from pathlib import Path

import pytest
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from robobt.config.errors import ConfigError, FieldError, RobobtError, naming, one_line, short_repr
from robobt.config.extras import MissingExtraError
from robobt.config.validation import first_problem
from robobt.league.programs.program import ForfeitError
from robobt.match.recording.header import RecordingError
from robobt.tournament.store import StoreError
from robobt.tree.parameters import ParameterError
from robobt.world import Team as FieldTeam


class OwnError(ConfigError):
    """An error of some room."""


@pytest.mark.parametrize(
    ("error", "message"),
    [
        (OwnError("a.yaml", "is empty"), "a.yaml: is empty"),
        (OwnError("a.yaml", "is missing", "robots.0"), "a.yaml: robots.0: is missing"),
        (OwnError("a.yaml", "is missing", "robots.0", 3), "a.yaml:3: robots.0: is missing"),
        (OwnError("", "is missing", "robots.0"), "robots.0: is missing"),
        (OwnError("a\n.yaml", "two\nlines"), "a .yaml: two lines"),
    ],
)
def test_the_message_names_what_is_known(error: OwnError, message: str) -> None:
    assert str(error) == message
    assert isinstance(error, RobobtError)
    copy = pickle.loads(pickle.dumps(error))
    assert (type(copy), copy.args, copy.__dict__) == (OwnError, error.args, error.__dict__)


@pytest.mark.parametrize(
    "error",
    [
        RecordingError(Path("match.arrows"), "is cut off", 7, "ball"),
        ForfeitError(FieldTeam.YELLOW, "its program ended"),
        MissingExtraError("pymunk", "sim"),
        FieldError("0.number", "is taken"),
        StoreError(Path("results"), "holds other entrants", "entrants"),
        ParameterError("policy", "there is no such policy"),
    ],
    ids=lambda error: type(error).__name__,
)
def test_an_error_that_a_worker_raised_arrives_as_it_was(error: RobobtError) -> None:
    copy = pickle.loads(pickle.dumps(error))
    assert (type(copy), str(copy), copy.__dict__) == (type(error), str(error), error.__dict__)


def test_a_message_is_one_printable_line_of_bounded_length() -> None:
    assert one_line("a\n\tb\x07") == "a b?"
    assert one_line("x" * 600) == "x" * 497 + "..."
    assert short_repr("x" * 100) == "'" + "x" * 56 + "..."


def test_an_error_of_a_full_disk_names_the_file() -> None:
    with pytest.raises(OSError, match="mine") as caught, naming(Path("mine")):
        raise OSError(28, "No space left on device")
    assert caught.value.filename == "mine"


class Robot(BaseModel):
    model_config = ConfigDict(extra="forbid")
    number: int = Field(ge=0)


class Team(BaseModel):
    model_config = ConfigDict(extra="forbid")
    robots: list[Robot]


@pytest.mark.parametrize(
    ("data", "field", "message"),
    [
        ({"robots": [{"number": -1}]}, "robots.0.number", "greater than or equal to 0, not -1"),
        ({"robots": [{}]}, "robots.0.number", "is missing"),
        (
            {"robots": [{"nummer": 1}]},
            "robots.0.nummer",
            "there are number (and 1 more)",
        ),
        ({"robots": 3}, "robots", "should be a list, not 3"),
    ],
)
def test_the_first_problem_names_the_field(data: object, field: str, message: str) -> None:
    with pytest.raises(ValidationError) as caught:
        Team.model_validate(data)
    place, problem = first_problem(caught.value, Team, data)
    assert place == field
    assert message in problem
