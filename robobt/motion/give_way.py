"""Not running into others, compiled: opponents while the ball is not in play, and mates.

Source of the limit: RoboCup SSL rules, chapter "Crashing": the relative velocity along the line of centres,
1.5 m/s, of which the slower robot is free.
"""

from __future__ import annotations

from math import cos, hypot, sin, sqrt

import numpy as np

from robobt.motion.arrival import VX, VY, X, Y, movers_of
from robobt.world.command import RobotCommand
from robobt.world.compiled import compiled
from robobt.world.geometry import FloatArray, Point
from robobt.world.state import ROBOT_RADIUS, Frame, RobotState

_CLOSING = 1.0
"""Closing speed at which opponents may touch [m/s]."""

_GENTLY = 0.3
"""The same of mates, who gain nothing by it [m/s]."""

_BRAKING = 2.0
"""How hard to brake for it, less than any robot can [m/s^2]."""

_LOOK = 1.5
"""Opponents with a wider gap are left out [m]."""

_IN_PLAY = 1.3
"""Closing speed at which opponents may touch while the ball is in play, some way below the rules' [m/s]."""

_SLOWER = 0.4
"""A robot that is so much slower than the opponent that comes at it is not at fault [m/s]."""

_BRAKES = 0.7
"""Share of its braking that a robot uses for it in play."""


def avoid_crash(frame: Frame, me: RobotState, order: RobotCommand) -> RobotCommand:
    """Return the command without what would be the robot's crash into an opponent while the ball is in play.

    It may still drive at the ball between them: only how fast the two touch is limited, and an opponent
    that comes on faster is at fault itself.

    Args:
        frame: what is on the field.
        me: the robot.
        order: what it was to do; changed in place.
    """
    if frame.game.in_play and (order.vx != 0.0 or order.vy != 0.0):
        now = np.array((me.x, me.y, me.heading, order.vx, order.vy))
        theirs = movers_of(frame)[len(frame.own) :]
        order.vx, order.vy = slowed_in_play(now, theirs, _BRAKES * me.limits.braking)
    return order


@compiled
def slowed_in_play(now: FloatArray, others: FloatArray, braking: float) -> Point:
    """Return the velocity ahead and to the left, slowed down towards every opponent that it would crash into.

    Args:
        now: place and heading of the robot, and the velocity ahead and to the left that it is to have.
        others: the opponents, as of :func:`~robobt.motion.arrival.movers`.
        braking: how hard to brake for it [m/s^2].
    """
    x, y, ahead, left = now[0], now[1], now[3], now[4]
    c, s = cos(now[2]), sin(now[2])
    vx, vy = c * ahead - s * left, s * ahead + c * left
    changed = False
    for i in range(len(others)):
        gap, nx, ny = _meeting(x, y, vx, vy, others, i)
        if gap < 0.0:
            continue
        coming = -(nx * others[i, VX] + ny * others[i, VY])
        most = max(coming - _SLOWER, sqrt(_IN_PLAY * _IN_PLAY + 2.0 * braking * gap) - coming)
        towards = nx * vx + ny * vy
        if towards > most:
            vx, vy = vx - (towards - most) * nx, vy - (towards - most) * ny
            changed = True
    return (c * vx + s * vy, c * vy - s * vx) if changed else (ahead, left)


@compiled
def slowed_towards(now: FloatArray, others: FloatArray, skip: int, mates: int) -> Point:
    """Return the velocity ahead and to the left, slowed down towards every robot that it would run into.

    Of two robots that drive at each other each lets the other be the faster one: neither drives on
    faster than leaves room to brake, and an oncoming robot uses that room up.

    Args:
        now: place and heading of the robot, and the velocity ahead and to the left that it is to have.
        others: the robots, as of :func:`~robobt.motion.arrival.movers`.
        skip: the row among them of the robot itself, -1 for none.
        mates: how many of them, the first ones, are of its own team.
    """
    x, y, ahead, left = now[0], now[1], now[3], now[4]
    c, s = cos(now[2]), sin(now[2])
    vx, vy = c * ahead - s * left, s * ahead + c * left
    changed = False
    for i in range(len(others)):
        gap, nx, ny = _meeting(x, y, vx, vy, others, i)
        if i == skip or gap < 0.0:
            continue
        coming = max(0.0, -(nx * others[i, VX] + ny * others[i, VY]))
        touching = _GENTLY if i < mates else _CLOSING
        most = max(0.0, sqrt(touching * touching + 2.0 * _BRAKING * gap) - coming)
        towards = nx * vx + ny * vy
        if towards > most:
            vx, vy = vx - (towards - most) * nx, vy - (towards - most) * ny
            changed = True
    return (c * vx + s * vy, c * vy - s * vx) if changed else (ahead, left)


@compiled
def _meeting(
    x: float, y: float, vx: float, vy: float, others: FloatArray, i: int
) -> tuple[float, float, float]:
    """Return the gap to a robot that would be hit and the direction to it; -1 where it passes by."""
    dx, dy = others[i, X] - x, others[i, Y] - y
    centres = hypot(dx, dy)
    gap = max(0.0, centres - 2.0 * ROBOT_RADIUS)
    if gap > _LOOK or centres == 0.0:
        return -1.0, 0.0, 0.0
    nx, ny = dx / centres, dy / centres
    across = abs(nx * (vy - others[i, VY]) - ny * (vx - others[i, VX]))
    closing = nx * (vx - others[i, VX]) + ny * (vy - others[i, VY])
    if closing <= 0.0 or across * gap > closing * 3.0 * ROBOT_RADIUS:
        return -1.0, 0.0, 0.0
    return gap, nx, ny
