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

from math import atan2, cos, hypot, inf, pi, radians, sin, sqrt

from robobt.world.command import RobotCommand
from robobt.world.compiled import compilable, compiled, compiled_merged
from robobt.world.geometry import FloatArray, Point, wrap_angle
from robobt.world.limits import RobotLimits
from robobt.world.records import LIMITS, ROBOT, Limits, Robot, limits_of, robot_of
from robobt.world.state import RobotState

ROBOBULLS_LIMITS = RobotLimits(
    max_speed=1.5,
    acceleration=2.5,
    braking=0.8,
    max_turn=radians(80.0),
    turn_acceleration=radians(1500.0),
    turn_braking=radians(100.0),
)
"""Driving limits of RoboBulls' published code (PilotOmni and config/motion.yaml)."""


_IGNORED_SIDEWAYS_SHARE = 0.25
"""Sideways motion that stops within this share of a period is left out of the plan."""

_ACROSS_FIRST = 1.5
"""Preference of the motion across; found by trial over random starts."""


def drive(
    me: RobotState,
    target: Point,
    heading: float,
    limits: RobotLimits,
    period: float,
    final_speed: float = 0.0,
) -> RobotCommand:
    """Compute the command that brings ``me`` one control period nearer to a pose.

    If the acceleration in ``limits`` is at or above the robot's own, the robot enforces it, because it knows
    its velocity without delay. A lower one is enforced here, by limiting the change of the commanded
    velocity. So is the robot's own limit if the robot reacts late, because its wheels then follow commands
    exactly and slip.

    Args:
        me: the robot.
        target: where to [m].
        heading: where the mouth is to point [rad]; turned to on the way.
        limits: how to drive; usually ``me.limits``.
        period: time until the next command [s].
        final_speed: speed allowed at the target [m/s], for waypoints.
    """
    place = float(target[0]), float(target[1])
    own, given, gentle = _limits(me, limits)
    return RobotCommand(
        *_drive(robot_of(me), place, float(heading), float(final_speed), own, given, gentle, period)
    )


def command(
    me: RobotState, vx: float, vy: float, omega: float, limits: RobotLimits, period: float
) -> RobotCommand:
    """Turn a velocity in field coordinates into a command in the robot's frame.

    It is shortened to ``limits`` and turned back by half of what the robot will
    turn within the period, so that on average it points where it should.

    ``vx`` and ``vy`` are the target velocity at the end of the period [m/s], ``omega`` is the turning rate
    [rad/s], ``period`` the time until the next command [s].
    """
    own, given, gentle = _limits(me, limits)
    velocity = float(vx), float(vy)
    return RobotCommand(*_command(robot_of(me), velocity, float(omega), own, given, gentle, period))


def turn_rate(me: RobotState, heading: float, limits: RobotLimits, period: float) -> float:
    """Compute the turning rate to command now so as to end at ``heading`` [rad/s]."""
    return _turn_rate(robot_of(me), float(heading), limits_of(me.limits), limits_of(limits), period)


def travel_time(distance: float, speed: float, limits: RobotLimits) -> float:
    """Compute the time to cover ``distance`` and stop there: the trapezoid optimum [s].

    ``speed`` is that towards the target at the start, negative when it is away from it [m/s].
    """
    return stop_time(distance, speed, limits.acceleration, limits.braking, limits.max_speed)


@compilable
def roughly(heading: float, wanted: float, slack: float) -> float:
    """Return the heading nearest to the present one that is within ``slack`` of the wanted one [rad].

    A robot that only has to face a point roughly keeps its heading while the point moves a little; facing it
    exactly would make the robot swing back and forth.
    """
    error = wrap_angle(wanted - heading)
    if abs(error) <= slack:
        return heading
    return wanted - slack if error > 0.0 else wanted + slack


def _limits(me: RobotState, limits: RobotLimits) -> tuple[FloatArray, FloatArray, bool]:
    """Return the robot's own limits, the given ones, and whether the robot does not keep to them itself."""
    return limits_of(me.limits), limits_of(limits), limits is not me.limits or me.limits.trailing_time > 0.0


@compiled
def _drive(
    me_: FloatArray,
    target: Point,
    heading: float,
    final_speed: float,
    own_: FloatArray,
    given_: FloatArray,
    gentle: bool,
    period: float,
) -> tuple[float, float, float]:
    me, own, given = me_.view(ROBOT)[0], own_.view(LIMITS)[0], given_.view(LIMITS)[0]
    return drive_law(me, target, heading, final_speed, own, given, gentle, period)


