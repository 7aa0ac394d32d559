"""Drive a robot to a pose the way the paper's team did.

Source: RoboBulls' published code, PilotOmni. The turns round the ball, and so the paper's times, depend on
how this pilot drives a bend, so the baseline keeps it besides robobt's own (:mod:`robobt.motion.pilot`). Its
guard against jumps of the vision is left out, because a frame's velocities have no such jumps.
"""

from __future__ import annotations

from math import atan2, cos, hypot, radians, sin, sqrt

from robobt.motion.pilot import ROBOBULLS_LIMITS
from robobt.world.command import RobotCommand
from robobt.world.geometry import Point, limit_norm, to_robot_frame, wrap_angle
from robobt.world.limits import RobotLimits
from robobt.world.state import RobotState

_ARRIVAL_TOLERANCE = 0.005
_TURN_TOLERANCE = radians(0.5)


def robobulls_drive(
    me: RobotState, target: Point, heading: float, period: float, limits: RobotLimits = ROBOBULLS_LIMITS
) -> RobotCommand:
    """Compute the command that brings ``me`` one control period nearer to a pose.

    The commanded velocity points straight at the target, at the speed from which ``limits.braking`` just
    stops there. It differs from the present velocity by at most what ``limits.acceleration`` allows, in any
    direction.

    Arguments are those of :func:`robobt.motion.pilot.drive`.
    """
    error = wrap_angle(heading - me.heading)
    rate = min(sqrt(2.0 * limits.angular_braking * max(abs(error) - _TURN_TOLERANCE, 0.0)), limits.max_turn)
    step = limits.turn_acceleration * period
    omega = min(me.omega + step, max(me.omega - step, rate if error >= 0.0 else -rate))
    omega = min(limits.max_turn, max(-limits.max_turn, omega))

    dx, dy = target[0] - me.x, target[1] - me.y
    left = max(hypot(dx, dy) - _ARRIVAL_TOLERANCE, 0.0)
    speed = min(sqrt(2.0 * limits.braking * left), limits.max_speed)
    # Turning while driving bends the path, so half of the turn is subtracted in advance.
    course = atan2(dy, dx) - 0.5 * omega * period
    change = limit_norm(
        speed * cos(course) - me.vx, speed * sin(course) - me.vy, limits.acceleration * period
    )
    vx, vy = limit_norm(me.vx + change[0], me.vy + change[1], limits.max_speed)
    vx, vy = to_robot_frame(vx, vy, me.heading)
    return RobotCommand(vx, vy, omega)
