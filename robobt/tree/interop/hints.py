"""The types of a tree file's own parameters, as words."""

from __future__ import annotations

from collections.abc import Mapping
from functools import reduce
from operator import or_
from typing import Any

from robobt.tree.parameters import say_hint

_TYPE_WORDS: dict[str, Any] = {
    "bool": bool,
    "int": int,
    "float": float,
    "str": str,
    "point": tuple[float, float],
    "none": type(None),
}


def hint_of(words: str, more: Mapping[str, Any]) -> Any:
    """Return the type that words such as ``float | none`` stand for, ``more`` of them known besides ours."""
    known = {**_TYPE_WORDS, **more}
    members = [word.strip() for word in words.split("|")]
    for word in members:
        if word not in known:
            raise ValueError(f"{word!r} is not a type of a parameter; there are {', '.join(known)}")
    return reduce(or_, [known[word] for word in members])


def words_of_default(default: object) -> str:
    """Return the words for the type of a default."""
    for word in ("bool", "int", "float", "str"):
        if type(default) is _TYPE_WORDS[word]:
            return word
    if isinstance(default, list) and len(default) == 2 and {type(part) for part in default} <= {int, float}:
        return "point"
    raise ValueError("its type does not follow from its default; write {type: ..., default: ...}")


def words_of(hint: object) -> str:
    """Return the words for a type, as :func:`hint_of` reads them."""
    return say_hint(hint).replace("tuple[float, float]", "point")
