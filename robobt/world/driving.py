"""How a robot follows its command: lag, gains and cross-talk of its axes, speed, acceleration and braking.

The one law of the simulator, predictions, the vision's filter and identification. Python and compiled code
both call it.
"""

from __future__ import annotations

from math import cos, exp, hypot, sin, sqrt
from typing import Protocol

from robobt.world.command import RobotCommand
from robobt.world.compiled import compilable
from robobt.world.limits import RobotLimits
from robobt.world.records import Limits, Robot


class LocalVelocity(Protocol):
    """A velocity in a robot's frame, ahead and to the left [m/s], and a turning rate [rad/s]."""

    vx: float
    vy: float
    omega: float


_ARRIVED = 1e-9
"""Difference from a command below which it is followed exactly [m/s, rad/s]."""

_ROUNDING_SHARE = 1.0 - 1e-9
"""Tolerance, so that rounding does not exaggerate a change of velocity."""


@compilable
def follow(
    followed: LocalVelocity, command: LocalVelocity | RobotCommand, limits: Limits | RobotLimits, dt: float
) -> None:
    """Let a robot's controller follow its command with the lag of each axis."""
    followed.vx = approached(followed.vx, command.vx, limits.lag, dt)
    followed.vy = approached(followed.vy, command.vy, limits.side_lag, dt)
    followed.omega = approached(followed.omega, command.omega, limits.turn_lag, dt)


@compilable
def approached(value: float, target: float, lag: float, dt: float) -> float:
    """Return a value that has approached its target for ``dt`` [s] with a first-order lag [s]."""
    # It arrives: a speed of 1e-310 has no direction that wheels could take.
    if lag <= 0.0 or abs(value - target) < _ARRIVED:
        return target
    return target + (value - target) * exp(-dt / lag)


@compilable
def reached(followed: LocalVelocity, limits: Limits | RobotLimits) -> tuple[float, float, float]:
    """Return what a robot makes of the velocity that it follows: gains and cross-talk of its axes."""
    vx, vy = followed.vx, followed.vy
    return (
        limits.gain * vx + limits.cross_ahead * vy,
        limits.side_gain * vy + limits.cross_aside * vx,
        limits.turn_gain * followed.omega,
    )


@compilable
def _within(change: float, speed: float, faster: float, slower: float) -> float:
    """Return the change of an axis's speed, limited by what speeds it up and what slows it down."""
    most = slower if change * speed < 0.0 else faster
    return max(-most, min(most, change))


@compilable
def _within_ellipse(
    dx: float, dy: float, robot: Robot, c: float, s: float, limits: Limits | RobotLimits, dt: float
) -> tuple[float, float]:
    """Return a change of velocity, limited by an ellipse in the robot's frame: all wheels share the load."""
    if dx * robot.vx + dy * robot.vy < 0.0:
        along, across = limits.braking, limits.lateral_braking
    else:
        along, across = limits.acceleration, limits.lateral_acceleration
    # A change within the weaker limit needs no further check.
    weaker = along if along < across else across
    if abs(dx) + abs(dy) > _ROUNDING_SHARE * weaker * dt:
        step = hypot(dx, dy)
        ahead = (c * dx + s * dy) / step
        aside = (c * dy - s * dx) / step
        most = dt / sqrt((ahead / along) ** 2 + (aside / across) ** 2)
        if step > most:
            dx *= most / step
            dy *= most / step
    return dx, dy


@compilable
def drive(robot: Robot, followed: LocalVelocity, limits: Limits | RobotLimits, dt: float) -> None:
    """Move a robot's velocity towards the one that it follows, within its limits."""
    c, s = cos(robot.heading), sin(robot.heading)
    target_vx, target_vy, target_omega = reached(followed, limits)
    if abs(target_vx) + abs(target_vy) > limits.max_speed:
        speed = hypot(target_vx, target_vy)
        if speed > limits.max_speed:
            target_vx *= limits.max_speed / speed
            target_vy *= limits.max_speed / speed
    dx = c * target_vx - s * target_vy - robot.vx
    dy = s * target_vx + c * target_vy - robot.vy
    if limits.separate_axes:
        ahead = _within(
            c * dx + s * dy, c * robot.vx + s * robot.vy, limits.acceleration * dt, limits.braking * dt
        )
        aside = _within(
            c * dy - s * dx,
            c * robot.vy - s * robot.vx,
            limits.lateral_acceleration * dt,
            limits.lateral_braking * dt,
        )
        dx, dy = c * ahead - s * aside, s * ahead + c * aside
    else:
        dx, dy = _within_ellipse(dx, dy, robot, c, s, limits, dt)
    robot.vx += dx
    robot.vy += dy
    top = limits.max_turn
    if target_omega > top:
        target_omega = top
    elif target_omega < -top:
        target_omega = -top
    turn, most = target_omega - robot.omega, limits.turn_acceleration * dt
    if turn > most:
        turn = most
    elif turn < -most:
        turn = -most
    robot.omega += turn
