"""The base of skills that drive within limits of their own."""

from __future__ import annotations

from dataclasses import dataclass

from robobt.skills.base import Skill
from robobt.world.limits import RobotLimits

_LARGEST_FACTOR = 10.0
"""Beyond it a command is far beyond every robot's limits."""


@dataclass(kw_only=True, eq=False, repr=False)
class DrivingSkill(Skill):
    """A skill that drives by given limits, at a share of their top speed.

    Args:
        limits: how to drive; None for the robot's own.
        speed_factor: factor on the top speed and turning rate, above 0 and at most 10.

    Raises:
        ValueError: the factor is not in that range.
    """

    limits: RobotLimits | None = None
    speed_factor: float = 1.0

    def __post_init__(self) -> None:
        super().__post_init__()
        if not 0.0 < self.speed_factor <= _LARGEST_FACTOR:
            raise ValueError(
                f"speed_factor must be above 0 and at most {_LARGEST_FACTOR:g}, not {self.speed_factor}"
            )
        self._base: RobotLimits | None = None
        self._scaled = RobotLimits()

    @property
    def drive_limits(self) -> RobotLimits:
        """The limits to drive with now."""
        base = self.me.limits if self.limits is None else self.limits
        if self.speed_factor == 1.0:
            return base
        if base is not self._base:
            self._base, self._scaled = base, base.scaled(self.speed_factor)
        return self._scaled
