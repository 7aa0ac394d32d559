"""The parameters of plays, skills and nodes, read from their signatures."""

from __future__ import annotations

import inspect
import json
import sys
import types
import typing
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, TypeAdapter, ValidationError
from pydantic.errors import PydanticUserError
from pydantic_core import PydanticSerializationError

from robobt.config.errors import FieldError, RobobtError, message_of, short_repr, unknown_name
from robobt.config.validation import first_problem, nested, plain_words
from robobt.tree.by_name import ByName
from robobt.tree.signatures import signature_of


class ParameterError(RobobtError, ValueError):
    """A parameter that does not fit.

    Attributes:
        parameter: its name, with the place inside it when it is a structure ("point.0").
    """

    def __init__(self, parameter: str, problem: str) -> None:
        super().__init__(problem)
        self.parameter = parameter


@dataclass(frozen=True)
class Parameter:
    """One parameter of a play or a node.

    ``name`` is as written in a file, ``default`` is ``inspect.Parameter.empty`` when it has to be given.
    """

    name: str
    hint: Any
    default: Any = inspect.Parameter.empty

    @property
    def required(self) -> bool:
        """Whether it has no default."""
        return self.default is inspect.Parameter.empty

    @property
    def kind(self) -> str:
        """The type as a person would write it."""
        return say_hint(self.hint)

    def __str__(self) -> str:
        return f"{self.name}: {self.kind}" + ("" if self.required else f" = {_say_default(self.default)}")

    def convert(self, value: object) -> Any:
        """Convert plain data to this parameter's type.

        The rules are those of strict JSON: a list fits a tuple and an integer a
        float, but "1.5" is not a number. What is no plain data but of the type stays as it is.
        """
        adapter = self._adapter()
        try:
            text = json.dumps(value)
        except (TypeError, ValueError, RecursionError) as error:
            with suppress(Exception):
                return adapter.validate_python(value, strict=True)
            raise ParameterError(self.name, f"{short_repr(value)} is not plain data") from error
        try:
            return adapter.validate_json(text, strict=True)
        except ValidationError as error:
            groups = [
                one for one in members_of(self.hint) if isinstance(one, type) and issubclass(one, BaseModel)
            ]
            if len(groups) == 1 and isinstance(value, Mapping):
                field, said = first_problem(error, groups[0], value)
                raise ParameterError(f"{self.name}.{field}", said) from error
            problem = error.errors(include_url=False)[0]
            place = ".".join([self.name, *[str(part) for part in problem["loc"]]])
            cause = problem.get("ctx", {}).get("error")
            if isinstance(cause, FieldError):
                raise ParameterError(f"{place}.{cause.field}", message_of(cause)) from error
            said = message_of(cause) if isinstance(cause, ValueError) else plain_words(problem["msg"])
            raise ParameterError(place, f"{said}, not {short_repr(problem['input'])}") from error
        except Exception as error:
            # Validators run foreign code, and an abstract model cannot be made at all.
            raise ParameterError(self.name, f"{type(error).__name__}: {error}") from error

    def plain(self, value: object) -> Any:
        """Return the plain data that :meth:`convert` makes into an equal value."""
        adapter = self._adapter()
        try:
            data = adapter.dump_python(value, mode="json", warnings="error", exclude_defaults=True)
            if self.convert(data) == self.convert(value):
                return data
        except (PydanticSerializationError, ValueError, TypeError):
            pass
        raise ParameterError(self.name, f"{short_repr(value)} cannot be written as plain data")

    def _adapter(self) -> TypeAdapter[Any]:
        try:
            return _adapter(self.hint)
        except TypeError:
            # A hint that cannot be hashed.
            return _adapter.__wrapped__(self.hint)
        except PydanticUserError as error:
            raise ParameterError(self.name, f"a {self.kind} cannot be given as plain data") from error


def parameters_of(builder: Callable[..., object]) -> list[Parameter]:
    """Return the parameters that can be given by name, in the order of the signature.

    Raises:
        ParameterError: the type of one cannot be read, as where it is imported for type checkers only.
    """
    kinds = (inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY)
    named = [
        (name, entry.default)
        for name, entry in signature_of(builder).parameters.items()
        if entry.kind in kinds
    ]
    hints = _hints_of(builder, {name for name, _ in named})
    return [Parameter(name, hints.get(name, Any), default) for name, default in named]


def _hints_of(builder: Callable[..., object], names: set[str]) -> dict[str, Any]:
    """Return the types of the parameters with these names; no other type has to be readable."""
    target: Any = builder
    # The fields of a dataclass have their types in the modules of the classes that they come from.
    if inspect.isclass(builder) and "__dataclass_fields__" not in vars(builder):
        target = builder.__init__
    # Types are users' code, and may raise anything; which one it was shows when they are read one by one.
    with suppress(Exception):
        return typing.get_type_hints(target, include_extras=True)
    hints: dict[str, Any] = {}
    for owner in reversed(target.__mro__) if inspect.isclass(target) else (target,):
        known, local = (
            (getattr(sys.modules.get(owner.__module__), "__dict__", {}), dict(vars(owner)))
            if inspect.isclass(owner)
            else (inspect.unwrap(owner).__globals__, None)
        )
        for name, hint in inspect.get_annotations(owner).items():
            if name not in names:
                continue
            alone = types.SimpleNamespace(__annotations__={name: hint})
            try:
                hints |= typing.get_type_hints(alone, known, local, include_extras=True)
            except Exception as error:
                said = f"the type {hint!r} of {name!r} cannot be read: {type(error).__name__}: {error}"
                raise ParameterError(name, f"{_place_of(builder)}{said}") from error
    return hints


