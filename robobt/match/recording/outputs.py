"""What skills have written into a store, as data a file can hold, only when it changed."""

from __future__ import annotations

import json.encoder
from collections.abc import Callable, Iterable, Mapping
from collections.abc import Sequence as SequenceOf
from dataclasses import fields, is_dataclass
from enum import Enum
from functools import lru_cache
from itertools import compress, count
from math import isfinite
from operator import ne
from types import FunctionType
from typing import Any, TypeAlias, get_args, get_type_hints

from robobt.skills.store import GIVEN, TeamStore
from robobt.tree import Behaviour
from robobt.tree.runner import text_of
from robobt.world.state import Frame

Values: TypeAlias = tuple[Any, ...]

Written: TypeAlias = tuple[int, Values, Values]
"""A store by its place, what its entries held before and what they hold."""

quote = json.encoder.encode_basestring_ascii
_LONGEST_TEXT = 200
_MOST_ITEMS = 100
_DEEPEST = 6


def written_entries(nodes: Iterable[Behaviour]) -> list[str]:
    """The entries of the store that the nodes say they write, without those that are given anew."""
    written = dict.fromkeys(entry for node in nodes for entry in getattr(node, "writes", ()))
    return [entry for entry in written if entry not in GIVEN]


def team_entries(team: type = TeamStore) -> tuple[str, ...]:
    """What of a team's store is recorded: all of it but frames, which the recording has anyway."""
    return tuple(
        [name for name, hint in get_type_hints(team).items() if Frame not in (hint, *get_args(hint))]
    )


class OutputWatch:
    """What has changed in some entries of some stores since they were looked at last.

    As with :class:`~robobt.tree.recording.TreeWatch`, :meth:`look` is quick and its answers are
    told later, in the same order. A value that is changed in place is noticed in lists, sets
    and mappings.

    Args:
        entries: by a name for each store the store and the names of its entries; an entry that
            is missing counts as None.
    """

    def __init__(self, entries: Mapping[str, tuple[object, SequenceOf[str]]]) -> None:
        self._entries = [(name, store, tuple(some)) for name, (store, some) in entries.items() if some]
        self._ask = self._asker()
        self._values: list[Values] = [(None,) * len(some) for _, _, some in self._entries]
        self._told = [["null"] * len(some) for _, _, some in self._entries]

    def look(self) -> list[Written] | None:
        """The stores of which a value is not what it was at the last look, None without any."""
        before = self._values
        try:
            values = self._ask()
            if values == before:
                return None
            places = [*compress(count(), map(ne, values, before))]
        except Exception:
            # An entry that is not there, or values that do not compare to a truth, as arrays.
            values = self._ask_slowly()
            places = [place for place, now in enumerate(values) if not _same(now, before[place])]
        written: list[Written] = []
        for place in places:
            now = values[place]
            if not _COPIED.isdisjoint(map(type, now)):
                now = _kept(now, before[place])
            written.append((place, before[place], now))
            before[place] = now
        return written

    def tell(self, written: list[Written]) -> str:
        """What changed since what was told before: a JSON object by store and entry, "" if nothing."""
        changed: list[str] = []
        for place, before, now in written:
            name, _, entries = self._entries[place]
            told, parts = self._told[place], []
            for i, value in enumerate(now):
                if value is before[i]:
                    continue
                text = value_text(value)
                if text != told[i]:
                    told[i] = text
                    parts.append(f"{quote(entries[i])}:{text}")
            if parts:
                changed.append(f"{quote(name)}:{{{','.join(parts)}}}")
        return f"{{{','.join(changed)}}}" if changed else ""

    def _asker(self) -> Callable[[], list[Values]]:
        """A function that gets all values, with a place in its code for each, as in TreeWatch."""
        if not all(entry.isidentifier() for _, _, some in self._entries for entry in some):
            return self._ask_slowly
        stores = [
            "(" + "".join([f"'{place}'.{entry}," for entry in some]) + ")"
            for place, (_, _, some) in enumerate(self._entries)
        ]
        made: FunctionType = eval(f"lambda:[{','.join(stores)}]")
        named = {f"{place}": store for place, (_, store, _) in enumerate(self._entries)}
        constants = tuple([named.get(item, item) for item in made.__code__.co_consts])
        return FunctionType(made.__code__.replace(co_consts=constants), {})

    def _ask_slowly(self) -> list[Values]:
        return [tuple([getattr(store, entry, None) for entry in some]) for _, store, some in self._entries]


_COPIED = frozenset((list, set, dict))


def _kept(now: Values, before: Values) -> Values:
    """The values with copies of those that may be changed in place."""
    return tuple(
        [
            item if item.__class__ not in _COPIED else old if _same(item, old) else item.copy()
            for item, old in zip(now, before, strict=True)
        ]
    )


def _same(one: object, other: object) -> bool:
    try:
        return bool(one == other)
    except Exception:
        return False


def value_text(value: object, depth: int = 0) -> str:
    """A value as JSON: numbers to six digits, dataclasses as objects, what JSON has not as a short text."""
    kind = value.__class__
    if kind is float:
        return f"{value:.6g}" if isfinite(value) else "null"  # type: ignore[arg-type]
    if value is None:
        return "null"
    try:
        names = _fields_of(kind)  # type: ignore[arg-type]
        if names is not None and depth < _DEEPEST:
            parts = [f'"{name}":{value_text(getattr(value, name), depth + 1)}' for name in names]
            return "{" + ",".join(parts) + "}"
        if kind is tuple and depth < _DEEPEST:
            return "[" + ",".join([value_text(item, depth + 1) for item in value[:_MOST_ITEMS]]) + "]"  # type: ignore[index]
        return _other_text(value, depth)
    except (Exception, SystemExit):
        return quote(f"a {kind.__name__}")


def _other_text(value: Any, depth: int) -> str:
    if depth >= _DEEPEST:
        return '"..."'
    if isinstance(value, Enum):
        return value_text(value.value, depth + 1)
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(int(value))
    if isinstance(value, float):
        return value_text(float(value))
    if isinstance(value, str):
        return quote(_short(str(value)))
    if isinstance(value, Mapping):
        items = list(value.items())[:_MOST_ITEMS]
        return (
            "{"
            + ",".join([f"{quote(text_of(key))}:{value_text(item, depth + 1)}" for key, item in items])
            + "}"
        )
    if isinstance(value, set | frozenset):
        return "[" + ",".join(sorted([value_text(item, depth + 1) for item in value])[:_MOST_ITEMS]) + "]"
    if isinstance(value, list | tuple):
        return "[" + ",".join([value_text(item, depth + 1) for item in value[:_MOST_ITEMS]]) + "]"
    if hasattr(value, "tolist"):
        return value_text(value.tolist(), depth + 1)
    text = text_of(value)
    # A default repr holds an address, which would differ from run to run.
    return quote(f"a {value.__class__.__name__}" if " at 0x" in text else _short(text))


@lru_cache(maxsize=256)
def _fields_of(kind: type) -> tuple[str, ...] | None:
    return tuple([entry.name for entry in fields(kind)]) if is_dataclass(kind) else None


def _short(text: str) -> str:
    return text if len(text) <= _LONGEST_TEXT else text[: _LONGEST_TEXT - 3] + "..."
