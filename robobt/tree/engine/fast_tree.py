"""A py_trees ``BehaviourTree`` that is ticked by compiled closures."""

from __future__ import annotations

import logging
from collections.abc import Callable

from py_trees.behaviour import Behaviour
from py_trees.trees import BehaviourTree

from robobt.tree.engine.closures import INVALID, RUNNING, Tick
from robobt.tree.engine.dispatch import compile_tree
from robobt.tree.walk import name_of, postorder

_log = logging.getLogger(__name__)

LEAVING = (SystemExit, KeyboardInterrupt)
"""Exceptions that end the program, also on a signal; they never count as a node's failure."""


class FastTree(BehaviourTree):
    """A py_trees ``BehaviourTree`` ticked by :func:`compile_tree`; visitors and handlers as ever.

    When a node raises, the tree is abandoned and the visitors are finalised before the
    exception goes on.
    """

    def __init__(self, root: Behaviour) -> None:
        super().__init__(root)
        self._compiled: Tick | None = None
        self._compiled_for: tuple[Behaviour, bool] | None = None

    def tick(
        self,
        pre_tick_handler: Callable[[BehaviourTree], None] | None = None,
        post_tick_handler: Callable[[BehaviourTree], None] | None = None,
    ) -> None:
        """Tick once, as :meth:`py_trees.trees.BehaviourTree.tick`."""
        if pre_tick_handler is not None:
            pre_tick_handler(self)
        for handler in self.pre_tick_handlers:
            handler(self)
        for visitor in self.visitors:
            visitor.initialise()
        key = (self.root, any(not visitor.full for visitor in self.visitors))
        if self._compiled is None or self._compiled_for != key:
            self._compiled = compile_tree(self.root, self._visit if key[1] else None)
            self._compiled_for = key
        try:
            self._compiled()
        except BaseException:
            # Ctrl-C too: code that continues after it finds a tree at rest.
            abandon(self.root)
            for visitor in self.visitors:
                visitor.finalise()
            raise
        full = [visitor for visitor in self.visitors if visitor.full]
        if full:
            for node in self.root.iterate():
                for visitor in full:
                    node.visit(visitor)
        for visitor in self.visitors:
            visitor.finalise()
        for handler in self.post_tick_handlers:
            handler(self)
        if post_tick_handler is not None:
            post_tick_handler(self)
        self.count += 1

    def _visit(self, node: Behaviour) -> None:
        for visitor in self.visitors:
            if not visitor.full:
                node.visit(visitor)


def abandon(root: Behaviour) -> None:
    """Bring a tree that an exception left half-ticked to rest: every node is INVALID afterwards.

    Nodes that were running are stopped, so they hear of their interruption; what
    they raise then is logged and keeps no other node from being stopped.

    Raises:
        SystemExit, KeyboardInterrupt: one of them ended the program; all are at rest by then.
    """
    left: BaseException | None = None
    # Children first, as composites stop; each is checked itself, because a half-ticked parent may not know
    # that its child runs.
    for node in postorder(root):
        if getattr(node, "status", RUNNING) is RUNNING:
            try:
                node.stop(INVALID)
            except LEAVING as error:
                left = error
            except RecursionError:
                # The root is among its descendants; the first exception has been reported.
                pass
            except BaseException:
                _log.warning(
                    "%r raised again while its tree was being stopped",
                    name_of(node),
                    exc_info=True,
                )
        node.status = INVALID
    if left is not None:
        raise left
