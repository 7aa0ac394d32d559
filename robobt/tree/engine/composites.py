"""Closures of sequences, selectors and parallels."""

from __future__ import annotations

from py_trees.behaviour import Behaviour
from py_trees.common import ParallelPolicy, Status
from py_trees.composites import Parallel, Selector, Sequence

from robobt.tree.engine.closures import (
    FAILURE,
    INVALID,
    RUNNING,
    SUCCESS,
    Stop,
    Tick,
    Visit,
    marks_of,
    not_a_status,
    own_method,
    shown,
)
from robobt.tree.engine.dispatch import register
from robobt.tree.engine.plan import Plan, composite_stop, replan


def sequence_closures(node: Sequence, visit: Visit | None) -> tuple[Tick, Stop]:
    """Return closures with the effect of ``Sequence.tick`` and ``Sequence.stop``."""
    marks, show = marks_of(visit), shown(node, visit)
    initialise, terminate = own_method(node, "initialise"), own_method(node, "terminate")
    children: list[Behaviour] = []
    plan: Plan = []
    stop = composite_stop(node, visit, children, plan)
    began = 0

    def tick() -> Status:
        nonlocal began
        if node.children != children:
            replan(node, visit, children, plan)
        start = 0
        begins = node.status is not RUNNING
        if begins:
            node.current_child = children[0] if children else None
            for step in plan:
                child = step.child
                if child.status is not INVALID:
                    if step.update is None:
                        step.stop(INVALID)
                    else:
                        child.status = INVALID
            if initialise is not None:
                initialise()
        elif node.memory and node.current_child is not None:
            start = children.index(node.current_child)
        if start != began:
            began = start
            if marks is not None:
                marks.change()
        status = SUCCESS
        for step in plan[start:] if start else plan:
            node.current_child = child = step.child
            update = step.update
            if update is None:
                status = step.tick()
            else:
                status = update()
                if status.__class__ is not Status:
                    status = not_a_status(child, status)
                child.status = status
            if status is not SUCCESS:
                # Where it begins, the children behind this one have just been brought to rest.
                if not node.memory and not begins and child is not children[-1]:
                    for later in plan[children.index(child) + 1 :]:
                        if later.child.status is not INVALID:
                            later.stop(INVALID)
                break
        if not children:
            node.current_child = None
        if status is INVALID:
            stop(status)
        else:
            if terminate is not None and status is not RUNNING:
                terminate(status)
            node.status = status
        if show is not None:
            show(node)
        return status

    return tick, stop


def selector_closures(node: Selector, visit: Visit | None) -> tuple[Tick, Stop]:
    """Return closures with the effect of ``Selector.tick`` and ``Selector.stop``."""
    marks, show = marks_of(visit), shown(node, visit)
    initialise = own_method(node, "initialise")
    children: list[Behaviour] = []
    plan: Plan = []
    stop = composite_stop(node, visit, children, plan)
    began = 0

    def tick() -> Status:
        nonlocal began
        if node.children != children:
            replan(node, visit, children, plan)
        if node.status is not RUNNING:
            node.current_child = children[0] if children else None
            if initialise is not None:
                initialise()
        start = 0
        if node.memory and children:
            assert node.current_child is not None, f"the running child of {node.name!r} has been removed"
            start = children.index(node.current_child)
            for step in plan[:start]:
                if step.child.status is not INVALID:
                    step.stop(INVALID)
        if start != began:
            began = start
            if marks is not None:
                marks.change()
        previous = node.current_child
        for step in plan[start:] if start else plan:
            child = step.child
            update = step.update
            if update is None:
                status = step.tick()
            else:
                status = update()
                if status.__class__ is not Status:
                    status = not_a_status(child, status)
                child.status = status
            if status is RUNNING or status is SUCCESS:
                node.current_child = child
                if previous is not child:
                    # The child that was chosen interrupts any running child of lower priority.
                    for later in plan[children.index(child) + 1 :]:
                        if later.child.status is not INVALID:
                            later.stop(INVALID)
                if status is SUCCESS:
                    stop(status)
                else:
                    node.status = status
                break
        else:
            status = FAILURE
            if not children:
                node.current_child = None
            stop(FAILURE)
            node.current_child = children[-1] if children else None
        if show is not None:
            show(node)
        return status

    return tick, stop


def _parallel(node: Parallel, visit: Visit | None) -> tuple[Tick, Stop]:
    show = shown(node, visit)
    initialise = own_method(node, "initialise")
    children: list[Behaviour] = []
    plan: Plan = []
    stop_composite = composite_stop(node, visit, children, plan)

    def stop(status: Status) -> None:
        if node.children != children:
            replan(node, visit, children, plan)
        for step in plan:
            if step.child.status is RUNNING:
                step.stop(INVALID)
        stop_composite(status)

    def tick() -> Status:
        if node.children != children:
            replan(node, visit, children, plan)
        policy = node.policy
        if isinstance(policy, ParallelPolicy.SuccessOnSelected):
            node.validate_policy_configuration()
        if node.status is not RUNNING:
            for step in plan:
                if step.child.status is not INVALID:
                    step.stop(INVALID)
            node.current_child = None
            if initialise is not None:
                initialise()
        if not children:
            node.current_child = None
            stop(SUCCESS)
            status = SUCCESS
        else:
            synchronise = policy.synchronise
            for step in plan:
                if not (synchronise and step.child.status is SUCCESS):
                    step.tick()
            status = _parallel_status(node, children, policy)
            if status is not RUNNING:
                stop(status)
            node.status = status
        if show is not None:
            show(node)
        return status

    return tick, stop


def _parallel_status(node: Parallel, children: list[Behaviour], policy: ParallelPolicy.Base) -> Status:
    """Return the status of a Parallel from its children; set ``current_child`` to the deciding child."""
    node.current_child = children[-1]
    for child in children:
        if child.status is FAILURE:
            node.current_child = child
            return FAILURE
    if isinstance(policy, ParallelPolicy.SuccessOnAll):
        return SUCCESS if all(child.status is SUCCESS for child in children) else RUNNING
    if isinstance(policy, ParallelPolicy.SuccessOnOne):
        for child in reversed(children):
            if child.status is SUCCESS:
                node.current_child = child
                return SUCCESS
        return RUNNING
    if isinstance(policy, ParallelPolicy.SuccessOnSelected):
        if all(child.status is SUCCESS for child in policy.children):
            node.current_child = policy.children[-1]
            return SUCCESS
        return RUNNING
    raise RuntimeError(f"this parallel has been configured with an unrecognised policy [{type(policy)}]")


def _without_hooks(node: Behaviour) -> bool:
    return own_method(node, "initialise") is own_method(node, "terminate") is None


register(Sequence, sequence_closures, _without_hooks, lambda node: "some" if node.memory else "all")
register(Selector, selector_closures, _without_hooks, lambda node: "some" if node.memory else "first")
register(Parallel, _parallel)