@compiled
def _command(
    me_: FloatArray,
    velocity: Point,
    omega: float,
    own_: FloatArray,
    given_: FloatArray,
    gentle: bool,
    period: float,
) -> tuple[float, float, float]:
    own: Limits = own_.view(LIMITS)[0]
    given: Limits = given_.view(LIMITS)[0]
    return command_law(me_.view(ROBOT)[0], velocity, omega, own, given, given.max_speed, gentle, period)


@compiled
def _turn_rate(me_: FloatArray, heading: float, own_: FloatArray, given_: FloatArray, period: float) -> float:
    return turn_law(me_.view(ROBOT)[0], heading, own_.view(LIMITS)[0], given_.view(LIMITS)[0], period)


@compiled_merged
def drive_law(
    me: Robot,
    target: Point,
    heading: float,
    final_speed: float,
    own: Limits,
    given: Limits,
    gentle: bool,
    period: float,
) -> tuple[float, float, float]:
    """Return the command of :func:`drive`: velocity ahead and to the left [m/s], and turning rate [rad/s].

    Args:
        me: the robot.
        target: where to [m].
        heading: where the mouth is to point [rad].
        final_speed: speed allowed at the target [m/s].
        own: what the robot can do.
        given: how it is to be driven.
        gentle: whether not to ask for more change of velocity than that.
        period: time until the next command [s].
    """
    top = given.max_speed
    velocity = wanted_velocity(me, target, final_speed, own, given, top, period)
    omega = turn_law(me, heading, own, given, period)
    return command_law(me, velocity, omega, own, given, top, gentle, period)


@compiled
def wanted_velocity(
    me: Robot, target: Point, final_speed: float, own: Limits, given: Limits, top: float, period: float
) -> Point:
    """Return the velocity in field coordinates that :func:`drive_law` asks for, at most ``top`` [m/s]."""
    dx, dy = target[0] - me.x, target[1] - me.y
    distance = hypot(dx, dy)
    vx = vy = 0.0
    stands = period + 2.0 * own.trailing_time
    if distance > 0.0:
        ux, uy = dx / distance, dy / distance
        bearing = atan2(uy, ux) - me.heading
        acceleration = along(given.acceleration, given.lateral_acceleration, bearing)
        braking = along(given.braking, given.lateral_braking, bearing)
        ahead, across = ux * me.vx + uy * me.vy, ux * me.vy - uy * me.vx
        distance += final_speed * final_speed / (2.0 * braking)
        if abs(across) < _IGNORED_SIDEWAYS_SHARE * braking * stands:
            ahead = approach_speed(distance, ahead, top, acceleration, braking, stands)
            across = 0.0
        else:
            sideways = along(given.braking, given.lateral_braking, bearing + 0.5 * pi)
            ahead, across = _turning_in(
                distance, ahead, across, given, top, acceleration, braking, sideways, stands
            )
        vx, vy = ux * ahead - uy * across, uy * ahead + ux * across
    return vx, vy


@compiled
def command_law(
    me: Robot,
    velocity: Point,
    omega: float,
    own: Limits,
    given: Limits,
    top: float,
    gentle: bool,
    period: float,
) -> tuple[float, float, float]:
    """Return the command of :func:`command`, for a velocity of at most ``top`` [m/s].

    The rest is as for :func:`drive_law`.
    """
    vx, vy = velocity
    squared = vx * vx + vy * vy
    if squared > top * top:
        scale = top / sqrt(squared)
        vx, vy = vx * scale, vy * scale
    if gentle:
        vx, vy = _gentle(me, vx, vy, own, given, period)
    heading = me.heading + 0.5 * omega * period
    c, s = cos(heading), sin(heading)
    return c * vx + s * vy, c * vy - s * vx, omega


@compiled
def turn_law(me: Robot, heading: float, own: Limits, given: Limits, period: float) -> float:
    """Return the turning rate of :func:`turn_rate` [rad/s]; the rest is as for :func:`drive_law`."""
    omega = me.omega
    error = wrap_angle(heading - me.heading)
    side = 1.0 if error >= 0.0 else -1.0
    stands = period + 2.0 * own.trailing_time
    rate = side * approach_speed(
        side * error, side * omega, given.max_turn, given.turn_acceleration, given.angular_braking, stands
    )
    if given.turn_acceleration < own.turn_acceleration:
        step = given.turn_acceleration * (period + own.trailing_time)
        rate = min(omega + step, max(omega - step, rate))
    return rate


