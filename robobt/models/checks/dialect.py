"""Torch's dialect of Python: the classes and functions of an archive, and its types, names and literals."""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass, field

from robobt.models.file import ModelError

_TAKEN_NAMES = """
CONSTANTS Dict Final List Module NamedTuple NoneType Optional Tensor Tuple __torch__ annotate bool float
getattr inf int nan ops range str torch unchecked_cast uninitialized
"""

TAKEN = frozenset(_TAKEN_NAMES.split())
"""Names that have a meaning of their own."""

_NAME_PATTERN = re.compile(r"(?!__)\w+")
_PLAIN_TYPES = frozenset({"Tensor", "int", "float", "bool", "str", "NoneType"})
_GENERIC_TYPES = frozenset({"Optional", "List", "Tuple", "Dict"})


@dataclass
class Class:
    """A class of the archive.

    Attributes:
        module: whether it is a module rather than a named tuple.
        attributes: types by the attributes' names, without constants.
        methods: its methods by name.
    """

    module: bool
    attributes: dict[str, ast.expr] = field(default_factory=dict)
    methods: dict[str, ast.FunctionDef] = field(default_factory=dict)


@dataclass
class ArchiveCode:
    """The code of an archive.

    Attributes:
        texts: what torch is to read, by the members' names.
        classes: its classes by their qualified names.
        functions: its functions by their qualified names.
        constants: how many entries of the table of constants it needs.
    """

    texts: dict[str, bytes] = field(default_factory=dict)
    classes: dict[str, Class] = field(default_factory=dict)
    functions: dict[str, ast.FunctionDef] = field(default_factory=dict)
    constants: int = 0


def check_type(kind: ast.expr, sources: ArchiveCode) -> None:
    """Check that an expression is a type that networks use."""
    match kind:
        case ast.Name(id=name) if name in _PLAIN_TYPES:
            return
        case ast.Subscript(ast.Name(id=name), inner) if name in _GENERIC_TYPES:
            for one in inner.elts if isinstance(inner, ast.Tuple) else [inner]:
                check_type(one, sources)
            return
        case ast.Attribute() if dotted(kind) in sources.classes:
            return
    raise refusal(kind)


def dotted(value: ast.expr) -> str | None:
    """Return a name with dots in it; None for any other expression."""
    parts: list[str] = []
    while isinstance(value, ast.Attribute):
        parts.append(value.attr)
        value = value.value
    return ".".join([value.id, *reversed(parts)]) if isinstance(value, ast.Name) else None


def is_text(value: ast.expr) -> bool:
    """Return whether an expression is a text."""
    return isinstance(value, ast.Constant) and isinstance(value.value, str)


def is_literal(value: ast.expr) -> bool:
    """Return whether an expression is a number, a text, a truth value, None, or a list of them."""
    match value:
        case ast.Constant(bool() | float() | str() | None):
            return True
        case ast.Constant(int(number)):
            return number < 2**63
        case ast.UnaryOp(ast.USub(), ast.Constant(int() | float()) as inner):
            return is_literal(inner)
        case ast.Name(id="inf" | "nan") | ast.UnaryOp(ast.USub(), ast.Name(id="inf" | "nan")):
            return True
        case ast.List(elts=parts) | ast.Tuple(elts=parts):
            return all(is_literal(part) for part in parts)
    return False


def plain(name: str) -> str:
    """Return a function's or class's name, unless Python or torch would call it by itself."""
    if not _NAME_PATTERN.fullmatch(name):
        raise ModelError(f"has a function {name} in it, which would run while it is loaded")
    return name


def check_variable(name: str) -> None:
    """Check that a name may be given a value."""
    if name in TAKEN or name.startswith("__"):
        raise ModelError(f"gives {name} a second meaning")


def refusal(node: ast.AST) -> ModelError:
    """Return an error that quotes code."""
    text = next(iter(ast.unparse(node).splitlines()), type(node).__name__)
    return ModelError(f"has code in it that no network needs: {text[:80]}")
