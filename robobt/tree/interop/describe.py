"""Describes a tree as the content of a tree file."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from robobt.tree.interop.model import Definition, Node, TreeFile
from robobt.tree.interop.node_types import NodeType
from robobt.tree.interop.vocabulary import Vocabulary
from robobt.tree.parameters import ParameterError
from robobt.tree.walk import node_path


def describe_tree(root: Behaviour, vocabulary: Vocabulary, name: str) -> TreeFile:
    """Return a file that builds this tree; the nodes' parameters at their defaults are left out.

    Raises:
        ValueError: files cannot say it; the message names the node's path.
    """
    return TreeFile(name, name, {name: Definition(name, _describe(root, vocabulary))}, "yaml")


def _describe(node: Behaviour, vocabulary: Vocabulary) -> Node:
    kind = _type_of(node, vocabulary)
    described = Node(kind.name, _name(node, kind))
    try:
        arguments = kind.arguments(node)
    except (AttributeError, ValueError) as error:
        raise ValueError(f"{node_path(node)}: {error}") from error
    for name, value in arguments.items():
        parameter = kind.parameters[name]
        if parameter.required or not _is_default(value, parameter.default):
            try:
                described.parameters[name] = parameter.plain(value)
            except ParameterError as error:
                raise ValueError(f"{node_path(node)}: {error.parameter}: {error}") from error
    for name, shape in kind.branches.items():
        if shape == "many":
            described.branches[name] = [_describe(child, vocabulary) for child in node.children]
        elif shape == "cases":
            described.branches[name] = {
                " | ".join(cases): _describe(child, vocabulary)
                for cases, child in _by_child(getattr(node, name)).values()
            }
        else:
            child = node.children[0] if shape == "one" else getattr(node, name)
            if child is not None:
                described.branches[name] = _describe(child, vocabulary)
    return described


def _type_of(node: Behaviour, vocabulary: Vocabulary) -> NodeType:
    kind = vocabulary.type_of(node)
    if kind is None:
        raise ValueError(
            f"{node_path(node)}: files cannot name a {type(node).__name__}; it is not registered"
        )
    return kind


def _name(node: Behaviour, kind: NodeType) -> str | None:
    if not node.name.strip() or not node.name.isprintable():
        raise ValueError(f"{node_path(node)!r}: files hold names that are printable and on one line")
    return None if kind.leaf and node.name == kind.cls.__name__ else node.name


def _is_default(value: object, default: object) -> bool:
    return value is default or (type(value) is type(default) and bool(value == default))


def _by_child(cases: dict[str, Behaviour]) -> dict[int, tuple[list[str], Behaviour]]:
    """Group the cases that share a child, in the order of their first."""
    shared: dict[int, tuple[list[str], Behaviour]] = {}
    for case, child in cases.items():
        shared.setdefault(id(child), ([], child))[0].append(case)
    return shared
