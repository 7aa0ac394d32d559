"""Where two trees differ."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from robobt.tree.interop.node_types import Arguments, NodeType
from robobt.tree.interop.vocabulary import Vocabulary
from robobt.tree.walk import node_path


def tree_differences(one: Behaviour, other: Behaviour, vocabulary: Vocabulary) -> list[str]:
    """A line for each difference in types, names, parameters and children; none when equal."""
    path = node_path(one)
    if type(one) is not type(other) or one.name != other.name:
        return [f"{path}: {_say(one)} and {_say(other)}"]
    kind = vocabulary.type_of(one)
    assert kind is not None
    mine, theirs = kind.arguments(one), kind.arguments(other)

    def plain(given: Arguments, name: str) -> object:
        # A rater may be given as a mapping or made.
        return kind.parameters[name].plain(given[name])

    found = [
        f"{path}: {name} is {mine[name]!r} and {theirs[name]!r}"
        for name in mine
        if mine[name] != theirs[name] and plain(mine, name) != plain(theirs, name)
    ]
    if _cases(one, kind) != _cases(other, kind):
        found.append(f"{path}: the cases differ")
    if len(one.children) != len(other.children):
        found.append(f"{path}: {len(one.children)} children and {len(other.children)}")
    for child, its in zip(one.children, other.children, strict=False):
        found += tree_differences(child, its, vocabulary)
    return found


def _cases(node: Behaviour, kind: NodeType) -> list[tuple[str, int]]:
    """Which child serves which case."""
    return [
        (case, node.children.index(child))
        for name, shape in kind.branches.items()
        if shape == "cases"
        for case, child in getattr(node, name).items()
    ]


def _say(node: Behaviour) -> str:
    return f"{type(node).__name__} {node.name!r}"
