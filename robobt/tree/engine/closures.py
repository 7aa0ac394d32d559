"""Closures that tick and stop a node, and the code shared by all their makers."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Protocol, TypeAlias

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from robobt.tree.leaf import FAILURE as FAILURE
from robobt.tree.leaf import INVALID as INVALID
from robobt.tree.leaf import RUNNING as RUNNING
from robobt.tree.leaf import SUCCESS as SUCCESS
from robobt.tree.leaf import Leaf, no_status

Tick: TypeAlias = Callable[[], Status]
Stop: TypeAlias = Callable[[Status], None]
Visit: TypeAlias = Callable[[Behaviour], None]
Hook: TypeAlias = Callable[..., None]
"""A node's ``initialise`` or ``terminate``."""


class BringsClosures(Protocol):
    """A class with a ``tick`` of its own that offers closures in place of its generator."""

    def closures(self, visit: Visit | None) -> tuple[Tick, Stop]:
        """Return functions with the effect of this node's ``tick`` and ``stop``.

        Children are compiled by :func:`~robobt.tree.engine.dispatch.compile_node`. A subclass that
        overrides ``tick`` or ``stop`` without ``closures`` is ticked through its generator.

        ``visit`` is called with this node whenever it has been ticked; the children's closures do the same
        for them.
        """


class Marks:
    """A :data:`Visit` that is called for some nodes only, so that it costs no time for the others.

    The nodes that a tick reaches, and their statuses, follow from the leaves' return values if every node on
    the way is of a known kind. So a tick in which each leaf returned the same as at its last tick leaves the
    tree unchanged, except for feedback.

    Args:
        nodes: those.
        tick: returns the number of the present or last tick.
        news: marks are appended to this when there is something new in them, so that whoever looks at many
            trees finds those few of which there is; for its owner to clear.

    Attributes:
        nodes: see above.
        changed: whether statuses, feedback or the nodes that are ticked may be others than before;
            for its owner to set to False.
        feedback: unless ``changed``, the nodes that gave other feedback than before, which is all
            that is new; for its owner to clear.
    """

    def __init__(self, nodes: Iterable[Behaviour], tick: Callable[[], int], news: list[Marks]) -> None:
        self.nodes = list(nodes)
        self._asked = {id(node) for node in self.nodes}
        self._tick, self._news = tick, news
        self._seen: list[Behaviour] = []
        self._seen_at = -1
        self.changed = False
        self.feedback: list[Behaviour] = []
        self.change()

    def __call__(self, node: Behaviour) -> None:
        """Note that ``node`` has been ticked."""
        now = self._tick()
        if now != self._seen_at:
            self._seen, self._seen_at = [], now
        self._seen.append(node)

    @property
    def seen(self) -> list[Behaviour]:
        """Nodes that the last tick has reached, in py_trees' order, every one of ``nodes`` among them."""
        return self._seen if self._seen_at == self._tick() else []

    def of(self, node: Behaviour) -> Visit | None:
        """Return the function to call with this node, or None if it is not followed."""
        return self if id(node) in self._asked else None

    def change(self) -> None:
        """Note that the tree may have changed."""
        if not self.changed:
            self.changed = True
            self._news.append(self)

    def say(self, node: Behaviour) -> None:
        """Note that a node's feedback has changed."""
        self.feedback.append(node)
        self._news.append(self)

    def watched(self, node: Behaviour, tick: Tick) -> Tick:
        """Return a node's tick, or update, that marks a new status or feedback."""
        last: Status | None = None
        said: str | None = None

        def watching() -> Status:
            nonlocal last, said
            status = tick()
            now = node.feedback_message
            if status is not last:
                self.change()
                last, said = status, now if now.__class__ is str else None
            elif now is not said and (now.__class__ is not str or now != said):
                # A newly made text is often equal; for other objects the effect of != is unknown.
                self.say(node)
                said = now if now.__class__ is str else None
            return status

        return watching

    def whenever(self, tick: Tick) -> Tick:
        """Return a tick that marks the tree as changed, for nodes that are not followed."""

        def changing() -> Status:
            self.change()
            return tick()

        return changing


def marks_of(visit: Visit | None) -> Marks | None:
    """Return the marks among the visits, or None if there are other visits."""
    return visit if isinstance(visit, Marks) else None


def shown(node: Behaviour, visit: Visit | None) -> Visit | None:
    """Return the function to call when this node has been ticked, or None."""
    return visit.of(node) if isinstance(visit, Marks) else visit


def own_method(node: Behaviour, method: str) -> Hook | None:
    """Return the node's bound method, None where it is py_trees' own that does nothing."""
    if has_method_of(Behaviour, node, method):
        return None
    own: Hook = getattr(node, method)
    return own


def has_method_of(cls: type, node: Behaviour, method: str) -> bool:
    """Return whether this method of the node is the class's, not one of a subclass or its own."""
    # Not looked up in the node's __dict__: asking for that makes CPython 3.11 build it, and
    # every attribute of the node is slower to reach from then on.
    found = getattr(node, method)
    if getattr(found, "__self__", None) is not node:
        return False
    # One made by functools.partialmethod is bound to the node, too, but is no method.
    return getattr(found, "__func__", None) is getattr(cls, method)


def not_a_status(node: Behaviour, status: object) -> Status:
    """Return INVALID, after py_trees' complaint that ``update`` returned something else.

    Raises:
        TypeError: the node is a :class:`Leaf`, which has to return a status.
    """
    if isinstance(node, Leaf):
        raise no_status(status)
    node.logger.error(f"A behaviour returned an invalid status, setting to INVALID [{status}][{node.name}]")
    return INVALID
