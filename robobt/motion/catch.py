"""Take a rolling ball softly: give way along its path, so that it meets the mouth slowly.

A dribbler takes a ball that comes at it no faster than ``catch_speed``; a faster one bounces off.
"""

from __future__ import annotations

from math import atan2, hypot, sqrt

from robobt.motion.pilot import approach_speed, command, turn_rate
from robobt.world.command import RobotCommand
from robobt.world.limits import RobotLimits
from robobt.world.state import BallState, RobotState

MOUTH = 0.0965
"""From the robot's centre to that of a ball before its front [m]."""

_SHARE = 0.8
"""Share of its acceleration that a robot plans with to give way."""

_SLACK = 0.8
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
    # Beside the line, to the left as the ball rolls.
    left = dy * ux - dx * uy
    side = 1.0 if left >= 0.0 else -1.0
    leftward = me.vy * ux - me.vx * uy
    stands = period + 2.0 * me.limits.reaction
    across = side * approach_speed(
        side * left, side * leftward, limits.max_speed, limits.acceleration, limits.braking, stands
    )
    slow = _SLACK * me.limits.catch_speed
    closing = sqrt(slow * slow + 2.0 * _SHARE * limits.acceleration * gap)
    away = min(limits.max_speed, max(0.0, speed - closing))
    vx, vy = ux * away - uy * across, uy * away + ux * across
    order = command(me, vx, vy, turn_rate(me, atan2(-uy, -ux), limits, period), limits, period)
    order.dribbler = True
    return order
