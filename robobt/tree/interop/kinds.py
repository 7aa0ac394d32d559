"""The types of a tree file's own parameters, as YAML writes them."""

from __future__ import annotations

from functools import reduce
from operator import or_
from typing import Any, Literal, get_args, get_origin

from robobt.tree.parameters import say_hint

_WORDS: dict[str, Any] = {
    "bool": bool,
    "int": int,
    "float": float,
    "str": str,
    "point": tuple[float, float],
    "none": type(None),
}


def hint_of(kind: str) -> Any:
    """The type that words such as ``float | none`` or ``'left' | 'right'`` mean.

    Raises:
        ValueError: a word is unknown.
    """
    members: list[Any] = []
    quoted: list[str] = []
    for word in (part.strip() for part in kind.split("|")):
        if len(word) > 2 and word[0] == word[-1] == "'":
            quoted.append(word[1:-1])
        elif word in _WORDS:
            members.append(_WORDS[word])
        else:
            raise ValueError(f"{word!r} is no type of a parameter; there are {', '.join(_WORDS)}")
    if quoted:
        members.insert(0, Literal[tuple(quoted)])
    return reduce(or_, members)


def kind_of(default: Any) -> str:
    """The words for the type that a default has.

    Raises:
        ValueError: it does not tell.
    """
    for word in ("bool", "int", "float", "str"):
        if type(default) is _WORDS[word]:
            return word
    if isinstance(default, list) and len(default) == 2 and {type(part) for part in default} <= {int, float}:
        return "point"
    raise ValueError("its type does not follow from its default; write {type: ..., default: ...}")


def choices_hint(choices: list[str]) -> Any:
    """The type of one of several words."""
    return Literal[tuple(choices)]


def choices_of(hint: Any) -> list[str] | None:
    """The words of such a type, None when it is another."""
    return list(get_args(hint)) if get_origin(hint) is Literal else None


def say_kind(hint: Any) -> str:
    """The words for a type, as :func:`hint_of` reads them."""
    return say_hint(hint).replace("tuple[float, float]", "point")
