"""Ticks one robot's tree and keeps a fault in it from spreading."""

from __future__ import annotations

import logging
from typing import Literal

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.visitors import VisitorBase

from robobt.tree.engine import abandon, compile_tree
from robobt.tree.leaf import bind

_log = logging.getLogger(__name__)


def node_path(node: Behaviour) -> str:
    """Names from the root to the node, joined by slashes."""
    names = [node.name]
    while node.parent is not None:
        node = node.parent
        names.append(node.name)
    return "/".join(reversed(names))


class TreeError(RuntimeError):
    """A node raised: the message starts with its path, ``__cause__`` is what it raised."""


class TreeRunner:
    """A tree bound to one store.

    An exception in a node stops this tree: running nodes are interrupted, every
    node becomes INVALID, ``error`` says what happened and where, and the next tick
    starts from the root again.

    Args:
        root: the tree.
        store: what its leaves work on.
        on_error: what else an exception in a node does. "stop" logs it, for matches that
            go on without this robot; "raise" raises :class:`TreeError`, for development.

    Attributes:
        nodes: every node in depth-first order, parents first; the order of :meth:`statuses`.
        error: what the last tick raised, None when it went well.
    """

    def __init__(self, root: Behaviour, store: object, on_error: Literal["stop", "raise"] = "stop") -> None:
        self.root = root
        self.on_error = on_error
        self.error: str | None = None
        self.nodes = preorder(root)
        bind(root, store)
        self._tick = compile_tree(root)

    def tick(self) -> Status:
        """Tick the tree once; INVALID when a node raised.

        Raises:
            TreeError: a node raised, and ``on_error`` is "raise".
        """
        self.error = None
        try:
            self._tick()
        except Exception as error:
            self.error = f"{self._raiser(error)}: {type(error).__name__}: {error}"
            abandon(self.root)
            if self.on_error == "raise":
                raise TreeError(self.error) from error
            _log.warning("tree stopped: %s", self.error, exc_info=_log.isEnabledFor(logging.DEBUG))
        return self.root.status

    def tick_by_py_trees(self) -> None:
        """From now on tick by py_trees' own generators instead: the same, slower, for comparison."""

        def tick() -> Status:
            for _ in self.root.tick():
                pass
            return self.root.status

        self._tick = tick

    def show_to(self, visitor: VisitorBase) -> None:
        """From now on show every node that has been ticked to this py_trees visitor, and to no other."""
        tick = compile_tree(self.root, visitor.run)

        def visited() -> Status:
            visitor.initialise()
            try:
                return tick()
            finally:
                visitor.finalise()

        self._tick = visited

    def statuses(self) -> str:
        """One letter a node in the order of ``nodes``: S, F, R or - (not ticked)."""
        return "".join([_LETTERS[node.status._value_] for node in self.nodes])

    def stop(self) -> None:
        """End the run; running leaves are interrupted, and what they raise then is logged."""
        try:
            self.root.stop(Status.INVALID)
        except Exception as error:
            _log.warning("%s: %s: %s", self._raiser(error), type(error).__name__, error)
            abandon(self.root)

    def _raiser(self, error: Exception) -> str:
        trace = error.__traceback__
        path = node_path(self.root)
        while trace is not None:
            local = trace.tb_frame.f_locals
            candidate = local.get("self", local.get("node"))
            if isinstance(candidate, Behaviour):
                path = node_path(candidate)
            trace = trace.tb_next
        return path


def preorder(root: Behaviour) -> list[Behaviour]:
    """Every node below and including ``root``, parents before children."""
    nodes = [root]
    for child in root.children:
        nodes.extend(preorder(child))
    return nodes


# By value: hashing an enum's member is a Python call, hashing its string is not.
_LETTERS = {"SUCCESS": "S", "FAILURE": "F", "RUNNING": "R", "INVALID": "-"}
