"""Ticks one robot's tree and contains its errors."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import PurePath
from typing import Literal

from py_trees.behaviour import Behaviour
from py_trees.common import Status
from py_trees.visitors import VisitorBase

from robobt.config.errors import RobobtError, text_of
from robobt.signals import Terminated
from robobt.tree.engine import LEAVING, Marks, Tick, Visit, abandon, compile_tree
from robobt.tree.leaf import bind
from robobt.tree.origin import only_own_code
from robobt.tree.walk import fault_of, node_path, postorder, preorder

_log = logging.getLogger(__name__)


class TreeError(RobobtError, RuntimeError):
    """A node raised: the message starts with its path, ``__cause__`` is the exception."""


class TreeRunner:
    """A tree bound to one store, each of whose nodes has been set up once by its ``setup()``.

    An exception fails its node and stops this tree: running nodes are interrupted, the node has FAILURE and
    the exception as its feedback, all others are INVALID, ``error`` has the exception and its place, and the
    next tick starts from the root again. Only SystemExit and KeyboardInterrupt are passed on, with the tree
    at rest. A tree of which a node raised in ``setup()`` fails at every tick for that reason.

    Args:
        root: the tree.
        store: the store of its leaves.
        on_error: further effect of an exception in a node. "stop" logs it, for matches that continue without
            this robot; "raise" raises :class:`TreeError`, for development.

    Attributes:
        nodes: every node in depth-first order, parents first; the order of :meth:`statuses`.
        own: whether only robobt's own code runs in the tree, see :func:`~robobt.tree.origin.only_own_code`.
        error: the exception of the last tick, or None.
        ticks: number of ticks.

    Raises:
        TreeError: the nodes are no tree, or one that is more than :data:`MAX_TREE_DEPTH` nodes deep.
    """

    def __init__(self, root: Behaviour, store: object, on_error: Literal["stop", "raise"] = "stop") -> None:
        if (fault := fault_of(root)) is not None:
            raise TreeError(f"{node_path(fault[0])}: {fault[1]}")
        self.root = root
        self.on_error = on_error
        self.error: str | None = None
        self.ticks = 0
        self.nodes = preorder(root)
        self.own = only_own_code(self.nodes)
        self._failed: Behaviour | None = None
        self._stock = False
        self._visitor: VisitorBase | None = None
        self._marks: Marks | None = None
        self._unready: Callable[[], BaseException] | None = None
        self._set_up: list[Behaviour] = []
        bind(root, store)
        self._tick = compile_tree(root)
        self._setup()

    def tick(self) -> Status:
        """Tick the tree once and return its root's status, INVALID when a node raised.

        Raises:
            TreeError: a node raised, and ``on_error`` is "raise".
        """
        self.error = None
        self.ticks += 1
        if self._failed is not None:
            self._failed.feedback_message, self._failed = "", None
        try:
            self._tick()
        except LEAVING as error:
            if isinstance(error, SystemExit) and not isinstance(error, Terminated):
                node, said = self._raiser(error)
                _log.error("%s ends the program: %s", node_path(node), said)
            # Code that continues after it finds a tree at rest.
            abandon(self.root)
            raise
        except BaseException as error:
            # A GeneratorExit, or an exception of the skill's own that is no Exception, as well.
            self._fail(error)
            if self.on_error == "raise":
                raise TreeError(self.error) from error
            _log.warning("tree stopped: %s", self.error, exc_info=_log.isEnabledFor(logging.DEBUG))
            return Status.INVALID
        return self.root.status

    def _setup(self) -> None:
        """Set up every node, children first as py_trees does, up to one that raises."""
        for node in postorder(self.root):
            try:
                node.setup()
            except LEAVING:
                self.shutdown()
                raise
            except BaseException as error:
                self._unready = partial(error.with_traceback, error.__traceback__)
                self._renew()
                return
            self._set_up.append(node)

    def shutdown(self) -> None:
        """Shut down, by their ``shutdown()``, the nodes that were set up; what one raises is logged."""
        nodes, self._set_up = self._set_up, []
        for node in nodes:
            try:
                node.shutdown()
            except LEAVING:
                raise
            except BaseException as error:
                _log.warning("%s: %s", node_path(node), self._raiser(error)[1])

    def _fail(self, error: BaseException) -> None:
        """Bring the tree to rest, with the node that raised marked as failed."""
        node, said = self._raiser(error)
        if self._unready is not None:
            said = f"setup() failed: {said}"
        self.error = f"{node_path(node)}: {said}"
        abandon(self.root)
        node.status, node.feedback_message = Status.FAILURE, said
        self._failed = node
        if self._marks is not None:
            self._marks.change()

    def tick_by_py_trees(self) -> None:
        """Tick by py_trees' own generators from now on: the same, slower, for comparison."""
        self._stock = True
        self._renew()

    def show_to(self, visitor: VisitorBase) -> None:
        """Show every node that has been ticked to this py_trees visitor from now on, and to no other."""
        self._visitor = visitor
        self._renew()

    def mark(self, nodes: Iterable[Behaviour], news: list[Marks]) -> Marks:
        """Note what changes in the tree from now on, in what is returned.

        Of all nodes at least ``nodes`` are noted when they are ticked. For ``news`` see :class:`Marks`.
        """
        self._marks = Marks(nodes, lambda: self.ticks, news)
        self._renew()
        return self._marks

    def _renew(self) -> None:
        """Compile the tree for the watchers of its nodes."""
        if self._unready is not None:
            self._tick = self._raise
            return
        visitor, marks = self._visitor, self._marks
        visit: Visit | None = marks
        if visitor is not None:
            run: Visit = visitor.run

            def visit_both(node: Behaviour) -> None:
                if marks is not None:
                    marks(node)
                run(node)

            visit = visit_both
        inner = self._by_py_trees(visit) if self._stock else compile_tree(self.root, visit)
        blind = self._stock or visit is not marks
        if visitor is None and (marks is None or not blind):
            self._tick = inner
            return

        def tick() -> Status:
            if marks is not None and blind:
                marks.change()
            if visitor is None:
                return inner()
            visitor.initialise()
            try:
                return inner()
            finally:
                visitor.finalise()

        self._tick = tick

    def _by_py_trees(self, visit: Visit | None) -> Tick:
        def tick() -> Status:
            for node in self.root.tick():
                if visit is not None:
                    visit(node)
            return self.root.status

        return tick

    def _raise(self) -> Status:
        """Tick a tree that could not be set up."""
        assert self._unready is not None
        raise self._unready()

    def statuses(self) -> str:
        """Return one letter for each node in the order of ``nodes``: S, F, R or - (not ticked)."""
        return "".join([status_letter(node.status) for node in self.nodes])

    def tip(self) -> Behaviour:
        """Return the node that decided the last tick, the root where none did."""
        try:
            return self.root.tip() or self.root
        except Exception:
            # A skill has changed the tree.
            return self.root

    def stop(self) -> None:
        """End the run; running leaves are interrupted, and what they raise then is logged."""
        try:
            self.root.stop(Status.INVALID)
        except LEAVING:
            abandon(self.root)
            raise
        except BaseException as error:
            node, said = self._raiser(error)
            _log.warning("%s: %s", node_path(node), said)
            abandon(self.root)
        if self._marks is not None:
            self._marks.change()

    def _raiser(self, error: BaseException) -> tuple[Behaviour, str]:
        """Return the node that raised, and what it is, with the line of the skill's file."""
        node, place = self.root, ""
        trace = error.__traceback__
        while trace is not None:
            frame = trace.tb_frame
            candidates = [frame.f_locals.get(name) for name in ("self", "node")]
            if behaviours := [each for each in candidates if isinstance(each, Behaviour)]:
                node = behaviours[0]
                if not frame.f_globals.get("__name__", "").startswith(_ENGINES):
                    place = f" ({PurePath(frame.f_code.co_filename).name}:{trace.tb_lineno})"
            trace = trace.tb_next
        if not place or isinstance(error, RecursionError):
            # No skill raised it, so perhaps one has changed the tree.
            fault = fault_of(self.root, shared=True)
            if fault is not None:
                return fault
        return node, f"{type(error).__name__}: {text_of(error)}{place}"


# Every exception passes through here, so this frame does not help to find the error.
_ENGINES = ("robobt.tree.", "py_trees.")


def status_letter(status: object) -> str:
    """Return S, F or R, or - for INVALID and for what is no status, as a skill may have set it on a node."""
    # By value: hashing an enum's member is a Python call, hashing its string is not.
    return _STATUS_LETTERS.get(getattr(status, "_value_", ""), "-")


_STATUS_LETTERS = {"SUCCESS": "S", "FAILURE": "F", "RUNNING": "R"}