def _place_of(builder: Callable[..., object]) -> str:
    """Return file, line and name of a function or class, to begin a message with."""
    found = inspect.unwrap(builder)
    name = getattr(found, "__qualname__", repr(found))
    try:
        return f"{Path(inspect.getfile(found)).name}:{inspect.getsourcelines(found)[1]}: {name}: "
    except (OSError, TypeError):
        return f"{name}: "


def check_parameters(
    what: str, builder: Callable[..., object], given: Mapping[str, object]
) -> dict[str, Any]:
    """Convert plain data by name to the types of a signature; ``what`` names its owner in messages.

    A name with dots is that of a value inside a parameter, as ``tactics.switch_gain``.
    """
    known = {parameter.name: parameter for parameter in parameters_of(builder)}
    whole: dict[str, object] = {}
    for name, value in given.items():
        key, _, inner = name.partition(".")
        whole[key] = nested(_settings_of(whole.get(key), known.get(key)), inner, value) if inner else value
    check_names(what, known, whole)
    return {name: known[name].convert(value) for name, value in whole.items()}


def _settings_of(given: object, parameter: Parameter | None) -> object:
    """Return what is given, or else the default; of one that is a name, the mapping with it."""
    if given is None and parameter is not None and not parameter.required:
        given = parameter.default
    return {"name": given} if isinstance(given, str) else given


def parameter_at(what: str, builder: Callable[..., object], name: str) -> Parameter:
    """Return the parameter with that name, or the field of a group of settings among the parameters.

    Raises:
        ParameterError: there is none; ``what`` names the owner in the message.
    """
    key, *inner = name.split(".")
    known = {parameter.name: parameter for parameter in parameters_of(builder)}
    if key not in known:
        check_names(what, known, {key: None})
    found = known[key]
    for part in inner:
        fields = getattr(found.hint, "model_fields", {})
        if part not in fields:
            there = unknown_name(part, fields, "it has") if fields else "it is no group of settings"
            raise ParameterError(name, f"{found.name} has no such field; {there}")
        hint, metadata = fields[part].annotation, fields[part].metadata
        found = Parameter(f"{found.name}.{part}", Annotated[hint, *metadata] if metadata else hint)
    return found


def check_names(what: str, known: Mapping[str, Parameter], given: Mapping[str, object]) -> None:
    """Check that every given name is known and every parameter without a default is given."""
    for name in given:
        if name not in known:
            there = unknown_name(name, known, "it has")
            raise ParameterError(name, f"{what} has no such parameter; {there}")
    for name, parameter in known.items():
        if parameter.required and name not in given:
            raise ParameterError(name, f"{what} needs this parameter")


def say_hint(hint: object) -> str:
    """Return a type as a person would write it."""
    origin, arguments = typing.get_origin(hint), typing.get_args(hint)
    if origin is typing.Annotated:
        named = [str(part) for part in arguments[1:] if isinstance(part, ByName)]
        return named[0] if named else say_hint(arguments[0])
    if origin is typing.Literal:
        return " | ".join([repr(argument) for argument in arguments])
    if hint is type(None) or hint is None:
        return "none"
    if hint is Any:
        return "anything"
    if origin is not None and arguments:
        if origin in (typing.Union, types.UnionType):
            return " | ".join([say_hint(argument) for argument in arguments])
        inside = ", ".join(["..." if part is Ellipsis else say_hint(part) for part in arguments])
        return f"{getattr(origin, '__name__', origin)}[{inside}]"
    return getattr(hint, "__name__", str(hint))


def _say_default(default: object) -> str:
    if isinstance(default, BaseModel):
        return f"{default.model_dump(mode='json', exclude_defaults=True)}"
    return "null" if default is None else repr(str(default)) if isinstance(default, str) else f"{default}"


def members_of(hint: object) -> set[object]:
    """Return the members of a union type, or the type itself."""
    if typing.get_origin(hint) is Annotated:
        hint = typing.get_args(hint)[0]
    if typing.get_origin(hint) in (typing.Union, types.UnionType):
        return {member for part in typing.get_args(hint) for member in members_of(part)}
    try:
        return {types.NoneType if hint is None else hint}
    except TypeError:
        # Annotations may carry what cannot be hashed.
        return set()


@lru_cache(maxsize=512)
def _adapter(hint: Any) -> TypeAdapter[Any]:
    try:
        return TypeAdapter(hint, config=_FINITE)
    except PydanticUserError as error:
        # Models, dataclasses and the like carry their own configuration.
        if error.code != "type-adapter-config-unused":
            raise
        return TypeAdapter(hint)


_FINITE = ConfigDict(allow_inf_nan=False)
