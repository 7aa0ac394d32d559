"""The driving limits of a skill: given limits or the robot's, with scaled top speed."""

from __future__ import annotations

from robobt.world.limits import RobotLimits

MOST = 10.0
"""Largest factor; beyond it a command is far beyond every robot's limits."""


def check_factor(speed_factor: float) -> float:
    """Return the factor itself.

    Raises:
        ValueError: the factor is not above 0 and at most :data:`MOST`.
    """
    if not 0.0 < speed_factor <= MOST:
        raise ValueError(f"speed_factor must be above 0 and at most {MOST:g}, not {speed_factor}")
    return speed_factor


class Pace:
    """Limits to drive with, computed once for each robot's limits.

    Args:
        limits: how to drive; None takes the robot's own.
        speed_factor: factor on the top speed and turning rate, above 0 and at most :data:`MOST`.
    """

    def __init__(self, limits: RobotLimits | None, speed_factor: float) -> None:
        self._limits = limits
        self._speed = check_factor(speed_factor)
        self._base: RobotLimits | None = None
        self._scaled: RobotLimits | None = None

    def of(self, own: RobotLimits) -> RobotLimits:
        """Return the limits to drive with for a robot whose own are ``own``."""
        base = own if self._limits is None else self._limits
        if self._speed == 1.0:
            return base
        if self._scaled is None or base is not self._base:
            self._base, self._scaled = base, base.scaled(self._speed)
        return self._scaled
