"""Which children a tick of a node reaches, for those who read statuses after it."""

from __future__ import annotations

from typing import Literal

from py_trees.behaviour import Behaviour

from robobt.tree.engine.composites import selector_closures, sequence_closures
from robobt.tree.engine.dispatch import AS_IT_IS, known_as
from robobt.tree.engine.leaves import decorator_closures


def ticked_children(node: Behaviour) -> Literal["all", "first", "some"]:
    """Return which children a tick of this node reaches, as far as they have a status after it.

    "all": all of them. "first": those up to the first that succeeded or runs. "some":
    their statuses do not tell, for a child may keep that of an earlier tick, or one
    with a way of its own may show another than it had when its parent looked.
    """
    make = known_as(node).make
    if any(known_as(child) is AS_IT_IS for child in node.children):
        return "some"
    if make is decorator_closures or (make is sequence_closures and not node.memory):  # type: ignore[attr-defined]
        return "all"
    if make is selector_closures and not node.memory:  # type: ignore[attr-defined]
        return "first"
    return "some"