@compilable
def approach_speed(
    distance: float, speed: float, cruise: float, acceleration: float, braking: float, period: float
) -> float:
    """Compute the highest speed at the end of a period from which the robot can still stop in time.

    The robot is taken to change to that speed at its limit and to hold it for
    the rest of the period. Unit of length is free: metres or radians.

    ``distance`` is the remaining distance, not negative, ``speed`` the present speed towards the target,
    ``cruise`` the largest result; it works for angles and distances.
    """
    v = speed if speed > 0.0 else 0.0
    # Distance within the period while braking to w, and from w to rest: w * period + (v - w)^2 / (2 *
    # braking) + w^2 / (2 * braking).
    if v * period + v * v / (2.0 * braking) > distance:
        half = 0.5 * (v - braking * period)
        root = half * half - 0.5 * v * v + braking * distance
        return min(cruise, max(0.0, half + sqrt(root))) if root > 0.0 else 0.0
    # While speeding up to w: w * period - (w - v)^2 / (2 * acceleration), then to rest.
    a = 0.5 / braking - 0.5 / acceleration
    b = period + v / acceleration
    c = distance + 0.5 * v * v / acceleration
    root = b * b + 4.0 * a * c
    return min(cruise, 2.0 * c / (b + sqrt(root))) if root > 0.0 else cruise


@compilable
def stop_time(distance: float, speed: float, a: float, b: float, cruise: float) -> float:
    """Like :func:`travel_time`, with acceleration a, braking b and top speed."""
    begun = 0.0
    if speed < 0.0:
        begun, distance, speed = -speed / b, distance + speed * speed / (2.0 * b), 0.0
    if speed * speed / (2.0 * b) > distance:
        begun, distance, speed = begun + speed / b, speed * speed / (2.0 * b) - distance, 0.0
    peak = sqrt((distance + 0.5 * speed * speed / a) / (0.5 / a + 0.5 / b))
    if peak <= cruise or speed >= cruise:
        peak = max(peak, speed) if speed < cruise else speed
        used = (peak * peak - speed * speed) / (2.0 * a) + peak * peak / (2.0 * b)
        rest = (peak - speed) / a + peak / b + max(0.0, distance - used) / peak if peak > 0.0 else 0.0
        return begun + rest
    used = (cruise * cruise - speed * speed) / (2.0 * a) + cruise * cruise / (2.0 * b)
    return begun + ((cruise - speed) / a + cruise / b + (distance - used) / cruise)


@compilable
def along(forward: float, lateral: float, bearing: float) -> float:
    """Return the limit along ``bearing`` from the heading, between its forward and sideways values."""
    if forward == lateral:
        return forward
    return 1.0 / hypot(cos(bearing) / forward, sin(bearing) / lateral)


@compilable
def _turning_in(
    distance: float,
    ahead: float,
    across: float,
    given: Limits,
    top: float,
    acceleration: float,
    braking: float,
    sideways: float,
    period: float,
) -> Point:
    """Compute the velocity ahead and across for a robot that does not drive straight at its target.

    Both parts share the wheels' acceleration in proportion to the time each needs. Always commanding the
    target speed ahead would leave no acceleration to stop the motion across, and the robot would circle its
    target forever.
    """
    time_ahead = max(1e-6, stop_time(distance, ahead, given.acceleration, given.braking, top))
    drift = abs(across)
    back = 0.5 * drift * drift / sideways
    time_across = drift / sideways + stop_time(back, 0.0, given.acceleration, given.braking, top)
    ratio = _ACROSS_FIRST * time_across / time_ahead
    share_ahead = 1.0 / sqrt(1.0 + ratio * ratio)
    share_across = ratio * share_ahead
    target = approach_speed(distance, ahead, top, acceleration * share_ahead, braking * share_ahead, period)
    change = target - ahead
    rate = acceleration if change > 0.0 and ahead >= 0.0 else braking
    step = min(abs(change), rate * share_ahead * period)
    step_across = min(drift, sideways * share_across * period)
    # Only the direction of the change matters; the robot limits its size.
    stretch = min(abs(change) / step if step > 0.0 else inf, drift / step_across)
    change = step * stretch if change > 0.0 else -step * stretch
    across -= step_across * stretch if across > 0.0 else -step_across * stretch
    return (ahead + change, across)


@compilable
def _gentle(me: Robot, vx: float, vy: float, own: Limits, given: Limits, period: float) -> Point:
    """Return the velocity that may be asked for on the way from its own to (vx, vy)."""
    dx, dy = vx - me.vx, vy - me.vy
    change = hypot(dx, dy)
    if change == 0.0:
        return (vx, vy)
    bearing = atan2(dy, dx) - me.heading
    rate = along(given.acceleration, given.lateral_acceleration, bearing)
    lead = own.trailing_time
    if rate >= along(own.acceleration, own.lateral_acceleration, bearing):
        lead *= 2.0
        if lead == 0.0:
            rate = inf
    if vx * vx + vy * vy < me.vx * me.vx + me.vy * me.vy:
        rate = max(rate, along(given.braking, given.lateral_braking, bearing))
    most = rate * (period + lead)
    if change <= most:
        return (vx, vy)
    share = most / change
    return (me.vx + dx * share, me.vy + dy * share)
