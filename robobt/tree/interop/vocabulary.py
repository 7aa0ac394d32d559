"""The nodes and values that a tree file may name, and the notation of values."""

from __future__ import annotations

import json
import typing
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, Protocol

from py_trees.behaviour import Behaviour

from robobt.config.errors import short_repr
from robobt.tree.interop.model import Entry, Value
from robobt.tree.interop.node_types import CONTROL, NodeType, node_type
from robobt.tree.parameters import Parameter, ParameterError, members_of


class Named(Protocol):
    """Things by name, as a :class:`~robobt.tree.registry.Registry` or a dict has them."""

    def __getitem__(self, name: str, /) -> Any: ...
    def __contains__(self, name: object, /) -> bool: ...
    def __iter__(self) -> Iterator[str]: ...


@dataclass
class Vocabulary:
    """The names that tree files may use.

    Control nodes are py_trees' and those of :mod:`robobt.tree.nodes`; they come
    before leaves of the same name.

    Attributes:
        leaves: classes of leaves.
        controls: classes of control nodes besides these.
        plays: functions that return a tree.
        words: types of a file's own parameters besides the common ones, by what the file calls them.
        store: the class of the store, to check entries against; None to leave them unchecked.
        place: a value as it is seen from the file's folder, where files name other files in values.
    """

    leaves: Named
    plays: Named = field(default_factory=dict[str, Any])
    controls: tuple[type[Behaviour], ...] = ()
    words: Mapping[str, Any] = field(default_factory=dict)
    store: type | None = None
    place: Callable[[Value, Path], Value] = lambda value, _: value
    _types: dict[object, NodeType] = field(default_factory=dict, repr=False)

    def __post_init__(self) -> None:
        own = {cls.__name__: node_type(cls) for cls in self.controls}
        self._control = {**CONTROL, **own}
        self._by_class = {known.cls: known for known in self._control.values()}

    def type(self, name: str) -> NodeType | None:
        """Return the type of this name, None when there is none.

        Raises:
            ValueError: the class cannot be used in files; the message says why.
        """
        known = self._control.get(name)
        if known is None and name in self.leaves:
            # By its class, because the meaning of a name may depend on the namespace.
            cls = self.leaves[name]
            known = self._types.get(cls)
            if known is None or known.name != name:
                known = self._types[cls] = node_type(cls, name)
        return known

    def type_of(self, node: Behaviour) -> NodeType | None:
        """Return the type of a node, None when no file can name it."""
        cls = type(node)
        if cls in self._by_class:
            return self._by_class[cls]
        for name in (cls.__name__, *self.leaves):
            if name in self.leaves and self.leaves[name] is cls:
                return self.type(name)
        return None

    def __iter__(self) -> Iterator[str]:
        return iter(sorted({*self._control, *self.leaves}))

    def convert(self, parameter: Parameter, value: object) -> object:
        """Convert plain data, or an entry, to a parameter's type."""
        if isinstance(value, Entry):
            if not takes_entry(parameter):
                raise ParameterError(
                    parameter.name, f"takes a value, and cannot be wired to the entry {value.entry!r}"
                )
            return value
        return parameter.convert(value)

    def from_text(self, parameter: Parameter, text: str) -> object:
        """Return the plain data of a text in BehaviorTree.CPP's notation.

        Tried in this order: the text itself; after ``json:``, JSON; JSON without
        that; ``true`` and ``false`` in any case, ``1`` and ``0`` for them; a list
        with semicolons, of texts and then of what they are in JSON.
        """
        first: ParameterError | None = None
        for value in _readings(text):
            try:
                self.convert(parameter, value)
                return value
            except ParameterError as error:
                first = first or error
                if self._is_refused(parameter, value):
                    raise
        raise ParameterError(parameter.name, f"{short_repr(text)} is not of type {parameter.kind}") from first

    def to_text(self, parameter: Parameter | None, value: object) -> str:
        """Return the text that :meth:`from_text` reads as this plain data."""
        exact = f"json:{json.dumps(value)}"
        if isinstance(value, list) and len(value) > 1 and all(type(part) in _SIMPLE for part in value):
            simple = ";".join([part if isinstance(part, str) else repr(part) for part in value])
        elif type(value) in (*_SIMPLE, bool):
            simple = value if isinstance(value, str) else json.dumps(value)
        else:
            return exact
        if is_pointer(simple) or simple.startswith("json:"):
            return exact
        if parameter is not None:
            try:
                return simple if _same(self.from_text(parameter, simple), value) else exact
            except ParameterError:
                return exact
        return simple

    def _is_refused(self, parameter: Parameter, value: object) -> bool:
        """Return whether a value is of the parameter's type and only its other constraints refuse it."""
        if typing.get_origin(parameter.hint) is not Annotated:
            return False
        try:
            self.convert(Parameter(parameter.name, typing.get_args(parameter.hint)[0]), value)
        except ParameterError:
            return False
        return True


def takes_entry(parameter: Parameter) -> bool:
    """Return whether a parameter may be wired to any entry of the store."""
    return Entry in members_of(parameter.hint)


def is_pointer(text: str) -> bool:
    """Return whether BehaviorTree.CPP takes a text for the name of an entry: ``{name}``."""
    return len(text) >= 3 and text.startswith("{") and text.endswith("}")


def _readings(text: str) -> Iterator[object]:
    if text.startswith("json:"):
        yield from _json(text.removeprefix("json:"))
        return
    yield text
    yield from _json(text)
    words = {"true": True, "false": False, "1": True, "0": False}
    if text.lower() in words:
        yield words[text.lower()]
    if ";" in text:
        parts = text.split(";")
        yield parts
        read = [list(_json(part)) for part in parts]
        if all(read):
            yield [part[0] for part in read]


_SIMPLE = (int, float, str)


def _same(one: object, other: object) -> bool:
    # 1 and 1.0 are the same number, but 1 and true are not the same value.
    return bool(one == other) and isinstance(one, bool) is isinstance(other, bool)


def _json(text: str) -> Iterator[object]:
    try:
        yield json.loads(text)
    except (ValueError, RecursionError):
        return
