"""Driving of simple opponents: straight at a point, as fast as they can still stop there."""

from __future__ import annotations

from math import atan2, cos, hypot, sin, sqrt
from typing import Protocol

import numpy as np

from robobt.world.compiled import compilable, record_dtype
from robobt.world.geometry import FloatArray, Point, wrap_angle
from robobt.world.limits import RobotLimits
from robobt.world.records import Robot

TURN = 6.0
"""Highest turning rate of most of them [rad/s]."""
_TURNING_GAIN = 6.0
"""Turning rate per radian of error [1/s]."""
_RELIED_BRAKING_SHARE = 0.8
"""Share of its braking that a robot relies on."""


class DrivingLimits(Protocol):
    """Parameters of driving.

    Attributes:
        braking: what the robot can brake with in any direction [m/s^2].
        period: time until the next command [s].
        slowest: a robot goes on as fast until it is there [m/s].
    """

    braking: float
    period: float
    slowest: float


DRIVING_LIMITS = record_dtype(DrivingLimits)


def drive_of(limits: RobotLimits, period: float, slowest: float = 0.0) -> FloatArray:
    """Return the numbers of :class:`DrivingLimits` for a robot with such limits."""
    return np.array([min(limits.braking, limits.lateral_braking), period, slowest])


@compilable
def drive_straight(
    me: Robot, target: Point, facing: Point, top: float, turn: float, drive: DrivingLimits
) -> tuple[float, float, float]:
    """Return a command: velocity ahead and to the left [m/s], and turning rate [rad/s].

    Args:
        me: the robot.
        target: point to drive to [m].
        facing: the point to turn to [m].
        top: top speed [m/s].
        turn: highest turning rate [rad/s].
        drive: the other parameters.
    """
    dx, dy = target[0] - me.x, target[1] - me.y
    way = hypot(dx, dy)
    speed = min(top, max(stopping_speed(way, drive.braking), drive.slowest), way / drive.period)
    vx, vy = (speed * dx / way, speed * dy / way) if way > 0.0 else (0.0, 0.0)
    c, s = cos(me.heading), sin(me.heading)
    off = wrap_angle(atan2(facing[1] - me.y, facing[0] - me.x) - me.heading)
    return c * vx + s * vy, c * vy - s * vx, turning(off, turn)


@compilable
def stopping_speed(way: float, braking: float) -> float:
    """Return the speed from which a robot with this ``braking`` certainly stops within ``way`` [m/s]."""
    return sqrt(2.0 * _RELIED_BRAKING_SHARE * braking * way)


@compilable
def turning(off: float, most: float) -> float:
    """Return how fast to turn by ``off`` [rad], at most ``most`` [rad/s]."""
    return min(max(_TURNING_GAIN * off, -most), most)
