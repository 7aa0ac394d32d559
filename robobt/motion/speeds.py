"""The arithmetic of :mod:`robobt.motion.pilot`, compiled.

A robot's state and limits come as arrays: numba would compile anew for every mixture of int and float.
"""

from __future__ import annotations

from math import atan2, cos, hypot, inf, pi, sin, sqrt

import numpy as np

from robobt.world.compiled import compilable, compiled
from robobt.world.geometry import FloatArray, Point, wrap_angle
from robobt.world.limits import RobotLimits

_STRAIGHT = 0.25
"""Sideways motion that stops within this share of a period is left out of the plan."""

_ACROSS_FIRST = 1.5
"""How much the motion across is preferred; found by trial over random starts."""

_MOST_KNOWN = 256
TOP, FORWARD, LATERAL, BRAKING, LATERAL_BRAKING, TURN, TURN_FASTER, TURN_SLOWER, REACTION = range(9)


_KNOWN: dict[int, tuple[RobotLimits, FloatArray]] = {}
"""By the limits' id, which stays theirs as they are kept too: hashing and comparing a model takes longer."""


def numbers(limits: RobotLimits) -> FloatArray:
    """Return what compiled code needs of a robot's limits, with the columns above."""
    known = _KNOWN.get(id(limits))
    if known is None:
        if len(_KNOWN) >= _MOST_KNOWN:
            _KNOWN.clear()
        row = (
            limits.max_speed,
            limits.acceleration,
            limits.lateral_acceleration,
            limits.braking,
            limits.lateral_braking,
            limits.max_turn,
            limits.turn_acceleration,
            limits.angular_braking,
            limits.reaction,
        )
        known = _KNOWN[id(limits)] = (limits, np.array(row, dtype=np.float64))
    return known[1]


@compiled
def drive_numbers(
    state: FloatArray, task: FloatArray, own: FloatArray, given: FloatArray, gentle: bool, period: float
) -> tuple[float, float, float]:
    """Do what :func:`robobt.motion.pilot.drive` does.

    Args:
        state: x, y, heading, vx, vy and omega.
        task: x and y of the target, the heading wanted and the speed allowed at the target.
        own: what the robot can do.
        given: how it is to be driven.
        gentle: whether not to ask for more change of velocity than that.
        period: time until the next command [s].
    """
    vx, vy = wanted_velocity(state, task, own, given, period)
    rate = turn_rate_numbers(state, task[2], own, given, period)
    return command_numbers(state, vx, vy, rate, own, given, gentle, period)


@compiled
def wanted_velocity(
    state: FloatArray, task: FloatArray, own: FloatArray, given: FloatArray, period: float
) -> Point:
    """Return the velocity in field coordinates that :func:`drive_numbers` asks for; arguments as there."""
    px, py, turned, svx, svy = state[0], state[1], state[2], state[3], state[4]
    x, y, final_speed = task[0], task[1], task[3]
    dx, dy = x - px, y - py
    distance = hypot(dx, dy)
    vx = vy = 0.0
    stands = period + 2.0 * own[REACTION]
    if distance > 0.0:
        ux, uy = dx / distance, dy / distance
        bearing = atan2(uy, ux) - turned
        acceleration = along(given[FORWARD], given[LATERAL], bearing)
        braking = along(given[BRAKING], given[LATERAL_BRAKING], bearing)
        ahead, across = ux * svx + uy * svy, ux * svy - uy * svx
        distance += final_speed * final_speed / (2.0 * braking)
        if abs(across) < _STRAIGHT * braking * stands:
            ahead = approach_speed(distance, ahead, given[TOP], acceleration, braking, stands)
            across = 0.0
        else:
            sideways = along(given[BRAKING], given[LATERAL_BRAKING], bearing + 0.5 * pi)
            ahead, across = _turning_in(
                distance, ahead, across, given, acceleration, braking, sideways, stands
            )
        vx, vy = ux * ahead - uy * across, uy * ahead + ux * across
    return vx, vy


@compiled
def command_numbers(
    state: FloatArray,
    vx: float,
    vy: float,
    omega: float,
    own: FloatArray,
    given: FloatArray,
    gentle: bool,
    period: float,
) -> tuple[float, float, float]:
    """Do what :func:`robobt.motion.pilot.command` does; the rest is as for :func:`drive_numbers`."""
    squared = vx * vx + vy * vy
    if squared > given[TOP] * given[TOP]:
        scale = given[TOP] / sqrt(squared)
        vx, vy = vx * scale, vy * scale
    if gentle:
        vx, vy = _gentle(state[2], state[3], state[4], vx, vy, own, given, period)
    heading = state[2] + 0.5 * omega * period
    c, s = cos(heading), sin(heading)
    return c * vx + s * vy, c * vy - s * vx, omega


