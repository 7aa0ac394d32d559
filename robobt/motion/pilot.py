"""Drive a robot to a pose: a trapezoid in distance and one in angle, made for a control period.

The shape is that of RoboBulls' published code (PilotOmni): speed by the square
root of the distance left, the heading's own profile beside it, and the
velocity's direction corrected for the turn made meanwhile. Here the profile is
solved for the speed at the *end* of a control period, so that the robot brakes
neither a period too late, which overshoots, nor too early, which creeps.

A robot that reacts late (``reaction`` of its limits) is driven as if at a longer
control period: what was commanded before takes effect first, and what is commanded
now stands until the next command does. Planned for the control period alone, it would
swing about its target.
"""

from __future__ import annotations

from math import radians

import numpy as np

from robobt.motion.speeds import command_numbers, drive_numbers, numbers, stop_time, turn_rate_numbers
from robobt.world.command import RobotCommand
from robobt.world.compiled import compilable
from robobt.world.geometry import FloatArray, Point, wrap_angle
from robobt.world.limits import RobotLimits
from robobt.world.state import RobotState

ROBOBULLS_LIMITS = RobotLimits(
    max_speed=1.5,
    acceleration=2.5,
    braking=0.8,
    max_turn=radians(80.0),
    turn_acceleration=radians(1500.0),
    turn_braking=radians(100.0),
)
"""How RoboBulls' published code drives any robot (PilotOmni and config/motion.yaml)."""


def drive(
    me: RobotState,
    target: Point,
    heading: float,
    limits: RobotLimits,
    period: float,
    final_speed: float = 0.0,
) -> RobotCommand:
    """Compute the command that brings ``me`` one control period nearer to a pose.

    An acceleration in ``limits`` at or above the robot's own is left to the
    robot, which knows its velocity without delay; a lower one is kept here, by
    asking for no velocity that lies too far from the present one. So is the
    robot's own where it reacts late: the wheels of such a robot take a command at
    its word, and slip.

    Args:
        me: the robot.
        target: where to [m].
        heading: where the mouth is to point [rad]; turned to on the way.
        limits: how to drive; usually ``me.limits``.
        period: time until the next command [s].
        final_speed: speed allowed at the target [m/s], for waypoints.
    """
    task = np.array((*target, heading, final_speed), dtype=np.float64)
    return RobotCommand(*drive_numbers(_state(me), task, *_limits(me, limits), period))


def command(
    me: RobotState, vx: float, vy: float, omega: float, limits: RobotLimits, period: float
) -> RobotCommand:
    """Turn a velocity in field coordinates into a command in the robot's frame.

    It is shortened to ``limits`` and turned back by half of what the robot will
    turn within the period, so that on average it points where it should.

    ``vx`` and ``vy`` are the target velocity at the end of the period [m/s], ``omega`` is the turning rate
    [rad/s], ``period`` the time until the next command [s].
    """
    vx, vy, omega = float(vx), float(vy), float(omega)
    return RobotCommand(*command_numbers(_state(me), vx, vy, omega, *_limits(me, limits), period))


@compilable
def roughly(heading: float, wanted: float, slack: float) -> float:
    """Return the heading nearest to the present one that is within ``slack`` of the wanted one [rad].

    A robot that only has to look somewhere thereabouts stays as it is while that moves a little, where it
    would swing to and fro at exactly so.
    """
    error = wrap_angle(wanted - heading)
    if abs(error) <= slack:
        return heading
    return wanted - slack if error > 0.0 else wanted + slack


def turn_rate(me: RobotState, heading: float, limits: RobotLimits, period: float) -> float:
    """Compute the turning rate to command now so as to end at ``heading`` [rad/s]."""
    return turn_rate_numbers(_state(me), float(heading), numbers(me.limits), numbers(limits), period)


def travel_time(distance: float, speed: float, limits: RobotLimits) -> float:
    """Compute the time to cover ``distance`` and stop there: the trapezoid optimum [s].

    ``speed`` is that towards the target at the start, negative when it is away from it [m/s].
    """
    return stop_time(distance, speed, limits.acceleration, limits.braking, limits.max_speed)


def _state(me: RobotState) -> FloatArray:
    return np.array((me.x, me.y, me.heading, me.vx, me.vy, me.omega), dtype=np.float64)


def _limits(me: RobotState, limits: RobotLimits) -> tuple[FloatArray, FloatArray, bool]:
    """Return the robot's own limits, the given ones, and whether the robot does not keep to them itself."""
    return numbers(me.limits), numbers(limits), limits is not me.limits or me.limits.reaction > 0.0
