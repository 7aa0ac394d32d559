"""Decorator: plans ways as the team of November 2026 did."""

from __future__ import annotations

from py_trees.common import Status

from robobt.motion.scene import evade
from robobt.skills.store import Store
from robobt.tree.leaf import Bound
from robobt.tree.nodes.gate import Gate


class GoRound(Gate, Bound[Store]):
    """Lets its child's ways go round where moving robots will be, rather than evade them by velocity.

    Has the child's status.
    """

    def answer(self) -> None:
        """Plan in the old way from now on, and tick the child."""
        evade(self.store.frame, False)

    def update(self) -> Status:
        """Plan as ever for the robots that come next."""
        evade(self.store.frame, True)
        return super().update()
