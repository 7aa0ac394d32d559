"""How a robot with certain limits would have moved on its commands, followed from what cameras saw."""

from __future__ import annotations

from math import pi

import numpy as np

from robobt.world.compiled import compilable, compiled, record_dtype
from robobt.world.driving import LocalVelocity, drive, follow
from robobt.world.geometry import FloatArray
from robobt.world.records import ROBOT, Limits, Robot

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


_SIDE = {"side_acceleration": "lateral_acceleration", "side_braking": "lateral_braking"}
_DRIVE_LIMITS = np.dtype(
    [(_SIDE.get(name, name), np.float64) for name in (*DRIVE_PARAMETERS, "separate_axes")]
)
"""The same, by the names of :class:`~robobt.world.records.Limits`; axes always share their limits."""

_VELOCITY = record_dtype(LocalVelocity)


@compilable
def _move(robot: Robot, followed: LocalVelocity, command: LocalVelocity, limits: Limits, dt: float) -> None:
    """Move a robot on by one step under a command, within its limits."""
    follow(followed, command, limits, dt)
    drive(robot, followed, limits, dt)
    robot.x += robot.vx * dt
    robot.y += robot.vy * dt
    robot.heading += robot.omega * dt


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
    # One array, which is used to the end, because records do not keep it.
    state = np.zeros(13 + len(p))
    state[12:-1] = p
    robot, followed = state[:6].view(ROBOT)[0], state[6:9].view(_VELOCITY)[0]
    stand = state[9:12].view(_VELOCITY)[0]
    limits, wanted = state[12:].view(_DRIVE_LIMITS)[0], commands.view(_VELOCITY)[:, 0]
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
                command = wanted[at] if sent[at] + p[0] <= now + 1e-9 else stand
                _move(robot, followed, command, limits, until - now)
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
