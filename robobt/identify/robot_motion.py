"""How a robot with certain limits would have moved on its commands, followed from what cameras saw."""

from __future__ import annotations

from math import cos, hypot, pi, sin, sqrt

import numpy as np

from robobt.world.compiled import compilable, compiled
from robobt.world.driving import approached
from robobt.world.geometry import FloatArray

DRIVE_PARAMETERS = (
    "delay",
    "max_speed",
    "acceleration",
    "braking",
    "side_acceleration",
    "side_braking",
    "max_turn",
    "turn_acceleration",
    "gain",
    "side_gain",
    "turn_gain",
    "lag",
    "side_lag",
    "turn_lag",
    "cross_ahead",
    "cross_aside",
)
"""What :func:`motion_after` takes, in this order [s, m/s, m/s^2, rad/s, rad/s^2, shares, s, shares]."""

_MOTION_STEP = 1 / 240
"""Longest step of the motion [s]."""

_LEAST_SPAN = 1e-3
"""Pictures nearer in time than this tell nothing of a speed [s]."""


@compilable
def _drive(state: FloatArray, vx: float, vy: float, omega: float, p: FloatArray, dt: float) -> None:
    """Move a state on by one step under a command, within the limits.

    It is x, y, heading, vx, vy, omega, and the velocity that the robot's controller follows.
    """
    c, s = cos(state[2]), sin(state[2])
    state[6] = approached(state[6], vx, p[11], dt)
    state[7] = approached(state[7], vy, p[12], dt)
    state[8] = approached(state[8], omega, p[13], dt)
    vx = state[6] * p[8] + state[7] * p[14]
    vy = state[7] * p[9] + state[6] * p[15]
    omega = state[8] * p[10]
    speed = hypot(vx, vy)
    if speed > p[1]:
        vx *= p[1] / speed
        vy *= p[1] / speed
    dx = c * vx - s * vy - state[3]
    dy = s * vx + c * vy - state[4]
    step = hypot(dx, dy)
    if step > 0.0:
        along, across = p[2], p[4]
        if dx * state[3] + dy * state[4] < 0.0:
            along, across = p[3], p[5]
        ahead, aside = (c * dx + s * dy) / step, (c * dy - s * dx) / step
        most = dt / sqrt((ahead / along) ** 2 + (aside / across) ** 2)
        share = min(1.0, most / step)
        state[3] += dx * share
        state[4] += dy * share
    turn = min(max(omega, -p[6]), p[6]) - state[5]
    most = p[7] * dt
    state[5] += min(max(turn, -most), most)
    state[0] += state[3] * dt
    state[1] += state[4] * dt
    state[2] += state[5] * dt


@compiled
def motion_after(
    p: FloatArray,
    times: FloatArray,
    poses: FloatArray,
    sent: FloatArray,
    commands: FloatArray,
    trust: FloatArray,
    patience: float,
) -> FloatArray:
    """Predict each pose from those before it and the commands in force, and return by how much it misses.

    An observer with constant gains: what is seen corrects the predicted place and speed by a share.

    Args:
        p: (16,) the robot's limits, as in :data:`DRIVE_PARAMETERS`.
        times: (T,) of the pictures [s].
        poses: (T, 3) what was seen; NaN where it was not.
        sent: (C,) when commands were sent, at least one [s].
        commands: (C, 3) vx, vy, omega that were sent.
        trust: (4,) share of a miss by which place, speed (a period), heading and turning rate are corrected.
        patience: the observer starts again after this time without a sight [s].

    Returns:
        (T, 3) misses in x, y [m] and heading [rad]; NaN where nothing can be said.
    """
    count, last_sent = len(times), len(sent) - 1
    misses = np.full((count, 3), np.nan)
    state = np.zeros(9)
    known, last, at = False, 0.0, 0
    for i in range(count):
        if known:
            # The commands in force between the pictures, each from its time plus the delay on.
            now = times[i - 1]
            while now < times[i] - 1e-9:
                while at < last_sent and sent[at + 1] + p[0] <= now + 1e-9:
                    at += 1
                until = times[i]
                if at < last_sent and sent[at + 1] + p[0] < until:
                    until = sent[at + 1] + p[0]
                until = min(until, now + _MOTION_STEP)
                if sent[at] + p[0] <= now + 1e-9:
                    _drive(state, commands[at, 0], commands[at, 1], commands[at, 2], p, until - now)
                else:
                    _drive(state, 0.0, 0.0, 0.0, p, until - now)
                now = until
        if np.isnan(poses[i, 0]):
            continue
        if not known or times[i] - last > patience:
            state[:3], state[3:6] = poses[i], 0.0
            known = True
        else:
            span = times[i] - last
            for axis in range(3):
                miss = poses[i, axis] - state[axis]
                if axis == 2:
                    miss = (miss + pi) % (2.0 * pi) - pi
                misses[i, axis] = miss
                place, rate = (trust[0], trust[1]) if axis < 2 else (trust[2], trust[3])
                state[axis] += place * miss
                if span > _LEAST_SPAN:
                    state[axis + 3] += rate * miss / span
        last = times[i]
    return misses
