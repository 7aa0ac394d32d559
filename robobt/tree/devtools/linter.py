"""Finds code in a tree that is allowed but rarely intended."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from py_trees.behaviour import Behaviour
from py_trees.behaviours import ProbabilisticBehaviour
from py_trees.decorators import Repeat, Retry
from py_trees.decorators import Timeout as WallClockTimeout
from py_trees.timers import Timer as WallClockTimer

from robobt.tree.walk import node_path, preorder

FOR_EVER = 1_000_000
"""A count from which a limit is no bound: more than four hours at 60 Hz."""


@dataclass(frozen=True, slots=True)
class Finding:
    """Something in a tree that is worth a second look.

    Attributes:
        path: of the node.
        rule: that found it.
        message: what it is about.
    """

    path: str
    rule: str
    message: str

    def __str__(self) -> str:
        return f"{self.path}: {self.message} [{self.rule}]"


def lint_tree(root: Behaviour) -> list[Finding]:
    """Return what is worth a second look below ``root``, in the tree's order; the tree is not ticked.

    | rule | finds |
    | --- | --- |
    | ``unbounded`` | ``Repeat`` and ``Retry`` without a bound |
    | ``wall-clock`` | nodes of py_trees that read the wall clock instead of the frame's time |
    | ``global-random`` | a node that draws from the random numbers of the process |
    | ``shared-blackboard`` | nodes on the blackboard that all trees of the process share |
    """
    return [
        Finding(node_path(node), rule, message) for node in preorder(root) for rule, message in _faults(node)
    ]


def _faults(node: Behaviour) -> Iterator[tuple[str, str]]:
    """Yield the rule and the message of each fault of a node."""
    if isinstance(node, Repeat) and (node.num_success < 0 or node.num_success >= FOR_EVER):
        yield "unbounded", "repeats its child for ever"
    if isinstance(node, Retry) and node.num_failures < 0:
        yield (
            "unbounded",
            "is meant to try for ever, but fails with its child's first failure: Retry has no -1",
        )
    elif isinstance(node, Retry) and node.num_failures >= FOR_EVER:
        yield "unbounded", "tries its child again for ever"
    for kind, instead in ((WallClockTimer, "Wait"), (WallClockTimeout, "Timeout")):
        if isinstance(node, kind):
            yield (
                "wall-clock",
                f"goes by the wall clock, not the match's; take robobt.tree.nodes.{instead}",
            )
    if isinstance(node, ProbabilisticBehaviour):
        yield "global-random", "draws from the random numbers of the process, so no seed repeats it"
    if node.blackboards:
        yield (
            "shared-blackboard",
            "is on py_trees' blackboard, which all robots of the process share; take the store",
        )
