"""The plan of a composite: its children with their closures."""

from __future__ import annotations

from typing import TypeAlias

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.composites import Composite, Selector, Sequence

from robobt.tree.engine.closures import (
    FAILURE,
    INVALID,
    RUNNING,
    SUCCESS,
    Marks,
    Stop,
    Tick,
    Visit,
    marks_of,
    own_method,
    shown,
)
from robobt.tree.engine.dispatch import AS_IT_IS, compile_node, known_as
from robobt.tree.engine.leaves import leaf_closures, lifecycle


class PlanStep:
    """One child in a composite's plan.

    Attributes:
        child: the child.
        tick, stop: its closures.
        update: set for a leaf of which nothing else is to be called, so that a
            composite may spare itself the closures.
    """

    __slots__ = ("child", "stop", "tick", "update")

    def __init__(self, child: Behaviour, visit: Visit | None, parent: Behaviour) -> None:
        self.child = child
        self.tick, self.stop = compile_node(child, visit)
        if type(parent).tick in _LEAVES_AT and known_as(child) is AS_IT_IS:
            tick = _until(child, visit, *_LEAVES_AT[type(parent).tick])
            self.tick = visit.whenever(tick) if isinstance(visit, Marks) else tick
        self.update: Tick | None = None
        if shown(child, visit) is None and known_as(child).make is leaf_closures:
            initialise, update, terminate = lifecycle(child)
            if initialise is terminate is None:
                marks = marks_of(visit)
                self.update = update if marks is None else marks.watched(child, update)


Plan: TypeAlias = list[PlanStep]


def _until(child: Behaviour, visit: Visit | None, ends: tuple[Status, ...], otherwise: Status) -> Tick:
    """Return the tick of a child with a ``tick`` of its own, left as py_trees' composites leave it.

    They look at the child each time it yields itself. What its generator does after
    they have seen enough does not happen, and one that never shows a status they
    wait for has let them pass.
    """

    def tick() -> Status:
        for ticked in child.tick():
            if visit is not None:
                visit(ticked)
            if ticked is child and child.status in ends:
                return child.status
        return otherwise

    return tick


_LEAVES_AT: dict[object, tuple[tuple[Status, ...], Status]] = {
    Sequence.tick: ((FAILURE, RUNNING, INVALID), SUCCESS),
    Selector.tick: ((SUCCESS, RUNNING), FAILURE),
}
"""The statuses of a child at which a composite stops, and its own status if none of them occurs."""


def composite_stop(node: Composite, visit: Visit | None, children: list[Behaviour], plan: Plan) -> Stop:
    """Return a closure with the effect of ``Composite.stop``; :func:`replan` updates its arguments."""
    terminate = own_method(node, "terminate")

    def stop(status: Status) -> None:
        if status is INVALID:
            node.current_child = None
            if node.children != children:
                replan(node, visit, children, plan)
            for step in plan:
                if step.child.status is not INVALID:
                    step.stop(INVALID)
        if terminate is not None:
            terminate(status)
        node.status = status

    return stop


def replan(node: Composite, visit: Visit | None, children: list[Behaviour], plan: Plan) -> None:
    """Update a composite's closures for its children, in place because the closures share the plan."""
    known = {step.child.id: step for step in plan}
    if isinstance(visit, Marks):
        visit.change()
    now = list(node.children)
    # Before anything is changed: where it raises, the next tick has to find that the children are others.
    plan[:] = [known.get(child.id) or PlanStep(child, visit, node) for child in now]
    children[:] = now
