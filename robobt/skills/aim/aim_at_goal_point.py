"""Aim at a given point of the goal line."""

from __future__ import annotations

from robobt.skills.base import Skill, skill
from robobt.skills.store import Shot
from robobt.tree import Status


@skill
class AimAtGoalPoint(Skill):
    """Write a shot at a point of the opponent's goal line to ``shot``, without rating it.

    Always SUCCESS; the shot's score is 0.

    Args:
        y: y coordinate of the point [m].
        tolerance: half angle around it that still counts as this shot [rad].
    """

    writes = ("shot",)

    y: float = 0.0
    tolerance: float = 0.02

    def on_running(self) -> Status:
        """Write the shot."""
        self.store.shot = Shot((self.frame.field.half_length, self.y), self.tolerance, 0.0)
        return self.succeed()
