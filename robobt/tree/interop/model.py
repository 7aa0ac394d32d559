"""The content of a tree file, whichever language it is written in."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Literal, TypeAlias

from robobt.config.errors import ConfigError
from robobt.tree.parameters import Parameter


class TreeFileError(ConfigError):
    """The first error in a tree file, or in a file of substitution rules."""


@dataclass(frozen=True, slots=True)
class Entry:
    """An entry of the store, given to a leaf in place of a value.

    A leaf with a parameter of a type like ``float | Entry`` can be wired to any
    entry: it reads or writes ``getattr(self.store, entry.entry)``.
    """

    entry: str


@dataclass(frozen=True, slots=True)
class Name:
    """In the place of a value: the value of a parameter of the tree, or an entry of the store."""

    name: str


@dataclass(frozen=True, slots=True)
class Text:
    """A value whose type is known only where it is used, as attributes of XML are."""

    text: str


Value: TypeAlias = object
"""Plain data as JSON has it, in which any part may be a Name, an Entry or a Text."""


@dataclass(slots=True, kw_only=True)
class _Placed:
    """Something in a file."""

    line: int = field(default=0, compare=False)
    lines: dict[str, int] = field(default_factory=dict, compare=False)

    def line_of(self, parameter: str) -> int:
        """Return the line of a parameter."""
        return self.lines.get(parameter, self.line)


@dataclass(slots=True)
class Node(_Placed):
    """One node.

    ``name`` is None for the type's default; ``branches`` hold its children: a node, a list of nodes, or nodes
    by case, as the type's constructor takes them.
    """

    type: str
    name: str | None = None
    parameters: dict[str, Value] = field(default_factory=dict)
    branches: dict[str, Spec | list[Spec] | dict[str, Spec]] = field(default_factory=dict)

    def children(self) -> Iterator[Spec]:
        """Yield the children in their order."""
        for branch in self.branches.values():
            if isinstance(branch, list):
                yield from branch
            elif isinstance(branch, dict):
                yield from branch.values()
            else:
                yield branch


@dataclass(slots=True)
class SubTree(_Placed):
    """In the place of a node: another tree of the file, or a play.

    With ``autoremap``, names that it is not given are looked up outside of it; ``label`` names the place it
    is put in and is only kept.
    """

    tree: str
    parameters: dict[str, Value] = field(default_factory=dict)
    autoremap: bool = False
    label: str | None = None


Spec: TypeAlias = "Node | SubTree"
"""Elements allowed in place of a node."""


@dataclass(slots=True)
class Definition:
    """One tree of a file; ``source`` is the file that it stands in, where another one includes that."""

    name: str
    root: Spec
    parameters: dict[str, Parameter] = field(default_factory=dict)
    description: str = ""
    line: int = field(default=0, compare=False)
    source: str | None = field(default=None, compare=False)


@dataclass(slots=True)
class TreeFile:
    """The trees of a file.

    ``main`` is the tree that is meant when none is named, ``source`` the file, for messages. In the
    ``language`` XML a name that is no parameter is an entry of the store.
    """

    source: str = field(compare=False)
    main: str
    trees: dict[str, Definition]
    language: Literal["yaml", "xml"]

    def source_of(self, tree: str) -> str:
        """Return the file in which a tree stands."""
        return self.trees[tree].source or self.source


def specs_of(spec: Spec) -> Iterator[Spec]:
    """Yield a node or subtree, and all below it."""
    yield spec
    for child in spec.children() if isinstance(spec, Node) else ():
        yield from specs_of(child)


def parts_of(value: Value) -> Iterator[Value]:
    """Yield what a value is made of: itself, or the parts of a list or mapping, however deep."""
    if isinstance(value, list | dict):
        for part in value.values() if isinstance(value, dict) else value:
            yield from parts_of(part)
    else:
        yield value


def names_in(value: Value) -> Iterator[str]:
    """Yield the names that a value refers to."""
    return (part.name for part in parts_of(value) if isinstance(part, Name))
