"""Drive into the ball along a line, so that a kick on contact goes along it."""

from __future__ import annotations

from math import cos, sin, sqrt

from robobt.motion.pilot import approach_speed, command, travel_time, turn_rate
from robobt.world.command import RobotCommand
from robobt.world.limits import RobotLimits
from robobt.world.state import BallState, RobotState

RUN_UP_SPEED = 1.5
"""Speed relative to the ball at which the robot meets it [m/s]."""

_SHORT_OF_CONTACT = 0.12
"""Distance from the ball at which the robot has to be on the line [m]."""
_ON_LINE = 0.01
_STEADY = 0.15
"""A robot closer to the line than this [m] and slower across it than this [m/s] is on the line."""
_SHARES = (0.3, 0.9)
"""Least and greatest share of the acceleration used across the line."""


def run_up(
    me: RobotState, ball: BallState, facing: float, limits: RobotLimits, period: float
) -> RobotCommand:
    """Drive through the ball along ``facing`` for one tick, no sooner than the robot is on that line.

    The motion is split along and across the line, each with its own braking
    profile, and is relative to the ball, which may roll. The robot has to be
    behind the ball already.

    ``facing`` is the line's direction [rad], ``period`` the time to the next command [s].
    """
    ux, uy = cos(facing), sin(facing)
    dx, dy = ball.x - me.x, ball.y - me.y
    vx, vy = me.vx - ball.vx, me.vy - ball.vy
    back, left = dx * ux + dy * uy - _SHORT_OF_CONTACT, dy * ux - dx * uy
    back = max(0.0, back)
    ahead, leftward = vx * ux + vy * uy, vy * ux - vx * uy
    side = 1.0 if left >= 0.0 else -1.0
    aside, closing = side * left, side * leftward
    stands = period + 2.0 * me.limits.trailing_time
    acceleration = min(limits.acceleration, limits.lateral_acceleration)
    braking = min(limits.braking, limits.lateral_braking)
    until_on_line = travel_time(max(0.0, aside - _ON_LINE), closing, limits)
    until_there = max(period, back / max(ahead, RUN_UP_SPEED))
    across = min(_SHARES[1], max(_SHARES[0], until_on_line / until_there))
    rest = sqrt(1.0 - across * across)
    speed = approach_speed(
        back + RUN_UP_SPEED * RUN_UP_SPEED / (2.0 * braking),
        ahead,
        limits.max_speed,
        acceleration * rest,
        braking * rest,
        stands,
    )
    if aside > _ON_LINE or abs(closing) > _STEADY:
        speed = min(speed, back / max(until_on_line / across, period))
    sideways = side * approach_speed(
        aside, closing, limits.max_speed, acceleration * across, braking * across, stands
    )
    vx = ball.vx + ux * speed - uy * sideways
    vy = ball.vy + uy * speed + ux * sideways
    return command(me, vx, vy, turn_rate(me, facing, limits, period), limits, period)
