"""Limits of motion without losing the ball from the dribbler."""

from __future__ import annotations

from functools import lru_cache
from math import cos, hypot, inf, sin, sqrt

from robobt.motion.catch import MOUTH
from robobt.motion.pilot import command, turn_rate
from robobt.world.command import RobotCommand
from robobt.world.geometry import Point
from robobt.world.limits import RobotLimits
from robobt.world.state import TOUCH_DISTANCE, BallState, RobotState

MAX_TURN = 2.0
"""Turning rate at which every dribbler of the simulator's presets holds the ball [rad/s]."""
MAX_ACCELERATION = 1.5
"""Acceleration at which the default dribbler holds the ball while turning [m/s^2]."""
TURN_ACCELERATION = 15.0
"""Change of the turning rate at which the default dribbler holds the ball [rad/s^2]."""

_PRESS = 0.05
"""Speed at which the robot follows the ball that it turns round, so that it stays in the mouth [m/s]."""

_ROLLS_AT = 0.1
"""A ball that comes no faster than this moves ahead with a robot that drives into it [m/s]."""


@lru_cache(maxsize=64)
def dribbling_limits(
    max_speed: float = 2.0,
    max_turn: float = MAX_TURN,
    max_acceleration: float = MAX_ACCELERATION,
    held: float = inf,
) -> RobotLimits:
    """Limits for driving with the ball.

    Args:
        max_speed: top speed, the same in every direction [m/s].
        max_turn: turning rate [rad/s].
        max_acceleration: acceleration [m/s^2].
        held: acceleration at which the dribbler keeps the ball. It limits all acceleration but speeding up
            along the heading, which pushes the ball [m/s^2].
    """
    holding = min(max_acceleration, held)
    return RobotLimits(
        max_speed=max_speed,
        acceleration=max_acceleration,
        braking=holding,
        side_acceleration=holding,
        side_braking=holding,
        max_turn=max_turn,
        turn_acceleration=TURN_ACCELERATION,
    )


def carrying_limits(
    own: RobotLimits,
    max_speed: float = 2.0,
    max_turn: float = MAX_TURN,
    max_acceleration: float = MAX_ACCELERATION,
) -> RobotLimits:
    """Limits for driving ahead with the ball, within what the robot's own dribbler holds.

    Turning at a rate w with the ball at a distance L needs the acceleration w^2 L.

    Args:
        own: the robot's limits.
        max_speed: top speed [m/s].
        max_turn: turning rate [rad/s].
        max_acceleration: acceleration and braking [m/s^2].
    """
    turn = min(max_turn, sqrt(own.hold_acceleration / TOUCH_DISTANCE))
    return dribbling_limits(max_speed, turn, max_acceleration, own.holds_straight)


def holds_weakly(own: RobotLimits) -> bool:
    """Return whether a robot's dribbler holds a ball at less than :data:`MAX_ACCELERATION`, even straight."""
    return own.holds_straight < MAX_ACCELERATION


def carrying_share(own: RobotLimits) -> float:
    """Return the share of :data:`MAX_ACCELERATION` at which a robot's dribbler holds the ball, 0 to 1."""
    return min(1.0, own.hold_acceleration / MAX_ACCELERATION)


def settle(me: RobotState, period: float) -> RobotCommand:
    """Come to rest with the ball."""
    limits = dribbling_limits(max_acceleration=min(MAX_ACCELERATION, me.limits.holds_straight))
    return turn_with_ball(me, me.heading, limits, period)


def carry(chosen: RobotCommand, me: RobotState) -> None:
    """Slow a command down sideways, if the robot has the ball, to what its dribbler bears."""
    aside = me.limits.carry_aside
    if aside is not None and me.ball_contact:
        chosen.vy = min(aside, max(-aside, chosen.vy))


