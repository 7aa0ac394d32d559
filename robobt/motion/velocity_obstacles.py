"""Compiled velocity obstacles: the velocity nearest to the wanted one that avoids moving robots.

Standing robots are avoided by the path. A path round a moving robot's position at one moment may lead into it
at another, so a fan of velocities around the wanted one is tried, each rated by the time until the robot is
too near to a robot with constant velocity.

Sources: Fiorini and Shiller, "Motion planning in dynamic environments using velocity obstacles" (1998); the
cost of a velocity is that of van den Berg, Lin and Manocha, "Reciprocal velocity obstacles" (2008).
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, hypot, inf, pi, sin
from typing import Protocol

from robobt.motion.scene import ROBOT_AREA_GAP, from_ball, is_open, row_of
from robobt.world.avoiding import MARGIN, free_time
from robobt.world.compiled import compiled, compiled_merged, record_dtype, records
from robobt.world.geometry import Point
from robobt.world.records import Limits, Mover, Robot, Scene, Trip
from robobt.world.state import ROBOT_RADIUS

MOVES = 0.2
"""A robot faster than this is evaded by velocity, a slower one is avoided by the path [m/s]."""

STANDS_APART, MOVES_APART = 2.0 * ROBOT_RADIUS + 0.03, 2.0 * ROBOT_RADIUS + MARGIN
"""Least distances between centres, to standing and to moving robots [m]."""

_FREE_TIME_HORIZON = 1.0
"""Time for which a velocity has to be free [s]."""

_PENALTY = 0.67
"""A velocity that stays free for t costs this divided by t; the opposite velocity costs 2 [s]."""

_WAYS, _SLOW_WAYS = 16, 8
"""Number of evenly spaced directions tried at the wanted speed and at half of it."""

_STANDING_SPEED = 0.1
"""A robot slower than this does not evade [m/s]."""

_SHORTEST_FREE_TIME = 0.05
"""Times shorter than this count as equal [s]."""


class _Obstacle(Protocol):
    """Place and velocity from the robot [m, m/s], and how near its centre may come [m]."""

    x: float
    y: float
    vx: float
    vy: float
    apart: float


_OBSTACLE = record_dtype(_Obstacle)


@compiled
def clear_velocity(
    trip: Trip,
    scene: Scene,
    movers: Sequence[Mover],
    own: Limits,
    given: Limits,
    wanted: Point,
    goal: Point,
) -> Point:
    """Return ``wanted``, or a collision-free velocity near it if ``wanted`` leads into a moving robot.

    The ball counts as an obstacle if it is to be avoided; nothing beyond the goal counts. Velocities from
    which the robot could not stop before a line that it may not cross are left out.

    Args:
        trip: the robot.
        scene: the scene.
        movers: everybody, the own team first.
        own: what the robot can do.
        given: how it is driven.
        wanted: the velocity in field coordinates [m/s].
        goal: where it is to get in the end [m].
    """
    me = trip.me
    x, y = me.x, me.y
    vx, vy = wanted
    speed = hypot(vx, vy)
    if speed < _STANDING_SPEED:
        return wanted
    needed = min(_FREE_TIME_HORIZON, hypot(goal[0] - x, goal[1] - y) / speed)
    if not _any_moves(movers, row_of(trip, scene, movers), x, y, speed):
        return wanted
    near = _obstacles(trip, scene, movers, speed, needed, goal)
    faster = min(given.acceleration, given.lateral_acceleration)
    slower = min(given.braking, given.lateral_braking)
    lag = own.trailing_time + 0.5 * scene.period
    if _free_for(near, me, wanted, faster, slower, lag) >= needed:
        return wanted
    bounded = is_open(trip, scene, x, y, scene.their_gap)
    # The check leaves out a little of the gap to their area, which the rules demand in a restart.
    their_gap = scene.their_gap + 2.0 * ROBOT_AREA_GAP if scene.in_play == 0.0 else scene.their_gap
    best, least = wanted, inf
    for way in range(_WAYS + _SLOW_WAYS + 1):
        share, angle = 0.0, 0.0
        if way < _WAYS:
            share, angle = 1.0, 2.0 * pi * way / _WAYS
        elif way < _WAYS + _SLOW_WAYS:
            share, angle = 0.5, 2.0 * pi * (way - _WAYS) / _SLOW_WAYS
        ahead, aside = share * cos(angle), share * sin(angle)
        tried = vx * ahead - vy * aside, vy * ahead + vx * aside
        free = max(_SHORTEST_FREE_TIME, _free_for(near, me, tried, faster, slower, lag))
        cost = hypot(1.0 - ahead, aside) + _PENALTY * max(0.0, 1.0 / free - 1.0 / needed)
        if cost >= least:
            continue
        stops = lag + 0.5 * share * speed / slower
        px, py = x + stops * tried[0], y + stops * tried[1]
        if way == 0 or not bounded or is_open(trip, scene, px, py, their_gap):
            best, least = tried, cost
    return best


@compiled_merged
def is_moving(mover: Mover) -> bool:
    """Return whether a robot is evaded by velocity instead of by the path."""
    return mover.vx * mover.vx + mover.vy * mover.vy > MOVES * MOVES


@compiled_merged
def _any_moves(movers: Sequence[Mover], skip: int, x: float, y: float, speed: float) -> bool:
    """Return whether any robot nearby moves; usually none does."""
    for i, mover in enumerate(movers):
        if is_moving(mover) and i != skip and _is_near(mover, x, y, speed):
            return True
    return False


@compiled_merged
def _is_near(mover: Mover, x: float, y: float, speed: float) -> bool:
    """Return whether a robot at (x, y) that drives so fast can meet this one soon enough to matter."""
    reach = MOVES_APART + (speed + hypot(mover.vx, mover.vy)) * _FREE_TIME_HORIZON
    return hypot(mover.x - x, mover.y - y) < reach


@compiled
def _obstacles(
    trip: Trip, scene: Scene, movers: Sequence[Mover], speed: float, needed: float, goal: Point
) -> Sequence[_Obstacle]:
    """Return the nearby robots, and the ball if it is to be avoided, shrunk so that none covers the goal.

    ``speed`` is that wanted [m/s], ``needed`` how long a velocity has to be free [s].
    """
    x, y, skip = trip.me.x, trip.me.y, row_of(trip, scene, movers)
    near: Sequence[_Obstacle] = records(len(movers) + 1, _OBSTACLE)
    count = 0
    for i, mover in enumerate(movers):
        if i != skip and _is_near(mover, x, y, speed):
            one = near[count]
            one.x, one.y, one.vx, one.vy = mover.x - x, mover.y - y, mover.vx, mover.vy
            one.apart = MOVES_APART if is_moving(mover) else STANDS_APART
            count += 1
    apart = from_ball(trip, scene)
    if apart > 0.0:
        one, ball = near[count], scene.ball
        one.x, one.y, one.vx, one.vy, one.apart = ball.x - x, ball.y - y, ball.vx, ball.vy, apart
        count += 1
    near = near[:count]
    for one in near:
        gx, gy = goal[0] - x - one.x, goal[1] - y - one.y
        one.apart = min(
            one.apart, 0.999 * min(hypot(gx, gy), hypot(gx - needed * one.vx, gy - needed * one.vy))
        )
    return near


@compiled
def _free_for(
    near: Sequence[_Obstacle], me: Robot, then: Point, faster: float, slower: float, lag: float
) -> float:
    """Return the time until the robot, changing its velocity to ``then``, is too near to another [s].

    While it changes it is taken to drive with the mean of both.
    """
    vx, vy = then
    rate = faster if vx * vx + vy * vy > me.vx * me.vx + me.vy * me.vy else slower
    changes = lag + hypot(vx - me.vx, vy - me.vy) / rate
    mx, my = 0.5 * (vx + me.vx), 0.5 * (vy + me.vy)
    free = inf
    for other in near:
        ox, oy, wx, wy = other.x, other.y, other.vx, other.vy
        meets = free_time(ox, oy, wx - mx, wy - my, other.apart)
        if meets >= changes:
            ox, oy = ox + changes * (wx - mx), oy + changes * (wy - my)
            meets = changes + free_time(ox, oy, wx - vx, wy - vy, other.apart)
        free = min(free, meets)
    return free