@compiled
def turn_rate_numbers(
    state: FloatArray, heading: float, own: FloatArray, given: FloatArray, period: float
) -> float:
    """Do what :func:`robobt.motion.pilot.turn_rate` does; the rest is as for :func:`drive_numbers`."""
    omega = state[5]
    error = wrap_angle(heading - state[2])
    side = 1.0 if error >= 0.0 else -1.0
    stands = period + 2.0 * own[REACTION]
    rate = side * approach_speed(
        side * error, side * omega, given[TURN], given[TURN_FASTER], given[TURN_SLOWER], stands
    )
    if given[TURN_FASTER] < own[TURN_FASTER]:
        step = given[TURN_FASTER] * (period + own[REACTION])
        rate = min(omega + step, max(omega - step, rate))
    return rate


@compilable
def approach_speed(
    distance: float, speed: float, cruise: float, acceleration: float, braking: float, period: float
) -> float:
    """Compute the highest speed at the end of a period from which the robot can still stop in time.

    The robot is taken to change to that speed at its limit and to hold it for
    the rest of the period. Unit of length is free: metres or radians.

    ``distance`` is what is left, not negative, ``speed`` that towards the target now, ``cruise`` the most to
    return; of angles as of ways.
    """
    v = speed if speed > 0.0 else 0.0
    # Way made within the period while braking to w, and from w to rest:
    # w * period + (v - w)^2 / (2 * braking) + w^2 / (2 * braking).
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
    """Do what :func:`robobt.motion.pilot.travel_time` does, with acceleration a, braking b and top speed."""
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
    given: FloatArray,
    acceleration: float,
    braking: float,
    sideways: float,
    period: float,
) -> Point:
    """Compute the velocity ahead and across for a robot that does not drive straight at its target.

    Both parts share what the wheels can do in proportion to the time each needs.
    Commanding the target speed ahead regardless would leave nothing to stop the
    motion across, and the robot would circle its target for ever.
    """
    time_ahead = max(1e-6, stop_time(distance, ahead, given[FORWARD], given[BRAKING], given[TOP]))
    drift = abs(across)
    back = 0.5 * drift * drift / sideways
    time_across = drift / sideways + stop_time(back, 0.0, given[FORWARD], given[BRAKING], given[TOP])
    ratio = _ACROSS_FIRST * time_across / time_ahead
    share_ahead = 1.0 / sqrt(1.0 + ratio * ratio)
    share_across = ratio * share_ahead
    target = approach_speed(
        distance, ahead, given[TOP], acceleration * share_ahead, braking * share_ahead, period
    )
    change = target - ahead
    rate = acceleration if change > 0.0 and ahead >= 0.0 else braking
    step = min(abs(change), rate * share_ahead * period)
    step_across = min(drift, sideways * share_across * period)
    # The direction of the change is what matters; how far it gets is the robot's affair.
    stretch = min(abs(change) / step if step > 0.0 else inf, drift / step_across)
    change = step * stretch if change > 0.0 else -step * stretch
    across -= step_across * stretch if across > 0.0 else -step_across * stretch
    return (ahead + change, across)


@compilable
def _gentle(
    turned: float,
    svx: float,
    svy: float,
    vx: float,
    vy: float,
    own: FloatArray,
    given: FloatArray,
    period: float,
) -> Point:
    """Return the velocity that may be asked for on the way from (svx, svy) to (vx, vy)."""
    dx, dy = vx - svx, vy - svy
    change = hypot(dx, dy)
    if change == 0.0:
        return (vx, vy)
    bearing = atan2(dy, dx) - turned
    rate = along(given[FORWARD], given[LATERAL], bearing)
    lead = own[REACTION]
    if rate >= along(own[FORWARD], own[LATERAL], bearing):
        lead *= 2.0
        if lead == 0.0:
            rate = inf
    if vx * vx + vy * vy < svx * svx + svy * svy:
        rate = max(rate, along(given[BRAKING], given[LATERAL_BRAKING], bearing))
    most = rate * (period + lead)
    if change <= most:
        return (vx, vy)
    share = most / change
    return (svx + dx * share, svy + dy * share)
