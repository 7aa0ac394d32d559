"""Aim at the spot where the ball is to be placed."""

from __future__ import annotations

from robobt.skills.base import Condition, skill
from robobt.tree import Status
from robobt.world.geometry import distance


@skill
class AimAtSpot(Condition):
    """Write the referee's spot for the ball to ``target``; FAILURE without one, and once the ball is there.

    Args:
        tolerance: distance of the ball from the spot that counts as there [m].
    """

    writes = ("target",)

    tolerance: float = 0.1

    def on_running(self) -> Status:
        """Look where the ball is to be placed."""
        spot = self.frame.game.placement
        if spot is None or distance(self.ball.position, spot) < self.tolerance:
            return self.fail("no spot to aim at")
        self.store.target = spot
        return self.succeed()
