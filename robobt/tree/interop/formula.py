"""Arithmetic in tree files: numbers, names, ``+ - * /`` and brackets."""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Iterator, Mapping
from math import isfinite, nan
from typing import Any

MAX_LENGTH = 200
"""Longest formula that is read [characters]."""


def formula_names(text: str) -> list[str]:
    """The names in a formula.

    Raises:
        ValueError: it is no formula.
    """
    names: list[str] = []

    def note(name: str) -> float:
        names.append(name)
        return nan

    try:
        _Reader(text, note).read()
    except (ZeroDivisionError, OverflowError) as error:
        raise ValueError(f"{text!r} has no finite value") from error
    return names


def evaluate(text: str, values: Mapping[str, Any]) -> float:
    """The value of a formula; an int as long as all in it are ints and nothing is divided.

    Args:
        values: the numbers its names stand for.

    Raises:
        ValueError: it is no formula, a name is unknown or no number, or the value is not finite.
    """

    def number(name: str) -> float:
        value = values.get(name)
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise ValueError(f"{name} is no number here")
        return value

    try:
        value = _Reader(text, number).read()
        if isfinite(value):
            return value
    except (ZeroDivisionError, OverflowError):
        pass
    raise ValueError(f"{text!r} has no finite value")


class _Reader:
    """Reads a formula from left to right; a product binds closer than a sum."""

    def __init__(self, text: str, value_of: Callable[[str], float]) -> None:
        if len(text) > MAX_LENGTH:
            raise ValueError(f"a formula is at most {MAX_LENGTH} characters long")
        self.text, self.value_of = text, value_of
        self.tokens = self._split()
        self.token = next(self.tokens, "")

    def read(self) -> float:
        value = self._sum()
        if self.token:
            raise self._wrong()
        return value

    def _sum(self) -> float:
        return self._row(_SUMS, self._product)

    def _product(self) -> float:
        return self._row(_PRODUCTS, self._factor)

    def _row(self, operations: Mapping[str, _Operation], part: Callable[[], float]) -> float:
        value = part()
        while self.token in operations:
            value = operations[self._next()](value, part())
        return value

    def _factor(self) -> float:
        token = self._next()
        if token == "-":
            return -self._factor()
        if token == "(":
            value = self._sum()
            if self._next() != ")":
                raise self._wrong()
            return value
        if token[:1].isdigit():
            return int(token) if token.isdecimal() else float(token)
        if token.isidentifier():
            return self.value_of(token)
        raise self._wrong()

    def _next(self) -> str:
        token, self.token = self.token, next(self.tokens, "")
        return token

    def _split(self) -> Iterator[str]:
        position = 0
        while match := _TOKEN.match(self.text, position):
            position = match.end()
            yield match[1]
        if self.text[position:].strip():
            raise self._wrong()

    def _wrong(self) -> ValueError:
        return ValueError(f"{self.text!r} is no formula of numbers, names, + - * / and brackets")


_Operation = Callable[[float, float], float]
_SUMS: Mapping[str, _Operation] = {"+": operator.add, "-": operator.sub}
_PRODUCTS: Mapping[str, _Operation] = {"*": operator.mul, "/": operator.truediv}
_TOKEN = re.compile(r"\s*([0-9]+(?:\.[0-9]*)?(?:[eE][-+]?[0-9]+)?|[^\W\d]\w*|[-+*/()])")
