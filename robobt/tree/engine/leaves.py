"""Closures of leaves and decorators."""

from __future__ import annotations

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.decorators import Decorator, EternalGuard, OneShot

from robobt.tree.engine.closures import (
    FAILURE,
    INVALID,
    RUNNING,
    Hook,
    Stop,
    Tick,
    Visit,
    has_method_of,
    marks_of,
    not_a_status,
    own_method,
    shown,
)
from robobt.tree.engine.dispatch import compile_node, register
from robobt.tree.leaf import Leaf


def leaf_closures(node: Behaviour, visit: Visit | None) -> tuple[Tick, Stop]:
    """Return closures with the effect of ``Behaviour.tick`` and ``Behaviour.stop``."""
    initialise, update, terminate = lifecycle(node)
    marks, visit = marks_of(visit), shown(node, visit)

    def tick() -> Status:
        if initialise is not None and node.status is not RUNNING:
            initialise()
        status = update()
        if status.__class__ is not Status:
            status = not_a_status(node, status)
        if terminate is not None and status is not RUNNING:
            terminate(status)
        node.status = status
        if visit is not None:
            visit(node)
        return status

    def stop(status: Status) -> None:
        if terminate is not None:
            terminate(status)
        node.status = status

    return tick if marks is None else marks.watched(node, tick), stop


def lifecycle(node: Behaviour) -> tuple[Hook | None, Tick, Hook | None]:
    """Return a leaf's ``initialise``, ``update`` and ``terminate``, None where one does nothing.

    Those of :class:`Leaf` only call its own lifecycle, which is called directly
    instead as far as the leaf defines it.
    """
    initialise, update, terminate = own_method(node, "initialise"), node.update, own_method(node, "terminate")
    if isinstance(node, Leaf):
        if _inherits(node, "initialise"):
            initialise = None if _inherits(node, "on_start") else node.on_start
        if _inherits(node, "update"):
            update = node.on_running
        if _inherits(node, "terminate") and _inherits(node, "on_done") and _inherits(node, "on_interrupt"):
            terminate = None
    return initialise, update, terminate


def _inherits(leaf: Behaviour, method: str) -> bool:
    """Return whether the leaf has this method from :class:`Leaf` itself."""
    return has_method_of(Leaf, leaf, method)


def decorator_closures(node: Decorator, visit: Visit | None) -> tuple[Tick, Stop]:
    """Return closures with the effect of ``Decorator.tick`` and ``Decorator.stop``."""
    marks, show = marks_of(visit), shown(node, visit)
    initialise, terminate = own_method(node, "initialise"), own_method(node, "terminate")
    decorated: Behaviour = node.decorated
    tick_child, stop_child = compile_node(decorated, visit)

    def renew() -> None:
        nonlocal decorated, tick_child, stop_child
        tick_child, stop_child = compile_node(node.decorated, visit)
        decorated = node.decorated
        if marks is not None:
            marks.change()

    def tick() -> Status:
        if initialise is not None and node.status is not RUNNING:
            initialise()
        if node.decorated is not decorated:
            renew()
        tick_child()
        status: Status = node.update()
        if status.__class__ is not Status:
            status = not_a_status(node, status)
        if status is not RUNNING:
            stop(status)
        node.status = status
        if show is not None:
            show(node)
        return status

    def stop(status: Status) -> None:
        if terminate is not None:
            terminate(status)
        if node.decorated is not decorated:
            renew()
        if status is INVALID:
            stop_child(INVALID)
        if decorated.status is RUNNING:
            stop_child(INVALID)
        node.status = status

    return tick if marks is None else marks.watched(node, tick), stop


def _eternal_guard(node: EternalGuard, visit: Visit | None) -> tuple[Tick, Stop]:
    show = shown(node, visit)
    tick_guarded, stop = decorator_closures(node, visit)

    def tick() -> Status:
        result = node.condition()
        if isinstance(result, Status):
            result = result is not FAILURE
        elif not isinstance(result, bool):
            raise RuntimeError(f"conditional check must return 'bool' or 'common.Status' [{type(result)}]")
        if result:
            return tick_guarded()
        stop(FAILURE)
        if show is not None:
            show(node)
        return FAILURE

    return tick, stop


def _one_shot(node: OneShot, visit: Visit | None) -> tuple[Tick, Stop]:
    show = shown(node, visit)
    tick_child, stop = decorator_closures(node, visit)
    initialise = own_method(node, "initialise")

    def tick() -> Status:
        if not node.final_status:
            return tick_child()
        if initialise is not None and node.status is not RUNNING:
            initialise()
        status: Status = node.update()
        if status.__class__ is not Status:
            status = not_a_status(node, status)
        if status is not RUNNING:
            stop(status)
        node.status = status
        if show is not None:
            show(node)
        return status

    return tick, stop


register(Behaviour, leaf_closures, followed=lambda _: True)  # type: ignore[type-abstract]
register(Decorator, decorator_closures, followed=lambda _: True, reach=lambda _: "all")  # type: ignore[type-abstract]
register(EternalGuard, _eternal_guard)
register(OneShot, _one_shot)
