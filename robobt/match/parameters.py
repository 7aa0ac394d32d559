"""The parameters of plays and skills, read from their signatures."""

from __future__ import annotations

import inspect
import json
import typing
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from pydantic import ConfigDict, TypeAdapter, ValidationError
from pydantic.errors import PydanticUserError

from robobt.match.problems import say_value


class ParameterError(ValueError):
    """A parameter that does not fit.

    Attributes:
        parameter: its name, with the place inside it when it is a structure ("point.0").
    """

    def __init__(self, parameter: str, problem: str) -> None:
        super().__init__(problem)
        self.parameter = parameter


@dataclass(frozen=True)
class Parameter:
    """One parameter of a play or a skill.

    Attributes:
        name: as written in a scenario.
        hint: its type.
        default: its default; ``inspect.Parameter.empty`` when it has to be given.
    """

    name: str
    hint: Any
    default: Any

    @property
    def required(self) -> bool:
        """Whether it has no default."""
        return self.default is inspect.Parameter.empty

    @property
    def kind(self) -> str:
        """The type as a person would write it."""
        return _say_hint(self.hint)

    def __str__(self) -> str:
        return f"{self.name}: {self.kind}" + ("" if self.required else f" = {_say_default(self.default)}")


def parameters_of(builder: Callable[..., object]) -> list[Parameter]:
    """Parameters that can be given by name, in the order of the signature."""
    target = builder.__init__ if inspect.isclass(builder) else builder
    hints = typing.get_type_hints(target, include_extras=True)
    kinds = (inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY)
    return [
        Parameter(name, hints.get(name, Any), entry.default)
        for name, entry in inspect.signature(builder).parameters.items()
        if entry.kind in kinds
    ]


def check_parameters(what: str, builder: Callable[..., object], given: Mapping[str, Any]) -> dict[str, Any]:
    """The given parameters, converted to the types of the builder's signature.

    The rules are those of strict JSON: a list fits a tuple and an integer a
    float, but "1.5" is no number.

    Args:
        what: what the builder is called, for messages.
        builder: a play or a skill's class.
        given: plain data by parameter name.

    Raises:
        ParameterError: an unknown parameter, one missing, or one of the wrong type.
    """
    known = {parameter.name: parameter for parameter in parameters_of(builder)}
    for name in given:
        if name not in known:
            there = f"it has {', '.join(known)}" if known else "it has none"
            raise ParameterError(name, f"{what} has no such parameter; {there}")
    for name, parameter in known.items():
        if parameter.required and name not in given:
            raise ParameterError(name, f"{what} needs this parameter")
    return {name: _convert(known[name], value) for name, value in given.items()}


def _convert(parameter: Parameter, value: Any) -> Any:
    try:
        adapter = TypeAdapter(parameter.hint, config=_FINITE)
    except PydanticUserError as error:
        # Models, dataclasses and the like carry their own configuration.
        if error.code != "type-adapter-config-unused":
            raise ParameterError(
                parameter.name, f"a {parameter.kind} cannot be given as plain data"
            ) from error
        adapter = TypeAdapter(parameter.hint)
    try:
        return adapter.validate_json(json.dumps(value), strict=True)
    except ValidationError as error:
        problem = error.errors(include_url=False)[0]
        place = ".".join([parameter.name, *[str(part) for part in problem["loc"]]])
        raise ParameterError(place, f"{problem['msg']}, not {say_value(problem['input'])}") from error


_FINITE = ConfigDict(allow_inf_nan=False)


def _say_hint(hint: Any) -> str:
    origin, arguments = typing.get_origin(hint), typing.get_args(hint)
    if origin is typing.Annotated:
        return _say_hint(arguments[0])
    if origin is typing.Literal:
        return " | ".join([repr(argument) for argument in arguments])
    if hint is type(None) or hint is None:
        return "none"
    if hint is Any:
        return "anything"
    if origin is not None and arguments:
        if origin is typing.Union or getattr(origin, "__name__", "") == "UnionType":
            return " | ".join([_say_hint(argument) for argument in arguments])
        inside = ", ".join(["..." if part is Ellipsis else _say_hint(part) for part in arguments])
        return f"{getattr(origin, '__name__', origin)}[{inside}]"
    return getattr(hint, "__name__", str(hint))


def _say_default(default: object) -> str:
    return "none" if default is None else repr(str(default)) if isinstance(default, str) else f"{default}"
