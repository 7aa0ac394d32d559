"""Finds what is allowed in a tree but seldom meant."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass

from py_trees.behaviour import Behaviour
from py_trees.behaviours import ProbabilisticBehaviour
from py_trees.common import Status
from py_trees.composites import Selector, Sequence
from py_trees.decorators import FailureIsRunning, Repeat, Retry
from py_trees.decorators import Timeout as WallClockTimeout
from py_trees.timers import Timer as WallClockTimer

from robobt.tree.devtools.possible_outcomes import outcomes, sets_any
from robobt.tree.nodes import TickDivider
from robobt.tree.runner import node_path, preorder

FOR_EVER = 1_000_000
"""So many times are no bound: at 60 Hz more than four hours."""


@dataclass(frozen=True, slots=True)
class Finding:
    """Something in a tree that is worth a second look.

    Attributes:
        path: of the node.
        rule: name of the rule that found it.
        message: what happens there, in a sentence.
    """

    path: str
    rule: str
    message: str

    def __str__(self) -> str:
        return f"{self.path}: {self.message} [{self.rule}]"


def lint_tree(root: Behaviour, per_tick: Collection[str] = ("command",)) -> list[Finding]:
    """What is worth a second look in a tree, in the tree's order.

    | rule | finds |
    | --- | --- |
    | ``forgotten-condition`` | a condition before an action under memory: it is not asked again |
    | ``two-actions`` | two children that may run under a sequence without memory |
    | ``unreachable`` | children behind one that always ends the selector or the sequence |
    | ``unbounded`` | ``Repeat``, ``Retry`` and ``FailureIsRunning``, which try without a bound |
    | ``divided-motion`` | a ``TickDivider`` around what moves the robot |
    | ``wall-clock`` | nodes of py_trees that ask the wall clock, not the frame's |
    | ``global-random`` | one that draws from the process's random numbers, not the robot's |
    | ``shared-blackboard`` | nodes on the blackboard that all trees of the process share |

    A condition is a node that may fail and of which no leaf ever runs or declares that it
    writes to the store; which statuses a leaf can come to, :func:`~robobt.tree.devtools.outcomes` says.

    Args:
        root: the tree, bound or not; it is not ticked.
        per_tick: entries of the store that hold for one tick only, as a command does.
    """
    findings = []
    for node in preorder(root):
        for rule, check in _RULES.items():
            for where, message in check(node):
                findings.append(Finding(node_path(where), rule, message))
        if isinstance(node, TickDivider) and node.every != 1:
            findings += [
                Finding(
                    node_path(leaf),
                    "divided-motion",
                    f"moves the robot, which stands still while {node.name!r} does not tick it",
                )
                for leaf in _leaves(node)
                if sets_any(leaf, per_tick)
            ]
    return findings


def _forgotten_conditions(node: Behaviour) -> Iterator[tuple[Behaviour, str]]:
    if not (isinstance(node, Sequence) and node.memory):
        return
    for place, child in enumerate(node.children):
        action = next((one for one in node.children[place + 1 :] if _may_run(one)), None)
        if action is not None and _is_condition(child):
            yield child, f"is not asked again while {action.name!r} runs: {node.name!r} has memory"


def _two_actions(node: Behaviour) -> Iterator[tuple[Behaviour, str]]:
    if not isinstance(node, Sequence) or node.memory:
        return
    running = [child for child in node.children if _may_run(child)]
    for other in running[1:]:
        yield other, f"is interrupted whenever {running[0].name!r} runs, which is ticked first at every tick"


def _unreachable(node: Behaviour) -> Iterator[tuple[Behaviour, str]]:
    if not isinstance(node, Sequence | Selector):
        return
    onward, never = (Status.SUCCESS, "succeeds") if isinstance(node, Sequence) else (Status.FAILURE, "fails")
    for child, later in zip(node.children, node.children[1:], strict=False):
        if onward not in outcomes(child):
            yield later, f"is never reached, nor is what follows: {child.name!r} never {never}"
            return


def _unbounded(node: Behaviour) -> Iterator[tuple[Behaviour, str]]:
    if isinstance(node, Repeat) and (node.num_success < 0 or node.num_success >= FOR_EVER):
        yield node, "repeats its child for ever"
    if isinstance(node, Retry):
        if node.num_failures < 0:
            yield node, "is meant to try for ever, but fails with its child's first failure: Retry has no -1"
        elif node.num_failures >= FOR_EVER:
            yield node, "tries its child again for ever"
    if isinstance(node, FailureIsRunning) and Status.FAILURE in outcomes(node.decorated):
        yield node, "tries its child again for ever"


def _wall_clock(node: Behaviour) -> Iterator[tuple[Behaviour, str]]:
    for kind, instead in ((WallClockTimer, "Wait"), (WallClockTimeout, "Timeout")):
        if isinstance(node, kind):
            yield node, f"goes by the wall clock, not the match's; take robobt.tree.nodes.{instead}"


def _global_random(node: Behaviour) -> Iterator[tuple[Behaviour, str]]:
    if isinstance(node, ProbabilisticBehaviour):
        yield node, "draws from the process's random numbers, so no seed repeats it; a skill has store.rng"


def _shared_blackboard(node: Behaviour) -> Iterator[tuple[Behaviour, str]]:
    if node.blackboards:
        yield node, "is on py_trees' blackboard, which all robots of the process share; take the store"


def _may_run(node: Behaviour) -> bool:
    return Status.RUNNING in outcomes(node)


def _is_condition(node: Behaviour) -> bool:
    return Status.FAILURE in outcomes(node) and not any(
        Status.RUNNING in outcomes(leaf) or getattr(leaf, "writes", ()) for leaf in _leaves(node)
    )


def _leaves(node: Behaviour) -> list[Behaviour]:
    return [leaf for leaf in preorder(node) if not leaf.children]


_RULES: dict[str, Callable[[Behaviour], Iterator[tuple[Behaviour, str]]]] = {
    "forgotten-condition": _forgotten_conditions,
    "two-actions": _two_actions,
    "unreachable": _unreachable,
    "unbounded": _unbounded,
    "wall-clock": _wall_clock,
    "global-random": _global_random,
    "shared-blackboard": _shared_blackboard,
}
