"""Decorator: keeps a robot from crashing into opponents while the ball is in play."""

from __future__ import annotations

from py_trees.common import Status
from py_trees.decorators import Decorator

from robobt.motion.give_way import avoid_crash
from robobt.skills.store import Store
from robobt.tree.leaf import Bound


class AvoidCrash(Decorator, Bound[Store]):
    """Slows its child's command down before the robot would hit an opponent faster than the rules allow.

    Returns the child's status. See :func:`robobt.motion.give_way.avoid_crash`.
    """

    def update(self) -> Status:
        """Adjust the child's command."""
        store = self.store
        avoid_crash(store.frame, store.me, store.command)
        return self.decorated.status