def drive_gently(
    chosen: RobotCommand, me: RobotState, acceleration: float, turning: float, period: float
) -> None:
    """Slow the change of a command down to a gentler robot's acceleration, the same in every direction.

    Args:
        chosen: the command; changed.
        me: the robot.
        acceleration: speeding up, braking and in curves [m/s^2].
        turning: change of the turning rate [rad/s^2].
        period: time until the next command [s].
    """
    c, s = cos(me.heading), sin(me.heading)
    vx, vy = c * me.vx + s * me.vy, c * me.vy - s * me.vx
    dx, dy = chosen.vx - vx, chosen.vy - vy
    step, most = hypot(dx, dy), acceleration * period
    if step > most:
        chosen.vx, chosen.vy = vx + dx * most / step, vy + dy * most / step
    most = turning * period
    chosen.omega = me.omega + min(most, max(-most, chosen.omega - me.omega))


def turn_with_ball(me: RobotState, heading: float, limits: RobotLimits, period: float) -> RobotCommand:
    """Turn on the spot to ``heading`` [rad] with the ball in the dribbler."""
    turn = command(me, 0.0, 0.0, turn_rate(me, heading, limits, period), limits, period)
    turn.dribbler = True
    return turn


def turn_to(
    me: RobotState, ball: BallState, heading: float, limits: RobotLimits, period: float
) -> RobotCommand:
    """Turn to ``heading`` [rad] with the ball in the dribbler, as the dribbler holds it.

    One strong enough swings the ball round the robot, which turns on the spot. With a weaker one the robot
    turns round the ball, which comes to rest and then needs no pull.

    Args:
        me: the robot, with the ball.
        ball: the ball.
        heading: where the mouth is to point [rad].
        limits: how to turn with the ball.
        period: time until the next command [s].
    """
    own = me.limits
    if limits.max_turn**2 * TOUCH_DISTANCE <= own.hold_acceleration:
        return turn_with_ball(me, heading, limits, period)
    omega = turn_rate(me, heading, limits, period)
    c, s = cos(me.heading), sin(me.heading)
    ahead = max(_PRESS, c * ball.vx + s * ball.vy - own.holds_straight * period)
    vx, vy = ahead * c + omega * (ball.y - me.y), ahead * s - omega * (ball.x - me.x)
    turn = command(me, vx, vy, omega, own, period)
    turn.dribbler = True
    return turn


def velocity_for_kick(me: RobotState, vx: float, vy: float) -> Point:
    """Return the velocity whose part across the heading the ball has after a kick on its first touch [m/s].

    Of its motion along the robot's front the ball keeps the share ``limits.touch_kept``; for the rest it goes
    on with the front. One that is carried has no such motion.

    Args:
        me: the robot as it kicks.
        vx: the ball's velocity along x before the kick [m/s].
        vy: its velocity along y [m/s].
    """
    kept, turning = me.limits.touch_kept, me.omega * MOUTH
    front_x, front_y = me.vx - turning * sin(me.heading), me.vy + turning * cos(me.heading)
    return kept * vx + (1.0 - kept) * front_x, kept * vy + (1.0 - kept) * front_y


def carried_into_kick(me: RobotState, ball: BallState, commanded: float = 0.0) -> float:
    """Return what a kick adds to a ball that moves ahead with the robot, or that the robot drives into [m/s].

    Args:
        me: the robot.
        ball: the ball before its mouth.
        commanded: the velocity ahead that the robot is commanded, which it may reach before it kicks [m/s].
    """
    if me.limits.carried <= 0.0:
        return 0.0
    c, s = cos(me.heading), sin(me.heading)
    ahead = c * ball.vx + s * ball.vy
    if ahead <= -_ROLLS_AT:
        return 0.0
    return me.limits.carried * max(ahead, c * me.vx + s * me.vy, commanded, 0.0)


def sideways_after_kick(me: RobotState, ball: BallState) -> float:
    """Return the velocity across the heading, to the left, that the ball would have after a kick [m/s]."""
    vx, vy = velocity_for_kick(me, ball.vx, ball.vy)
    return cos(me.heading) * vy - sin(me.heading) * vx
