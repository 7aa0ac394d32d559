"""Chooses how to tick a node: by closures for its class, its own closures, or its generator."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal, NamedTuple, TypeAlias, TypeVar, cast

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from robobt.tree.engine.closures import BringsClosures, Marks, Stop, Tick, Visit, has_method_of

Make: TypeAlias = Callable[[Any, Visit | None], tuple[Tick, Stop]]
Reach: TypeAlias = Literal["all", "first", "some"]
"""The children that a tick of a node reaches, see :func:`ticked_children`."""


_N = TypeVar("_N", bound=Behaviour)


class Known(NamedTuple):
    """How nodes of one kind are ticked.

    Attributes:
        tick: the method of py_trees whose nodes these are.
        stop: the same class's ``stop``.
        make: makes a node's closures.
        followed: whether the closures of a node tell :class:`Marks` whatever else than its
            children decides about it.
        reach: which children of a node its tick reaches.
    """

    tick: object
    stop: object
    make: Make
    followed: Callable[[Behaviour], bool] = lambda _: False
    reach: Callable[[Any], Reach] = lambda _: "some"


def compile_tree(root: Behaviour, visit: Visit | None = None) -> Tick:
    """Return a function that ticks the tree once and returns the root's status.

    Children may be added, removed and replaced between ticks; which of its
    methods a node has must not change.

    ``visit`` is called with every node as it has been ticked, in py_trees' order.
    """
    return compile_node(root, visit)[0]


def compile_node(node: Behaviour, visit: Visit | None) -> tuple[Tick, Stop]:
    """Return functions that tick and stop this node and everything below it."""
    known = known_as(node)
    tick, stop = known.make(node, visit)
    if isinstance(visit, Marks) and not known.followed(node):
        return visit.whenever(tick), stop
    return tick, stop


def register(
    cls: type[_N],
    make: Callable[[_N, Visit | None], tuple[Tick, Stop]],
    followed: Callable[[Behaviour], bool] = lambda _: False,
    reach: Callable[[_N], Reach] = lambda _: "some",
) -> None:
    """Tick nodes that inherit ``tick`` and ``stop`` of a class by closures.

    ``make`` makes the closures of such a node; for ``followed`` and ``reach`` see :class:`Known`.
    """
    _KNOWN_NODES.append(Known(cls.tick, cls.stop, make, followed, reach))


def known_as(node: Behaviour) -> Known:
    """Return how a node is ticked."""
    cls = type(node)
    if not (has_method_of(cls, node, "tick") and has_method_of(cls, node, "stop")):
        return AS_IT_IS
    for known in _KNOWN_NODES:
        if cls.tick is known.tick and cls.stop is known.stop:
            return known
    return _AS_IT_BRINGS if _brings_closures(cls) else AS_IT_IS


def ticked_children(node: Behaviour) -> Reach:
    """Return which children a tick of this node reaches, among those with a status afterwards.

    "all": all of them. "first": those up to the first that succeeded or runs. "some":
    their statuses do not tell, for a child may keep that of an earlier tick, or one
    with a way of its own may show another than it had when its parent looked.
    """
    if any(known_as(child) is AS_IT_IS for child in node.children):
        return "some"
    return known_as(node).reach(node)


def _brings_closures(cls: type[Behaviour]) -> bool:
    """Return whether the closures the class offers are those of its own ``tick`` and ``stop``."""
    for base in cls.__mro__:
        if "closures" in vars(base):
            return cls.tick is base.tick and cls.stop is base.stop  # type: ignore[attr-defined]
    return False


def _as_it_is(node: Behaviour, visit: Visit | None) -> tuple[Tick, Stop]:
    """Return closures that tick a node with a ``tick`` of its own through its generator."""

    def tick() -> Status:
        for ticked in node.tick():
            if visit is not None:
                visit(ticked)
        return node.status

    def stop(status: Status) -> None:
        node.stop(status)

    return tick, stop


_KNOWN_NODES: list[Known] = []
AS_IT_IS = Known(None, None, _as_it_is)
_AS_IT_BRINGS = Known(None, None, lambda node, visit: cast(BringsClosures, node).closures(visit))
