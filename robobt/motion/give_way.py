"""Compiled collision avoidance: opponents while the ball is not in play, and team-mates.

Source of the limit: RoboCup SSL rules, chapter "Crashing": the relative velocity along the line of centres,
1.5 m/s, of which the slower robot is free.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, hypot, sin, sqrt
from typing import NamedTuple

from robobt.world.command import RobotCommand
from robobt.world.compiled import compiled, compiled_merged
from robobt.world.geometry import FloatArray, Point
from robobt.world.records import Mover, Robot, mover_records, movers_of
from robobt.world.state import ROBOT_RADIUS, Frame, RobotState

_OPPONENT_CLOSING_SPEED = 1.0
"""Closing speed at which opponents may touch [m/s]."""

_MATE_CLOSING_SPEED = 0.3
"""Closing speed at which team-mates may touch, who gain nothing by a collision [m/s]."""

_GIVE_WAY_BRAKING = 2.0
"""Deceleration used, less than any robot is capable of [m/s^2]."""

_WATCHED_GAP = 1.5
"""Opponents with a wider gap are left out [m]."""

_IN_PLAY_CLOSING_SPEED = 1.3
"""Closing speed at which opponents may touch while the ball is in play, some way below the rules' [m/s]."""

_SLOWER = 0.4
"""A robot this much slower than an oncoming opponent is not at fault [m/s]."""

BRAKES = 0.7
"""Share of its braking that a robot uses in play."""


def avoid_crash(frame: Frame, me: RobotState, order: RobotCommand) -> RobotCommand:
    """Return the command limited so that the robot does not crash into an opponent in play.

    It may still drive at a ball between them: only the speed of contact is limited, and an opponent that
    comes faster is at fault itself.

    Args:
        frame: what is on the field.
        me: the robot.
        order: the command; changed in place.
    """
    if frame.game.in_play and (order.vx != 0.0 or order.vy != 0.0):
        pose = float(me.x), float(me.y), float(me.heading)
        velocity = float(order.vx), float(order.vy)
        theirs: FloatArray | None = frame.made.get("their movers")
        if theirs is None:
            theirs = frame.made["their movers"] = movers_of(frame)[len(frame.own) :]
        order.vx, order.vy = _slowed(pose, velocity, theirs, BRAKES * me.limits.braking)
    return order


class _Pose(NamedTuple):
    """Place [m] and heading [rad]: plain numbers reach compiled code sooner than an array of them."""

    x: float
    y: float
    heading: float


@compiled
def _slowed(pose: tuple[float, float, float], velocity: Point, others_: FloatArray, braking: float) -> Point:
    return slowed_in_play(_Pose(*pose), velocity, mover_records(others_), braking)


@compiled_merged
def slowed_in_play(me: Robot | _Pose, velocity: Point, others: Sequence[Mover], braking: float) -> Point:
    """Return the velocity ahead and to the left, slowed down towards opponents that it would crash into.

    Args:
        me: the robot.
        velocity: ahead and to the left, that it is to have [m/s].
        others: the opponents.
        braking: how hard to brake for it [m/s^2].
    """
    ahead, left = velocity
    c, s = cos(me.heading), sin(me.heading)
    vx, vy = c * ahead - s * left, s * ahead + c * left
    changed = False
    for other in others:
        gap, nx, ny = _meeting(me, vx, vy, other)
        if gap < 0.0:
            continue
        coming = -(nx * other.vx + ny * other.vy)
        most = max(
            coming - _SLOWER,
            sqrt(_IN_PLAY_CLOSING_SPEED * _IN_PLAY_CLOSING_SPEED + 2.0 * braking * gap) - coming,
        )
        towards = nx * vx + ny * vy
        if towards > most:
            vx, vy = vx - (towards - most) * nx, vy - (towards - most) * ny
            changed = True
    return (c * vx + s * vy, c * vy - s * vx) if changed else (ahead, left)


@compiled
def slowed_towards(me: Robot, velocity: Point, others: Sequence[Mover], skip: int, mates: int) -> Point:
    """Return the velocity ahead and to the left, slowed down towards robots that it would run into.

    If two robots drive at each other, each keeps enough distance to brake, and the oncoming robot uses up
    that distance.

    Args:
        me: the robot.
        velocity: ahead and to the left, that it is to have [m/s].
        others: the robots.
        skip: the row among them of the robot itself, -1 for none.
        mates: number of robots, the first ones, of its own team.
    """
    ahead, left = velocity
    c, s = cos(me.heading), sin(me.heading)
    vx, vy = c * ahead - s * left, s * ahead + c * left
    changed = False
    for i, other in enumerate(others):
        gap, nx, ny = _meeting(me, vx, vy, other)
        if i == skip or gap < 0.0:
            continue
        coming = max(0.0, -(nx * other.vx + ny * other.vy))
        touching = _MATE_CLOSING_SPEED if i < mates else _OPPONENT_CLOSING_SPEED
        most = max(0.0, sqrt(touching * touching + 2.0 * _GIVE_WAY_BRAKING * gap) - coming)
        towards = nx * vx + ny * vy
        if towards > most:
            vx, vy = vx - (towards - most) * nx, vy - (towards - most) * ny
            changed = True
    return (c * vx + s * vy, c * vy - s * vx) if changed else (ahead, left)


@compiled_merged
def _meeting(me: Robot | _Pose, vx: float, vy: float, other: Mover) -> tuple[float, float, float]:
    """Return the gap to a robot that would be hit and the direction to it; -1 where it passes by."""
    dx, dy = other.x - me.x, other.y - me.y
    centres = hypot(dx, dy)
    gap = max(0.0, centres - 2.0 * ROBOT_RADIUS)
    if gap > _WATCHED_GAP or centres == 0.0:
        return -1.0, 0.0, 0.0
    nx, ny = dx / centres, dy / centres
    across = abs(nx * (vy - other.vy) - ny * (vx - other.vx))
    closing = nx * (vx - other.vx) + ny * (vy - other.vy)
    if closing <= 0.0 or across * gap > closing * 3.0 * ROBOT_RADIUS:
        return -1.0, 0.0, 0.0
    return gap, nx, ny
