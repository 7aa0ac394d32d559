"""Not running into others, compiled: opponents while the ball is not in play, and mates.

Source of the limit: RoboCup SSL rules, chapter "Crashing": the relative velocity along the line of centres,
1.5 m/s, of which the slower robot is free.
"""

from __future__ import annotations

from math import cos, hypot, sin, sqrt

from robobt.motion.arrival import VX, VY, X, Y
from robobt.world.compiled import compiled
from robobt.world.geometry import FloatArray, Point
from robobt.world.state import ROBOT_RADIUS

_CLOSING = 1.0
"""Closing speed at which opponents may touch [m/s]."""

_GENTLY = 0.3
"""The same of mates, who gain nothing by it [m/s]."""

_BRAKING = 2.0
"""How hard to brake for it, less than any robot can [m/s^2]."""

_LOOK = 1.5
"""Opponents with a wider gap are left out [m]."""


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
        ox, oy = others[i, VX], others[i, VY]
        dx, dy = others[i, X] - x, others[i, Y] - y
        centres = hypot(dx, dy)
        gap = max(0.0, centres - 2.0 * ROBOT_RADIUS)
        if i == skip or gap > _LOOK or centres == 0.0:
            continue
        nx, ny = dx / centres, dy / centres
        # Only where it would be hit: what passes by does not matter.
        across = abs(nx * (vy - oy) - ny * (vx - ox))
        closing = nx * (vx - ox) + ny * (vy - oy)
        if closing <= 0.0 or across * gap > closing * 3.0 * ROBOT_RADIUS:
            continue
        coming = max(0.0, -(nx * ox + ny * oy))
        touching = _GENTLY if i < mates else _CLOSING
        most = max(0.0, sqrt(touching * touching + 2.0 * _BRAKING * gap) - coming)
        towards = nx * vx + ny * vy
        if towards > most:
            vx, vy = vx - (towards - most) * nx, vy - (towards - most) * ny
            changed = True
    return (c * vx + s * vy, c * vy - s * vx) if changed else (ahead, left)
