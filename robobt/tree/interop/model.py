"""What a tree file says, whichever language it is written in."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, Literal, TypeAlias

from robobt.config.errors import ConfigError
from robobt.tree.interop.formula import formula_names
from robobt.tree.parameters import Parameter


class TreeFileError(ConfigError):
    """A tree file, or a file of substitution rules, that cannot be used."""


@dataclass(frozen=True, slots=True)
class Entry:
    """An entry of the store, given to a leaf in the place of a value.

    A leaf with a parameter of a type like ``float | Entry`` can be wired to any
    entry: it reads or writes ``getattr(self.store, entry.entry)``.
    """

    entry: str


@dataclass(frozen=True, slots=True)
class Name:
    """In the place of a value: the value of a parameter of the tree, or an entry of the store."""

    name: str


@dataclass(frozen=True, slots=True)
class Formula:
    """In the place of a number: what numbers and parameters amount to."""

    text: str


@dataclass(frozen=True, slots=True)
class Text:
    """A value whose type is known only where it is used, as attributes of XML are."""

    text: str


@dataclass(slots=True)
class Choice:
    """One of several values or branches, chosen by the value of a parameter as the tree is built."""

    by: Value
    cases: dict[str, Any]
    line: int = field(default=0, compare=False)


Value: TypeAlias = Any
"""Plain data as JSON has it, in which any part may be a Name, a Formula, a Text or a Choice."""


@dataclass(slots=True)
class Node:
    """One node.

    Attributes:
        type: name of its type.
        name: its own name, None for the type's default.
        parameters: what its constructor is given.
        branches: its children: a node, a list of nodes, or nodes by case, as the
            type's constructor takes them.
        line: where it begins in the file.
        lines: where its parameters are.
    """

    type: str
    name: str | None = None
    parameters: dict[str, Value] = field(default_factory=dict)
    branches: dict[str, Spec | list[Spec] | dict[str, Spec]] = field(default_factory=dict)
    line: int = field(default=0, compare=False)
    lines: dict[str, int] = field(default_factory=dict, compare=False)

    def line_of(self, parameter: str) -> int:
        """Where a parameter is."""
        return self.lines.get(parameter, self.line)

    def children(self) -> Iterator[Spec]:
        """The children, in their order."""
        for branch in self.branches.values():
            if isinstance(branch, list):
                yield from branch
            elif isinstance(branch, dict):
                yield from branch.values()
            else:
                yield branch


@dataclass(slots=True)
class SubTree:
    """In the place of a node: another tree of the file, or a play.

    Attributes:
        tree: its name.
        parameters: what it is given.
        autoremap: whether names it is not given mean what they mean outside of it.
        label: name of the place it is put in; only kept.
        line, lines: as in :class:`Node`.
    """

    tree: str
    parameters: dict[str, Value] = field(default_factory=dict)
    autoremap: bool = False
    label: str | None = None
    line: int = field(default=0, compare=False)
    lines: dict[str, int] = field(default_factory=dict, compare=False)

    def line_of(self, parameter: str) -> int:
        """Where a parameter is."""
        return self.lines.get(parameter, self.line)


Spec: TypeAlias = "Node | SubTree | Choice"
"""What may stand in the place of a node."""


@dataclass(slots=True)
class Definition:
    """One tree of a file.

    Attributes:
        name: how sub-trees refer to it.
        root: its root.
        parameters: what it can be given.
        let: values computed from them, in this order.
        description: for people.
        line: where it begins.
    """

    name: str
    root: Spec
    parameters: dict[str, Parameter] = field(default_factory=dict)
    let: dict[str, Value] = field(default_factory=dict)
    description: str = ""
    line: int = field(default=0, compare=False)


@dataclass(slots=True)
class TreeFile:
    """The trees of a file.

    Attributes:
        source: the file, for messages.
        main: name of the tree that is meant when none is named.
        trees: all of them.
        language: in XML a name that is no parameter is an entry of the store.
    """

    source: str = field(compare=False)
    main: str
    trees: dict[str, Definition]
    language: Literal["yaml", "xml"]


def names_in(value: Value) -> Iterator[str]:
    """The names that a value refers to, those in formulas included."""
    if isinstance(value, Name):
        yield value.name
    elif isinstance(value, Formula):
        yield from formula_names(value.text)
    elif isinstance(value, Choice):
        yield from names_in(value.by)
        for case in value.cases.values():
            yield from names_in(case)
    elif isinstance(value, list):
        for part in value:
            yield from names_in(part)
    elif isinstance(value, dict):
        for part in value.values():
            yield from names_in(part)
