"""What is wrong with a file, in one line: pydantic's errors in words that name the field."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import get_args

from pydantic import BaseModel, ValidationError
from pydantic_core import ErrorDetails

from robobt.tree.parameters import say_value


class FieldError(ValueError):
    """A problem with a field further down than the one that is being validated.

    Attributes:
        field: where, from the validated field on ("0.number").
    """

    def __init__(self, field: str, problem: str) -> None:
        super().__init__(problem)
        self.field = field


def first_problem(error: ValidationError, model: type[BaseModel], data: object) -> tuple[str, str]:
    """Field and message of the first problem, and how many more there are.

    Args:
        model: what the data was validated as.
        data: plain data.
    """
    problems = error.errors(include_url=False)
    problem = _most_telling(problems)
    place = _real_place(problem["loc"], data)
    cause = problem.get("ctx", {}).get("error")
    message = problem["msg"].replace("valid array", "list").replace("an object", "a mapping")
    if isinstance(cause, Exception):
        message = message_of(cause)
        if isinstance(cause, FieldError):
            place += cause.field.split(".")
    elif problem["type"] == "missing":
        message = "is missing"
    elif problem["type"] == "extra_forbidden":
        there = ", ".join(_fields_at(model, problem["loc"][:-1]))
        message = f"there is no such field; there are {there}"
    elif not isinstance(problem["input"], Mapping | list):
        message = f"{message}, not {say_value(problem['input'])}"
    more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
    return ".".join(place), message[:1].lower() + message[1:] + more


def _most_telling(problems: list[ErrorDetails]) -> ErrorDetails:
    """The first problem; an unknown field before a missing one beside it, which it may be, misspelled."""
    first = problems[0]
    if first["type"] == "missing":
        for other in problems:
            if other["type"] == "extra_forbidden" and other["loc"][:-1] == first["loc"][:-1]:
                return other
    return first


def message_of(error: Exception) -> str:
    """What an exception says; that of a KeyError without quotes around it."""
    return str(error.args[0]) if error.args else type(error).__name__


def one_line(text: str, most: int = 500) -> str:
    """The text on one line, printable, and no longer than ``most`` characters."""
    words = " ".join(text.split())
    said = "".join([character if character.isprintable() else "?" for character in words])
    return said if len(said) <= most else said[: most - 3] + "..."


def _real_place(loc: tuple[int | str, ...], data: object) -> list[str]:
    """The way to the field without the names of the union's members that pydantic puts in."""
    place: list[str] = []
    for depth, part in enumerate(loc):
        inside = isinstance(data, dict) and part in data
        if inside or (isinstance(data, list) and isinstance(part, int) and part < len(data)):
            place.append(str(part))
            data = data[part]  # type: ignore[index]
        elif depth == len(loc) - 1 and isinstance(data, dict | list):
            place.append(str(part))
    return place


def _fields_at(model: type[BaseModel], loc: tuple[int | str, ...]) -> list[str]:
    """The fields that the part of a model at ``loc`` may have."""
    models = [model]
    for part in loc:
        below = [hint.annotation for model in models if (hint := model.model_fields.get(str(part)))]
        if below:
            models = [model for hint in below for model in _models_in(hint)]
        else:
            # A place in a list, or the name of a union's member.
            models = [model for model in models if model.__name__ == part] or models
    return [name for model in models for name in model.model_fields]


def _models_in(hint: object) -> list[type[BaseModel]]:
    if isinstance(hint, type) and issubclass(hint, BaseModel):
        return [hint]
    return [model for part in get_args(hint) for model in _models_in(part)]


@contextmanager
def naming(path: Path) -> Iterator[None]:
    """Let an error of the system name this file: one that names none, as that of a full disk, or a temporary.

    The latter is what fails to be renamed, and names this file second.
    """
    try:
        yield
    except OSError as error:
        if error.filename is None or error.filename2 is not None:
            error.filename = str(path)
        raise
