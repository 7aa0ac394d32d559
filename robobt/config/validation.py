"""Validation of plain data by pydantic, with one readable line per error."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import ClassVar, get_args

from pydantic import BaseModel, ConfigDict, ValidationError
from pydantic_core import ErrorDetails

from robobt.config.errors import FieldError, message_of, one_line, short_repr, unknown_name

_PLAIN_WORDS = {
    "valid array": "list",
    "valid tuple": "list",
    "valid list": "list",
    "Tuple": "list",
    " after validation": "",
    "an object": "a mapping",
    r"a valid dictionary( or instance of \w+)?": "a mapping",
}
"""pydantic's terms, and the terms for people who write files."""


class Settings(BaseModel):
    """A group of settings or other data from outside: read-only, no unknown fields, finite numbers.

    ``renamed`` maps names that fields had in earlier versions to their new ones, for the error that an old
    name in a file gets.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
    renamed: ClassVar[Mapping[str, str]] = {}


def nested(current: object, path: str, value: object) -> dict[str, object]:
    """Return plain data of ``current`` with the value at the path inside it, whose names dots separate."""
    data: dict[str, object] = {}
    if isinstance(current, BaseModel):
        data = current.model_dump(exclude_unset=True)
    elif isinstance(current, Mapping):
        data = dict(current)
    key, _, inner = path.partition(".")
    return {**data, key: nested(data.get(key), inner, value) if inner else value}


def first_problem(error: ValidationError, model: type[BaseModel], data: object = None) -> tuple[str, str]:
    """Return the field and the message of the first problem in ``error``, with the number of further ones.

    ``model`` is what was to be made of the data. ``data``, the plain data, is needed to name fields
    inside unions.
    """
    problems = error.errors(include_url=False)
    problem = _most_telling(problems)
    place = [str(part) for part in problem["loc"]] if data is None else _path_in(problem["loc"], data)
    cause = problem.get("ctx", {}).get("error")
    message = plain_words(problem["msg"])
    if isinstance(cause, Exception):
        message = message_of(cause)
        if isinstance(cause, FieldError):
            place += cause.field.split(".")
    elif problem["type"] == "missing":
        message = "is missing"
    elif problem["type"] == "extra_forbidden":
        message = _unknown_field(problem["loc"][-1], _models_at(model, problem["loc"][:-1]))
    elif not isinstance(problem["input"], Mapping | list):
        message = f"{message}, not {short_repr(problem['input'])}"
    more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
    return one_line(".".join(place), 200), message[:1].lower() + message[1:] + more


def plain_words(message: str) -> str:
    """Return a ``message`` of pydantic's in words for people who write files, to be put behind a field."""
    for theirs, ours in _PLAIN_WORDS.items():
        message = re.sub(theirs, ours, message)
    return message[:1].lower() + message[1:]


def _most_telling(problems: list[ErrorDetails]) -> ErrorDetails:
    """Return the first problem; an unknown field comes before a missing one beside it, as a likely typo."""
    first = problems[0]
    if first["type"] == "missing":
        for other in problems:
            if other["type"] == "extra_forbidden" and other["loc"][:-1] == first["loc"][:-1]:
                return other
    return first


def _path_in(loc: tuple[int | str, ...], data: object) -> list[str]:
    """Return the path to the field without the names of union members that pydantic inserts."""
    place: list[str] = []
    for depth, part in enumerate(loc):
        inside = isinstance(data, dict) and part in data
        if inside or (isinstance(data, list) and isinstance(part, int) and part < len(data)):
            place.append(str(part))
            data = data[part]  # type: ignore[index]
        elif depth == len(loc) - 1 and isinstance(data, dict | list):
            place.append(str(part))
    return place


def _unknown_field(name: int | str, models: list[type[BaseModel]]) -> str:
    """Say what is wrong with a field that none of the models has."""
    for model in models:
        if issubclass(model, Settings) and name in model.renamed:
            return f"has been renamed: use {model.renamed[str(name)]}"
    known = [key for model in models for key in model.model_fields]
    return f"there is no such field; {unknown_name(name, known)}"


def _models_at(model: type[BaseModel], loc: tuple[int | str, ...]) -> list[type[BaseModel]]:
    """Return the models that the part of a model at ``loc`` may be of."""
    models = [model]
    for part in loc:
        below = [hint.annotation for model in models if (hint := model.model_fields.get(str(part)))]
        if below:
            models = [model for hint in below for model in _models_in(hint)]
        else:
            # A position in a list, or the name of a union's member.
            models = [model for model in models if model.__name__ == part] or models
    return models


def _models_in(hint: object) -> list[type[BaseModel]]:
    if isinstance(hint, type) and issubclass(hint, BaseModel):
        return [hint]
    return [model for part in get_args(hint) for model in _models_in(part)]
