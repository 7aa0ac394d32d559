"""Changes that skills make to their stores, as plain data."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import is_dataclass
from enum import Enum
from itertools import compress, count
from math import isfinite
from operator import ne
from typing import TypeAlias, get_args, get_type_hints

from pydantic import JsonValue

from robobt.config.errors import text_of
from robobt.skills.store import GIVEN, Store
from robobt.tree import TreeRunner
from robobt.tree.engine import LEAVING
from robobt.tree.recording import make_reader
from robobt.world.state import Frame, RobotId

_LONGEST_STORED_TEXT = 200
_MOST_ITEMS = 100
_DEEPEST_STORED = 6
_CHANGEABLE = frozenset((list, set, dict))


Written: TypeAlias = tuple[int, object]
"""An entry's place, and its value."""


class StoreWatch:
    """Finds the changes in stores since the last check.

    A check is quick enough for every tick; :class:`StoreChanges` converts the changes to plain data. Changes
    in place are noticed in lists, sets and mappings.

    Args:
        stores: by name, each store with the names of the entries to watch; a missing entry counts as None.

    Attributes:
        entries: the names of store and entry at each place.
    """

    def __init__(self, stores: Mapping[str, tuple[object, Sequence[str]]]) -> None:
        self.entries = [(name, entry) for name, (_, entries) in stores.items() for entry in entries]
        self._stores = [stores[name][0] for name, _ in self.entries]
        items = [f"'{place}'.{entry}," for place, (_, entry) in enumerate(self.entries)]
        self._read = make_reader(f"[{''.join(items)}]", self._stores)
        # Values at the last check, copied where they can be changed in place.
        self._before: list[object] = [None] * len(self.entries)

    def look(self) -> list[Written]:
        """Return the entries that have changed since the last check."""
        before = self._before
        try:
            # Compare all at once first, because usually nothing has changed.
            values = self._read()
            if values == before:
                return []
            places = [*compress(count(), map(ne, values, before))]
        except Exception:
            # An entry is missing, or values such as arrays do not compare to a boolean.
            pairs = zip(self._stores, self.entries, strict=True)
            values = [getattr(store, entry, None) for store, (_, entry) in pairs]
            places = [place for place in range(len(values)) if _differ(values[place], before[place])]
        for place in places:
            value = values[place]
            before[place] = value.copy() if type(value) in _CHANGEABLE else value
        return [(place, before[place]) for place in places]


def _differ(now: object, before: object) -> bool:
    try:
        return bool(now != before)
    except Exception:
        return True


class StoreChanges:
    """Converts what a :class:`StoreWatch` finds to plain data, at any later time but in order."""

    def __init__(self, watch: StoreWatch) -> None:
        self._entries = watch.entries
        self._plain: list[JsonValue] = [None] * len(self._entries)

    def plain(self, written: list[Written]) -> dict[str, dict[str, JsonValue]]:
        """Return the new values in ``written``, by store and entry."""
        changed: dict[str, dict[str, JsonValue]] = {}
        for place, value in written:
            now = plain(value)
            if now != self._plain[place]:
                name, entry = self._entries[place]
                self._plain[place] = changed.setdefault(name, {})[entry] = now
        return changed


def stores_of(runners: Mapping[RobotId, TreeRunner], stores: Mapping[RobotId, Store]) -> StoreWatch:
    """Watch the robots' stores, named "blue 3", and the teams' shared stores, "blue" and "yellow".

    In a robot's store the entries that its nodes declare under ``writes`` are watched; in a team's store all
    but frames, which a recording has anyway.
    """
    watched: dict[str, tuple[object, Sequence[str]]] = {}
    for robot, store in stores.items():
        if robot in runners:
            written = [entry for node in runners[robot].nodes for entry in getattr(node, "writes", ())]
            watched[str(robot)] = (store, [entry for entry in dict.fromkeys(written) if entry not in GIVEN])
        shared = get_type_hints(type(store.team))
        entries = [name for name, hint in shared.items() if Frame not in (hint, *get_args(hint))]
        watched[robot.team.value] = (store.team, entries)
    return StoreWatch(watched)


def plain(value: object, depth: int = 0) -> JsonValue:
    """Return a value as JSON can hold it: floats to six digits, dataclasses as objects, the rest as text."""
    kind = type(value)
    if kind is float:
        return float(f"{value:.6g}") if isfinite(value) else None  # type: ignore[arg-type]
    if value is None or kind is bool or kind is int:
        return value  # type: ignore[return-value]
    try:
        return _plain(value, depth)
    except LEAVING:
        raise
    except BaseException:
        return f"a {kind.__name__}"


def _plain(value: object, depth: int) -> JsonValue:
    if isinstance(value, Enum):
        return plain(value.value, depth)
    if isinstance(value, str):
        return value if len(value) <= _LONGEST_STORED_TEXT else value[: _LONGEST_STORED_TEXT - 3] + "..."
    if depth >= _DEEPEST_STORED:
        return "..."
    depth += 1
    if isinstance(value, list | tuple):
        return [plain(item, depth) for item in value[:_MOST_ITEMS]]
    if is_dataclass(value):
        return {name: plain(getattr(value, name), depth) for name in value.__dataclass_fields__}
    if isinstance(value, Mapping):
        return {text_of(key): plain(item, depth) for key, item in [*value.items()][:_MOST_ITEMS]}
    if isinstance(value, set | frozenset):
        # Sorted, so that the same match gives the same file.
        return sorted([plain(item, depth) for item in value], key=repr)[:_MOST_ITEMS]
    if hasattr(value, "tolist"):
        return plain(value.tolist(), depth)
    text = text_of(value)
    # A default repr contains an address, which differs between runs.
    return plain(f"a {type(value).__name__}" if " at 0x" in text else text)
