"""The simplest scripts for Table 4: what a learned approach or shot has to beat to be worth its training."""

from __future__ import annotations

from math import atan2, copysign, cos, sin, sqrt

from robobt.skills import GO_TO_BALL_POLICIES, SHOOT_POLICIES, Approach, Store
from robobt.world import KickTrigger, RobotCommand, direction, wrap_angle

_TURN_GAIN = 6.0
"""Turning rate for each radian off the ball [1/s]."""

_SHARE_OF_BRAKING = 0.8
"""Share of the robot's angular braking with which the shot plans to stop turning."""

_TOLERANCE = 0.06
"""The shot kicks when the ball would leave within this angle of the goal's middle [rad]."""

_KICK_SPEED = 6.0
"""Kick speed, that of the learned shot [m/s]."""


@GO_TO_BALL_POLICIES.register("script")
def drive_straight(store: Store, approach: Approach) -> RobotCommand:
    """Drive straight at the ball as fast as the robot can, and turn to it on the way."""
    limits = approach.limits
    off = wrap_angle(direction(store.me.position, approach.meeting) - store.me.heading)
    omega = min(limits.max_turn, max(-limits.max_turn, _TURN_GAIN * off))
    return RobotCommand(limits.max_speed * cos(off), limits.max_speed * sin(off), omega, dribbler=True)


@SHOOT_POLICIES.register("script")
def turn_and_brake(store: Store) -> RobotCommand:
    """Turn to the goal's middle as fast as the robot can still stop there, and kick on the way."""
    me, ball = store.me, store.frame.ball
    c, s = cos(me.heading), sin(me.heading)
    leaving = atan2(c * ball.vy - s * ball.vx, _KICK_SPEED)
    off = wrap_angle(direction(ball.position, store.frame.field.their_goal) - me.heading - leaving)
    fastest = sqrt(2.0 * _SHARE_OF_BRAKING * me.limits.angular_braking * abs(off))
    command = RobotCommand(omega=copysign(min(me.limits.max_turn, fastest), off), dribbler=True)
    if abs(off) < _TOLERANCE:
        command.kick_speed, command.kick_trigger = _KICK_SPEED, KickTrigger.NOW
    return command
