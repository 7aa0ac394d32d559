"""Decorator: plans paths as the team of November 2026 did."""

from __future__ import annotations

from py_trees.common import Status

from robobt.motion.scene import evade
from robobt.skills.store import Store
from robobt.tree.leaf import Bound
from robobt.tree.nodes.gate import Gate


class GoRound(Gate, Bound[Store]):
    """Makes its child's paths lead round predicted positions of moving robots, without evading by velocity.

    Returns the child's status.
    """

    def answer(self) -> None:
        """Tick the child with the old planner."""
        evade(self.store.frame, False)

    def update(self) -> Status:
        """Restore the present planner for the next robots."""
        evade(self.store.frame, True)
        return super().update()
