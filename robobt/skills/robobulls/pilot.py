"""Drive a robot to a pose as the paper's team did.

Source: RoboBulls' published code, PilotOmni. Its turns round the ball, and with
them the paper's times, depend on how this pilot takes a bend, so the baseline
keeps it beside robobt's own (:mod:`robobt.motion.pilot`). Left out is its guard
against jumps of the vision, which a frame's velocities do not have.
"""

from __future__ import annotations

from math import atan2, cos, hypot, radians, sin, sqrt

from robobt.motion.pilot import ROBOBULLS_LIMITS
from robobt.world.command import RobotCommand
from robobt.world.geometry import Point, limit_norm, to_robot_frame, wrap_angle
from robobt.world.limits import RobotLimits
from robobt.world.state import RobotState

_THERE = 0.005
_TURNED = radians(0.5)


def robobulls_drive(
    me: RobotState, target: Point, heading: float, period: float, limits: RobotLimits = ROBOBULLS_LIMITS
) -> RobotCommand:
    """Compute the command that brings ``me`` one control period nearer to a pose.

    The commanded velocity leads straight to the target at the speed from which
    ``limits.braking`` just stops there; it differs from the present velocity by
    no more than ``limits.acceleration`` allows, in whatever direction.

    Arguments are those of :func:`robobt.motion.pilot.drive`.
    """
    error = wrap_angle(heading - me.heading)
    rate = min(sqrt(2.0 * limits.angular_braking * max(abs(error) - _TURNED, 0.0)), limits.max_turn)
    step = limits.turn_acceleration * period
    omega = min(me.omega + step, max(me.omega - step, rate if error >= 0.0 else -rate))
    omega = min(limits.max_turn, max(-limits.max_turn, omega))

    dx, dy = target[0] - me.x, target[1] - me.y
    left = max(hypot(dx, dy) - _THERE, 0.0)
    speed = min(sqrt(2.0 * limits.braking * left), limits.max_speed)
    # Driving while turning bends the way; half of the turn is taken off beforehand.
    course = atan2(dy, dx) - 0.5 * omega * period
    change = limit_norm(
        speed * cos(course) - me.vx, speed * sin(course) - me.vy, limits.acceleration * period
    )
    vx, vy = limit_norm(me.vx + change[0], me.vy + change[1], limits.max_speed)
    vx, vy = to_robot_frame(vx, vy, me.heading)
    return RobotCommand(vx, vy, omega)
