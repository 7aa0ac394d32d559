"""The children that a tick of a node reaches, for reading statuses afterwards."""

from __future__ import annotations

from py_trees.behaviour import Behaviour

from robobt.tree.engine.dispatch import AS_IT_IS, Reach, known_as


def ticked_children(node: Behaviour) -> Reach:
    """Return which children a tick of this node reaches, among those with a status afterwards.

    "all": all of them. "first": those up to the first that succeeded or runs. "some":
    their statuses do not tell, for a child may keep that of an earlier tick, or one
    with a way of its own may show another than it had when its parent looked.
    """
    if any(known_as(child) is AS_IT_IS for child in node.children):
        return "some"
    return known_as(node).reach(node)
