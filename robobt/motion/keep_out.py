"""Not touching the ball inside a defence area, however a robot gets there.

Source of the limits: RoboCup SSL rules, chapter "Offenses": who is not the goalkeeper may not touch the ball
while wholly inside its own defence area, nor while partly inside the opponents'.
"""

from __future__ import annotations

from math import cos, hypot, sin, sqrt

from robobt.world.command import RobotCommand
from robobt.world.field import FieldGeometry
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, Frame, RobotState

_OUTSIDE = ROBOT_RADIUS + 0.02
"""How far from an area a robot's centre stays [m]."""

_NEAR, _AHEAD = 0.3, 0.4
"""Only a ball matters that is no farther away, or that the robot may meet so soon [m, s]."""

_BRAKING = 2.0
"""How hard to brake before an area, less than any robot can [m/s^2]."""

_FAR = 2.5
"""From farther off any robot can brake before an area [m]."""

_WAY_OUT, _FASTEST_OUT = 8.0, 2.0
"""A robot that was shoved in leaves that much faster for each metre, and so fast at the most [1/s, m/s]."""

_INSIDE = 0.02 - ROBOT_RADIUS
"""A robot whose centre is so far from the area is about wholly inside [m]."""

_LAG = 0.2
"""A robot that is so much too fast for braking in time leaves its speed along the area as it is [m/s]."""

_CLEAR = ROBOT_RADIUS + BALL_RADIUS + 0.03
"""Wholly inside, a robot gets away from a ball that is nearer to its centre [m]."""


def keep_out(frame: Frame, me: RobotState, order: RobotCommand) -> RobotCommand:
    """Return the command without what takes a field player into a defence area while the ball is near.

    One that is there already, because others shove it, is driven out: straight, or, where it is wholly
    inside its own area and at the ball, away from that. Nothing is changed while the ball is not in play.

    Args:
        frame: what is on the field.
        me: the robot.
        order: what it was to do; changed in place.
    """
    if not frame.game.in_play:
        return order
    ball, field = frame.ball, frame.field
    dx, dy = ball.x - me.x, ball.y - me.y
    if abs(me.x) < field.half_length - field.defense_depth - _FAR:
        return order
    gap = hypot(dx, dy)
    if gap > _NEAR + _AHEAD * (ball.speed + me.speed):
        return order
    side = 1.0 if me.x > 0.0 else -1.0
    off, nx, ny = _way_out(field, side * me.x, me.y)
    nx *= side
    slack = off - _OUTSIDE
    outwards = -sqrt(2.0 * _BRAKING * slack) if slack > 0.0 else min(_FASTEST_OUT, -_WAY_OUT * slack)
    if side < 0.0 and off < _INSIDE and 0.0 < gap < _CLEAR:
        nx, ny = -dx / gap, -dy / gap
    c, s = cos(me.heading), sin(me.heading)
    vx, vy = c * order.vx - s * order.vy, s * order.vx + c * order.vy
    lacking = outwards - (nx * vx + ny * vy)
    if lacking > 0.0:
        lag = outwards - (nx * me.vx + ny * me.vy)
        if lag > 0.0:
            # What it takes to speed up along the area lacks for braking before it.
            along = (nx * (vy - me.vy) - ny * (vx - me.vx)) * min(1.0, lag / _LAG)
            vx, vy = vx + along * ny, vy - along * nx
        vx, vy = vx + lacking * nx, vy + lacking * ny
        order.vx, order.vy = c * vx + s * vy, c * vy - s * vx
    return order


def _way_out(field: FieldGeometry, x: float, y: float) -> tuple[float, float, float]:
    """Return how far off the area at +x is, negative inside, and the direction out of it, a unit vector."""
    front = field.half_length - field.defense_depth - x
    beside = abs(y) - field.defense_width / 2
    aside = 1.0 if y > 0.0 else -1.0
    if front > 0.0 and beside > 0.0:
        off = hypot(front, beside)
        return off, -front / off, aside * beside / off
    return (front, -1.0, 0.0) if front >= beside else (beside, 0.0, aside)
