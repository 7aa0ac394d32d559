"""What a tree commands its robot to do for one control period."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from math import isfinite, pi


class KickTrigger(StrEnum):
    """When a kick command fires."""

    NOW = "now"
    """At once, and only if the ball is in the mouth at that instant."""
    ON_CONTACT = "on_contact"
    """As soon as the ball is in the mouth, while the command is in force."""


CHIP_ANGLE = pi / 4
"""Angle from the ground at which robots chip [rad]."""


@dataclass(slots=True)
class RobotCommand:
    """One robot's command, in the robot's own frame (x forward, y left).

    Attributes:
        vx, vy: velocity [m/s].
        omega: turning rate, counter-clockwise positive [rad/s].
        kick_speed: speed at which the ball is to leave [m/s]; 0 for no kick. For a chip it is the speed in
            space, not along the ground.
        kick_trigger: when the kick fires.
        dribbler: whether the dribbler is on.
        kick_angle: angle from the ground at which the ball is to leave [rad]: 0 is a flat kick,
            :data:`CHIP_ANGLE` a chip. Most robots chip at one angle, whichever is commanded.
    """

    vx: float = 0.0
    vy: float = 0.0
    omega: float = 0.0
    kick_speed: float = 0.0
    kick_trigger: KickTrigger = KickTrigger.ON_CONTACT
    dribbler: bool = False
    kick_angle: float = 0.0

    def copy(self) -> RobotCommand:
        """Return a command with the same entries; ``dataclasses.replace`` takes ten times as long."""
        return RobotCommand(
            self.vx,
            self.vy,
            self.omega,
            self.kick_speed,
            self.kick_trigger,
            self.dribbler,
            self.kick_angle,
        )

    def finite(self) -> bool:
        """Return whether every number in it is finite; one that is not must not reach a robot."""
        # What is not finite stays so in a sum; sums of numbers that no robot is sent may overflow.
        return isfinite(self.vx + self.vy + self.omega + self.kick_speed + self.kick_angle)
