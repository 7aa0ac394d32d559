"""Checks, before the first tick, that what the nodes of a tree read is also written."""

from __future__ import annotations

import types
import typing
from collections.abc import Collection, Iterator, Mapping
from functools import lru_cache
from typing import Any

from py_trees.behaviour import Behaviour

from robobt.config.errors import RobobtError
from robobt.tree.leaf import Entries, Leaf
from robobt.tree.parameters import members_of
from robobt.tree.walk import fault_of, node_path, preorder


class WiringError(RobobtError, ValueError):
    """A tree whose nodes do not fit together.

    Attributes:
        problems: all of them, each with the node's path and the entry.
    """

    def __init__(self, problems: list[str]) -> None:
        super().__init__("; ".join(problems))
        self.problems = tuple(problems)


def check_tree(root: Behaviour, store: type, given: Collection[str] = ()) -> None:
    """Check the store entries that the nodes below ``root`` declare to read and write.

    * Each is an entry of the store: an attribute that its class annotates or defines.
    * If a node names the entry's type, that type fits: a written value may be stored there, and a stored
      value, None aside, may be read.
    * An entry that a leaf needs (:meth:`~robobt.tree.leaf.Leaf.needs`) is written by a node that does not
      need it itself, or is given. The order of ticks is not checked.

    Entries that are ``given`` are filled in from outside the tree. Nodes that form no tree, for example one
    node in two places, are also a fault.
    """
    if (fault := fault_of(root)) is not None:
        raise WiringError([f"{node_path(fault[0])}: {fault[1]}"])
    nodes = preorder(root)
    written = set(given)
    for node in nodes:
        written.update(set(_writes(node)) - {entry for any_of in _needs(node) for entry in any_of})
    problems = [problem for node in nodes for problem in _problems(node, store, written)]
    if problems:
        raise WiringError(problems)


def _problems(node: Behaviour, store: type, written: Collection[str]) -> Iterator[str]:
    entries = entries_of(store)
    path = node_path(node)
    for verb, declared in (("reads", _reads(node)), ("writes", _writes(node))):
        for entry, hint in declared.items():
            if entry not in entries:
                yield f"{path}: {verb} {entry!r}, but {store.__name__} has no such entry"
            elif hint is not None and not _fits(verb, hint, entries[entry]):
                yield (
                    f"{path}: {verb} {entry!r} as {_say(hint)}, "
                    f"but in {store.__name__} it is {_say(entries[entry])}"
                )
    for any_of in _needs(node):
        if not any(entry in written or entry not in entries for entry in any_of):
            names = " or ".join(repr(entry) for entry in any_of)
            yield f"{path}: reads {names}, but no other node of the tree writes it"


@lru_cache(maxsize=32)
def entries_of(store: type) -> Mapping[str, object]:
    """Return the entries of a store class and their types, :data:`typing.Any` for those without."""
    entries: dict[str, object] = {}
    for name, hint in typing.get_type_hints(store).items():
        if typing.get_origin(hint) is not typing.ClassVar:
            entries[name] = hint
    for name in set(dir(store)) - set(typing.get_type_hints(store)):
        member = getattr(store, name)
        if isinstance(member, property):
            entries[name] = typing.get_type_hints(member.fget).get("return", Any)
        elif not name.startswith("_") and not callable(member):
            entries[name] = Any
    return entries


def _reads(node: Behaviour) -> Mapping[str, object]:
    return _declared(getattr(node, "reads", ()))


def _writes(node: Behaviour) -> Mapping[str, object]:
    return _declared(getattr(node, "writes", ()))


def _declared(entries: Entries) -> Mapping[str, object]:
    return entries if isinstance(entries, Mapping) else dict.fromkeys(entries)


def _needs(node: Behaviour) -> list[tuple[str, ...]]:
    if isinstance(node, Leaf):
        return node.needs()
    return [(entry,) for entry in _reads(node)]


def _fits(verb: str, declared: object, kept: object) -> bool:
    if Any in (declared, kept):
        return True
    if verb == "reads":
        # An entry is None before it is written.
        source, target = members_of(kept) - {types.NoneType}, members_of(declared)
    else:
        source, target = members_of(declared), members_of(kept)
    return all(any(_is_a(one, other) for other in target) for one in source)


def _is_a(one: object, other: object) -> bool:
    if one == other:
        return True
    cls = typing.get_origin(one) or one
    if not isinstance(other, type) or not isinstance(cls, type):
        return False
    # An int is accepted as a float, as everywhere in Python's typing.
    return issubclass(cls, other) or (cls is int and other is float)


def _say(hint: object) -> str:
    return hint.__name__ if isinstance(hint, type) and not typing.get_args(hint) else str(hint)
