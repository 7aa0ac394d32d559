"""The base of every leaf: a py_trees behaviour with a typed store and a readable lifecycle."""

from __future__ import annotations

from collections.abc import Mapping
from math import isfinite
from numbers import Real
from typing import ClassVar, Generic, Self, TypeAlias, TypeVar

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from robobt.config.errors import short_repr
from robobt.tree.signatures import signature_of
from robobt.tree.walk import preorder

StoreT = TypeVar("StoreT")

# CPython 3.11 takes forty times as long to find a member in its enumeration as a name of this module.
SUCCESS, FAILURE, RUNNING, INVALID = Status.SUCCESS, Status.FAILURE, Status.RUNNING, Status.INVALID

Entries: TypeAlias = tuple[str, ...] | Mapping[str, object]
"""Entries of the store: their names, or name and type."""


class Bound(Generic[StoreT]):
    """A node that gets the robot's store from :func:`bind` before the first tick: a leaf, for example."""

    store: StoreT
    _given: tuple[tuple[object, ...], dict[str, object]]

    def __new__(cls, *args: object, **kwargs: object) -> Self:
        """Make a node that knows what it was made from."""
        # Kept because a node need not keep what it was made from, and a tree file has to say it.
        node = super().__new__(cls)
        node._given = (args, kwargs)
        return node

    def parameters(self) -> dict[str, object]:
        """Return every parameter of the node's constructor by name, with the values it was made from."""
        args, kwargs = self._given
        bound = signature_of(type(self)).bind(*args, **kwargs)
        bound.apply_defaults()
        return dict(bound.arguments)


class Leaf(Behaviour, Bound[StoreT]):
    """A leaf that works on a store shared by one robot's tree.

    Override :meth:`on_running`, and the others where needed:

    | method | when |
    | --- | --- |
    | ``on_start`` | the leaf is ticked and was not running |
    | ``on_running`` | every tick, the first one included; returns the status |
    | ``on_done`` | the leaf has just succeeded or failed |
    | ``on_interrupt`` | a running leaf was stopped by another branch |

    py_trees ticks the interrupting branch before it stops the old one, so
    ``on_interrupt`` runs after the new branch has decided its command and must
    not write one.

    Attributes:
        reads, writes: the store's entries the leaf uses.
        optional: entries of ``reads`` that may be missing.
        condition: whether it only checks, and neither commands anything nor keeps running.
    """

    reads: ClassVar[Entries] = ()
    writes: ClassVar[Entries] = ()
    optional: ClassVar[tuple[str, ...]] = ()
    condition: ClassVar[bool] = False

    def __init__(self, name: str = "") -> None:
        """Make the leaf.

        Raises:
            ValueError: a number it is made from is not finite, as tree files and scenarios refuse it too.
        """
        super().__init__(name or type(self).__name__)
        args, kwargs = self._given
        # Once for all leaves: no comparison with NaN holds, and a leaf's own checks easily let it through.
        if not all(_is_finite(value) for value in (*args, *kwargs.values())):
            wrong = [(key, value) for key, value in self.parameters().items() if not _is_finite(value)]
            raise ValueError(f"{wrong[0][0]} must be finite, not {short_repr(wrong[0][1])}")

    def needs(self) -> list[tuple[str, ...]]:
        """Return the entries that other nodes have to write into the store: of each item, one entry.

        These are the required entries that the leaf reads, unless a parameter with an entry's name replaces
        it.
        """
        return [
            (entry,)
            for entry in self.reads
            if entry not in self.optional and getattr(self, entry, None) is None
        ]

    def on_start(self) -> None:
        """Begin a run; called before its first tick."""

    def on_running(self) -> Status:
        """Work for one tick and return the status; SUCCESS or FAILURE ends the run."""
        raise NotImplementedError(f"{type(self).__name__} does not define on_running")

    def on_done(self, status: Status) -> None:
        """End a run that has succeeded or failed, which ``status`` says."""

    def on_interrupt(self) -> None:
        """End a run that is stopped from outside."""

    def fail(self, reason: str) -> Status:
        """Return FAILURE, with the reason as the node's feedback."""
        self.feedback_message = reason
        return FAILURE

    def run(self, feedback: str = "") -> Status:
        """Return RUNNING, with what is being done as the node's feedback."""
        self.feedback_message = feedback
        return RUNNING

    def succeed(self, feedback: str = "") -> Status:
        """Return SUCCESS, with an optional remark as the node's feedback."""
        self.feedback_message = feedback
        return SUCCESS

    def initialise(self) -> None:
        """Start for py_trees; override :meth:`on_start` instead."""
        self.on_start()

    def update(self) -> Status:
        """Run for py_trees; override :meth:`on_running` instead.

        Raises:
            TypeError: ``on_running`` returned no status.
        """
        status = self.on_running()
        if not isinstance(status, Status):
            raise no_status(status)
        return status

    def terminate(self, new_status: Status) -> None:
        """End for py_trees; override :meth:`on_done` or :meth:`on_interrupt` instead.

        py_trees also stops finished nodes with INVALID when their parent restarts; that is neither an end nor
        an interruption and calls neither method.
        """
        if new_status is not INVALID:
            self.on_done(new_status)
        elif self.status is RUNNING:
            self.on_interrupt()


def _is_finite(value: object) -> bool:
    """Return whether a value is no infinite number and no NaN, nor a point or other tuple with one."""
    if isinstance(value, tuple):
        return all(_is_finite(entry) for entry in value)
    return not isinstance(value, Real) or isinstance(value, int) or isfinite(value)


def no_status(answer: object) -> TypeError:
    """Return the error for a leaf whose ``on_running`` returned something else than a status."""
    forgotten = " (a forgotten return?)" if answer is None else ""
    return TypeError(f"on_running returned {type(answer).__name__}, not a Status{forgotten}")


def bind(root: Behaviour, store: object) -> None:
    """Give every :class:`Bound` node below ``root`` the store of the robot that runs the tree."""
    for node in preorder(root):
        if isinstance(node, Bound):
            node.store = store
