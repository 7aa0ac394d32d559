"""Take a rolling ball softly: back off along its path, so that it meets the mouth slowly.

A dribbler takes a ball that comes at it no faster than its ``receive_speed``; a faster one bounces off.
"""

from __future__ import annotations

from math import atan2, hypot, sqrt

from robobt.motion.pilot import approach_speed, command, turn_rate
from robobt.world.command import RobotCommand
from robobt.world.limits import RobotLimits
from robobt.world.state import BallState, RobotState

MOUTH = 0.0965
"""Distance from the robot's centre to a ball at its front [m]."""

_GIVING_SHARE = 0.8
"""Share of its acceleration that a robot plans with to back off."""

_SETTLES = 0.1
"""Time constant of the final approach to the line [s]."""

_LEAST_GIVING_SHARE = 0.3
"""Share of its acceleration that a robot always uses to back off."""

_CARRY = 0.7
"""Braking distance with the ball [m]; the rules allow 1 m of dribbling."""

_MEETING_SHARE = 0.8
"""Share of the catch speed at which the ball is met."""


def catch(me: RobotState, ball: BallState, limits: RobotLimits, period: float) -> RobotCommand:
    """Drive onto the ball's line for one tick, facing it, and along it as the ball comes near.

    Args:
        me: the robot, ahead of the ball.
        ball: the ball, which rolls.
        limits: how to drive.
        period: time until the next command [s].
    """
    speed = hypot(ball.vx, ball.vy)
    ux, uy = ball.vx / speed, ball.vy / speed
    dx, dy = ball.x - me.x, ball.y - me.y
    gap = max(0.0, -(dx * ux + dy * uy) - MOUTH)
    # Distance beside the line, to the left in the ball's direction.
    left = dy * ux - dx * uy
    side = 1.0 if left >= 0.0 else -1.0
    leftward = me.vy * ux - me.vx * uy
    stands = period + 2.0 * me.limits.trailing_time
    step = limits.acceleration * stands
    gentle = _GIVING_SHARE * limits.acceleration
    most = min(limits.max_speed, abs(left) / _SETTLES)
    across = side * approach_speed(side * left, side * leftward, most, gentle, gentle, stands)
    # The wheels' acceleration is shared: first onto the line, the remainder along it.
    across = leftward + min(step, max(-step, across - leftward))
    slow = _MEETING_SHARE * me.limits.receives
    closing = sqrt(slow * slow + 2.0 * _GIVING_SHARE * limits.acceleration * gap)
    # The speed is limited so that the robot stops before it has carried the ball too far.
    most = min(limits.max_speed, sqrt(2.0 * _GIVING_SHARE * me.limits.holds_straight * _CARRY))
    away = min(most, max(0.0, speed - closing))
    onward = me.vx * ux + me.vy * uy
    rest = max(_LEAST_GIVING_SHARE * step, sqrt(max(0.0, step * step - (across - leftward) ** 2)))
    away = onward + min(rest, max(-rest, away - onward))
    vx, vy = ux * away - uy * across, uy * away + ux * across
    order = command(me, vx, vy, turn_rate(me, atan2(-uy, -ux), limits, period), limits, period)
    order.dribbler = True
    return order
