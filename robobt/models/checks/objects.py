"""What the pickles of a TorchScript archive hold, and whether it fits the code beside them."""

from __future__ import annotations

import ast
from dataclasses import dataclass

from robobt.models.checks.dialect import ArchiveCode, dotted
from robobt.models.checks.limits import DEEPEST_NESTING
from robobt.models.file import ModelError

MOST_VALUES = 100_000
"""A pickle with more operations or values than that is none of a network's."""


@dataclass(frozen=True)
class PickledName:
    """A class or function that the pickle names."""

    text: str


@dataclass(frozen=True)
class Storage:
    """A tensor's memory, with its length in items and their size [bytes]."""

    count: int
    item: int


@dataclass(frozen=True)
class Tensor:
    """A tensor with this many bytes."""

    size: int


@dataclass
class Object:
    """An instance of a class of the archive."""

    qualified: str
    attributes: dict[str, object] | None = None


def check_plain(value: object) -> None:
    """Check that nothing in a value is nested deep or in itself, and no number too large for torch."""
    level = [value]
    total = 0
    for _ in range(DEEPEST_NESTING):
        inner: list[object] = []
        for one in level:
            if isinstance(one, tuple | list):
                inner += one
            elif isinstance(one, dict):
                inner += one.values()
            elif isinstance(one, Object):
                inner += (one.attributes or {}).values()
            elif isinstance(one, int) and not -(2**63) <= one < 2**63:
                raise ModelError("holds a number of more than 64 bits")
            elif isinstance(one, PickledName | Storage):
                raise ModelError("holds what is no value of a network")
        total += len(inner)
        if total > MOST_VALUES:
            raise ModelError("holds more than a model does")
        level = inner
    if level:
        raise ModelError(f"is nested more than {DEEPEST_NESTING} deep")


def check_objects(value: object, sources: ArchiveCode) -> None:
    """Check that the objects in a value have the attributes that their classes in the code declare."""
    if isinstance(value, tuple | list):
        for one in value:
            check_objects(one, sources)
    elif isinstance(value, dict):
        for one in value.values():
            check_objects(one, sources)
    elif isinstance(value, Object):
        kind = sources.classes.get(value.qualified)
        given = value.attributes or {}
        if kind is None or not kind.module or set(given) != set(kind.attributes):
            raise ModelError(f"holds an object of {value.qualified[:80]} that its code does not describe")
        for name, declared in kind.attributes.items():
            if not _fits(given[name], declared):
                raise ModelError(f"holds another {name[:80]} than its code says")
        check_objects(given, sources)


def _fits(value: object, declared: ast.expr) -> bool:
    match declared:
        case ast.Name(id="Tensor"):
            return isinstance(value, Tensor)
        case ast.Name(id="NoneType"):
            return value is None
        case ast.Name(id="int" | "float" | "bool" | "str" as name):
            return type(value).__name__ == name
        case ast.Subscript(ast.Name(id="Optional"), inner):
            return value is None or _fits(value, inner)
        case ast.Subscript(ast.Name(id="List"), inner):
            return isinstance(value, list) and all(_fits(one, inner) for one in value)
        case ast.Subscript(ast.Name(id="Tuple"), inner):
            kinds = inner.elts if isinstance(inner, ast.Tuple) else [inner]
            if not isinstance(value, tuple) or len(value) != len(kinds):
                return False
            return all(_fits(one, kind) for one, kind in zip(value, kinds, strict=True))
        case ast.Subscript(ast.Name(id="Dict"), ast.Tuple(elts=[ast.Name(id="str"), inner])):
            return isinstance(value, dict) and all(_fits(one, inner) for one in value.values())
    return isinstance(value, Object) and value.qualified == dotted(declared)
