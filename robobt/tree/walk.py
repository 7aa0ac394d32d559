"""Walks over the nodes of a tree; they end even if a skill has broken the tree."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TypeGuard

from py_trees.behaviour import Behaviour
from py_trees.decorators import Decorator

from robobt.config.errors import short_repr, text_of

MAX_TREE_DEPTH = 200
"""Nodes from the root of a tree down; Python itself takes some hundreds."""


def node_path(node: Behaviour) -> str:
    """Return the names from the root to the node, joined by slashes."""
    names: list[str] = []
    seen: set[int] = set()
    above: object = node
    while _is_node(above) and id(above) not in seen:
        seen.add(id(above))
        names.append(name_of(above))
        above = getattr(above, "parent", None)
    return "/".join(reversed(names))


def name_of(node: Behaviour) -> str:
    """Return the node's name, or a description of the error that reading it raised."""
    return text_of(node, lambda one: str(getattr(one, "name", type(one).__name__)))


def preorder(root: Behaviour) -> list[Behaviour]:
    """Return every node below and including ``root`` once, parents before children."""
    nodes, left, seen = [], [root], set()
    while left:
        node = left.pop()
        if id(node) not in seen:
            seen.add(id(node))
            nodes.append(node)
            left += reversed(_nodes_below(node))
    return nodes


def postorder(root: Behaviour) -> list[Behaviour]:
    """Return every node below and including ``root`` once, children before parents."""
    nodes, seen = [], {id(root)}
    way = [(root, iter(_nodes_below(root)))]
    while way:
        below = way[-1][1]
        child = next((each for each in below if id(each) not in seen), None)
        if child is None:
            nodes.append(way.pop()[0])
        else:
            seen.add(id(child))
            way.append((child, iter(_nodes_below(child))))
    return nodes


def fault_of(root: Behaviour, shared: bool = False) -> tuple[Behaviour, str] | None:
    """Return a node and what keeps the nodes below ``root`` from being a tree; None for a tree.

    A node in two places is no fault where ``shared`` says so.
    """
    parents: dict[int, Behaviour | None] = {id(root): None}
    way: list[tuple[Behaviour, Iterator[object]]] = [(root, iter(_children_of(root)))]
    above = {id(root)}
    while way:
        node, below = way[-1]
        child = next(below, way)
        if child is way:
            above.discard(id(way.pop()[0]))
        elif not _is_node(child):
            return node, f"one of its children is no node: {short_repr(child)}"
        elif id(child) in above:
            return child, "is its own descendant"
        elif id(child) in parents:
            if shared:
                continue
            one = parents[id(child)]
            where = "twice" if one is node or one is None else f"of {node_path(one)!r} and"
            return child, f"is a child {where} of {node_path(node)!r}; make a node for each place"
        elif len(way) == MAX_TREE_DEPTH:
            return root, f"a tree may be {MAX_TREE_DEPTH} nodes deep, and this one is deeper"
        else:
            parents[id(child)] = node
            above.add(id(child))
            way.append((child, iter(_children_of(child))))
    return None


def _children_of(node: Behaviour) -> list[object]:
    found = getattr(node, "children", ())
    children: list[object] = list(found) if isinstance(found, list | tuple) else [found]
    # What a decorator ticks; its list of children says the same until somebody changes one of them.
    if Decorator in type(node).__mro__ and hasattr(node, "decorated"):
        children += [] if any(child is node.decorated for child in children) else [node.decorated]
    return children


def _nodes_below(node: Behaviour) -> list[Behaviour]:
    return [child for child in _children_of(node) if _is_node(child)]


def _is_node(thing: object) -> TypeGuard[Behaviour]:
    # py_trees' classes are abstract, and isinstance takes several times as long for those.
    return Behaviour in type(thing).__mro__
