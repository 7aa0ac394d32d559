"""The base of skills that drive within limits of their own."""

from __future__ import annotations

from dataclasses import dataclass

from robobt.motion.pace import Pace
from robobt.skills.base import Skill
from robobt.world.limits import RobotLimits


@dataclass(kw_only=True, eq=False, repr=False)
class DrivingSkill(Skill):
    """A skill that drives by given limits, at a share of their top speed.

    Args:
        limits: how to drive; None for the robot's own.
        speed_factor: factor on the top speed.
    """

    limits: RobotLimits | None = None
    speed_factor: float = 1.0

    def __post_init__(self) -> None:
        super().__post_init__()
        self._pace = Pace(self.limits, self.speed_factor)

    @property
    def drive_limits(self) -> RobotLimits:
        """The limits to drive with now."""
        return self._pace.of(self.me.limits)
