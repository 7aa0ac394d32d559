"""Divisions that torch would carry out while it reads code, before its graph can be looked at."""

from __future__ import annotations

import ast
from collections.abc import Callable

from robobt.models.checks.dialect import dotted
from robobt.models.checks.operations import ABOUT_TENSORS, MAKE_TENSORS
from robobt.models.file import ModelError

FOLDED = frozenset({"floordiv", "remainder"})
"""Torch carries these out where it knows both numbers; the processor traps at a division by 0, or by -1."""


class Divisions:
    """Knows which names of a function stand for tensors, and which for what a module's attributes hold."""

    def __init__(self, declared: Callable[[ast.expr, str], ast.expr | None]) -> None:
        """Take a function that returns the type of a module's attribute."""
        self._declared = declared
        self._tensors: set[str] = set()
        self._attributes: set[str] = set()

    def bind(self, name: str, value: ast.expr | None) -> None:
        """Note that a name is given a value; torch lets none change its type."""
        tensor = value is not None and self._is_tensor(value)
        attribute = value is not None and self._is_attribute(value)
        (self._tensors.add if tensor else self._tensors.discard)(name)
        (self._attributes.add if attribute else self._attributes.discard)(name)

    def bind_parameter(self, name: str, kind: ast.expr) -> None:
        """Note the type of a function's parameter."""
        if dotted(kind) == "Tensor":
            self._tensors.add(name)

    def check(self, call: ast.Call) -> None:
        """Refuse a division of numbers by what may be 0 or -1.

        Divisors that a module's attributes hold are known, and seen to, once it is loaded.
        """
        match call.args:
            case [_, ast.Constant(int() | float() as divisor)] if not call.keywords and divisor != 0:
                return
            case [_, ast.UnaryOp(ast.USub(), ast.Constant(int() | float() as divisor))] if (
                not call.keywords and divisor not in (0, 1)
            ):
                return
            case [number, divisor] if not call.keywords and (
                self._is_tensor(number) or self._is_tensor(divisor) or self._is_attribute(divisor)
            ):
                return
        raise ModelError(f"divides an integer by what may be 0 or -1: {ast.unparse(call)[:80]}")

    def _is_tensor(self, value: ast.expr) -> bool:
        """Return whether a value is surely a tensor, or several."""
        match value:
            case ast.Name(id=name):
                return name in self._tensors
            case ast.Attribute(ast.Name(id="CONSTANTS")):
                return True
            case ast.Attribute(owner, attribute):
                kind = self._declared(owner, attribute)
                return kind is not None and dotted(kind) == "Tensor"
            case ast.Call(ast.Name(id="annotate" | "unchecked_cast"), [kind, _]):
                return dotted(kind) == "Tensor"
            case ast.Call(ast.Attribute(ast.Name(id="torch"), operation), args):
                return operation in MAKE_TENSORS or (
                    operation not in ABOUT_TENSORS and any(self._is_tensor(one) for one in args)
                )
        return False

    def _is_attribute(self, value: ast.expr) -> bool:
        match value:
            case ast.Name(id=name):
                return name in self._attributes
            case ast.Attribute(owner, attribute):
                return self._declared(owner, attribute) is not None
        return False
