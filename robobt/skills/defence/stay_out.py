"""Decorator: keeps a field player from touching the ball inside a defence area."""

from __future__ import annotations

from py_trees.common import Status
from py_trees.decorators import Decorator

from robobt.motion.keep_out import keep_out
from robobt.skills.store import Store
from robobt.tree.leaf import Bound


class StayOut(Decorator, Bound[Store]):
    """Changes its child's command so that a field player does not touch the ball inside a defence area.

    Returns the child's status. See :func:`robobt.motion.keep_out.keep_out`.
    """

    def update(self) -> Status:
        """Adjust the child's command."""
        store = self.store
        keep_out(store.frame, store.me, store.command)
        return self.decorated.status
