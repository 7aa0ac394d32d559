"""Keeps field players from touching the ball inside a defence area.

Source of the limits: RoboCup SSL rules, chapter "Offenses": only the goalkeeper may touch the ball while
fully inside its own defence area, and no robot while partly inside the opponents'.
"""

from __future__ import annotations

from math import cos, hypot, sin, sqrt

from robobt.world.command import RobotCommand
from robobt.world.field import FieldGeometry
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, Frame, RobotState

_OUTSIDE = ROBOT_RADIUS + 0.02
"""Distance of a robot's centre from an area [m]."""

_WATCHED_BALL_DISTANCE, _WATCHED_BALL_TIME = 0.3, 0.4
"""Distance of the ball, or time until the robot may meet it, within which this applies [m, s]."""

_AREA_BRAKING = 2.0
"""Deceleration before an area, less than any robot is capable of [m/s^2]."""

_WATCHED_AREA_DISTANCE = 2.5
"""Distance from which any robot can brake before an area [m]."""

_WAY_OUT, _FASTEST_OUT = 8.0, 2.0
"""Speed per metre, and top speed, of a robot that leaves an area after being pushed in [1/s, m/s]."""

_WHOLLY_INSIDE = 0.02 - ROBOT_RADIUS
"""Distance of the centre from the area's edge at which a robot is about fully inside [m]."""

_LAG = 0.2
"""A robot too fast for braking in time by this much keeps its speed along the area [m/s]."""

_CLEAR_OF_BALL = ROBOT_RADIUS + BALL_RADIUS + 0.03
"""A robot fully inside moves away from a ball closer to its centre than this [m]."""


def keep_out(frame: Frame, me: RobotState, order: RobotCommand) -> RobotCommand:
    """Return the command changed so that a field player stays out of a defence area while the ball is near.

    A robot that was pushed inside is driven out: straight, or away from the ball if it is fully inside its
    own area and at the ball. Nothing changes while the ball is not in play.

    Args:
        frame: what is on the field.
        me: the robot.
        order: the command; changed in place.
    """
    if not frame.game.in_play:
        return order
    ball, field = frame.ball, frame.field
    dx, dy = ball.x - me.x, ball.y - me.y
    if abs(me.x) < field.half_length - field.defense_depth - _WATCHED_AREA_DISTANCE:
        return order
    gap = hypot(dx, dy)
    if gap > _WATCHED_BALL_DISTANCE + _WATCHED_BALL_TIME * (ball.speed + me.speed):
        return order
    side = 1.0 if me.x > 0.0 else -1.0
    off, nx, ny = _way_out(field, side * me.x, me.y)
    nx *= side
    slack = off - _OUTSIDE
    outwards = -sqrt(2.0 * _AREA_BRAKING * slack) if slack > 0.0 else min(_FASTEST_OUT, -_WAY_OUT * slack)
    if side < 0.0 and off < _WHOLLY_INSIDE and 0.0 < gap < _CLEAR_OF_BALL:
        nx, ny = -dx / gap, -dy / gap
    c, s = cos(me.heading), sin(me.heading)
    vx, vy = c * order.vx - s * order.vy, s * order.vx + c * order.vy
    lacking = outwards - (nx * vx + ny * vy)
    if lacking > 0.0:
        lag = outwards - (nx * me.vx + ny * me.vy)
        if lag > 0.0:
            # Acceleration used along the area is not available for braking before it.
            along = (nx * (vy - me.vy) - ny * (vx - me.vx)) * min(1.0, lag / _LAG)
            vx, vy = vx + along * ny, vy - along * nx
        vx, vy = vx + lacking * nx, vy + lacking * ny
        order.vx, order.vy = c * vx + s * vy, c * vy - s * vx
    return order


def _way_out(field: FieldGeometry, x: float, y: float) -> tuple[float, float, float]:
    """Return the distance to the area at +x, negative inside, and the direction out of it, a unit vector."""
    front = field.half_length - field.defense_depth - x
    beside = abs(y) - field.defense_width / 2
    aside = 1.0 if y > 0.0 else -1.0
    if front > 0.0 and beside > 0.0:
        off = hypot(front, beside)
        return off, -front / off, aside * beside / off
    return (front, -1.0, 0.0) if front >= beside else (beside, 0.0, aside)
