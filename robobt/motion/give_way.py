"""Not running into opponents while the ball is not in play.

Source of the limit: RoboCup SSL rules, chapter "Crashing": the relative velocity along the line of centres,
1.5 m/s, of which the slower robot is free.
"""

from __future__ import annotations

from math import cos, hypot, sin, sqrt

from robobt.world.command import RobotCommand
from robobt.world.state import ROBOT_RADIUS, Frame, RobotState

_CLOSING = 1.0
"""Closing speed at which robots may touch [m/s]."""

_BRAKING = 2.0
"""How hard to brake for it, less than any robot can [m/s^2]."""

_LOOK = 1.5
"""Opponents with a wider gap are left out [m]."""


def give_way(frame: Frame, me: RobotState, order: RobotCommand, *, mates: bool = False) -> RobotCommand:
    """Return the command, slowed down towards every opponent that it would run into.

    Of two robots that drive at each other each lets the other be the faster one: neither drives on
    faster than leaves room to brake, and an oncoming robot uses that room up.
    """
    c, s = cos(me.heading), sin(me.heading)
    vx, vy = c * order.vx - s * order.vy, s * order.vx + c * order.vy
    changed = False
    for other in frame.others(me.id) if mates else frame.opponents:
        dx, dy = other.x - me.x, other.y - me.y
        centres = hypot(dx, dy)
        gap = max(0.0, centres - 2.0 * ROBOT_RADIUS)
        if gap > _LOOK or centres == 0.0:
            continue
        nx, ny = dx / centres, dy / centres
        # Only where it would be hit: what passes by does not matter.
        across = abs(nx * (vy - other.vy) - ny * (vx - other.vx))
        closing = nx * (vx - other.vx) + ny * (vy - other.vy)
        if closing <= 0.0 or across * gap > closing * 3.0 * ROBOT_RADIUS:
            continue
        coming = max(0.0, -(nx * other.vx + ny * other.vy))
        most = max(0.0, sqrt(_CLOSING * _CLOSING + 2.0 * _BRAKING * gap) - coming)
        ahead = nx * vx + ny * vy
        if ahead > most:
            vx, vy = vx - (ahead - most) * nx, vy - (ahead - most) * ny
            changed = True
    if changed:
        order.vx, order.vy = c * vx + s * vy, c * vy - s * vx
    return order
