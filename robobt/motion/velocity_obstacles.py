"""The velocity nearest to the one wanted that meets no moving robot soon, compiled.

Robots that stand are gone round. A way round the place where one that moves is, or will be at some moment,
leads into it at another. So a fan of velocities about the one wanted is looked at, each judged by when it
brings the robot too near to anybody who goes on as now.

Sources: Fiorini and Shiller, "Motion planning in dynamic environments using velocity obstacles" (1998); the
cost of a velocity is that of van den Berg, Lin and Manocha, "Reciprocal velocity obstacles" (2008).
"""

from __future__ import annotations

from math import cos, hypot, inf, pi, sin

import numpy as np

from robobt.motion.arrival import VX, VY, X, Y
from robobt.motion.scene import (
    AREA_GAP,
    BALL_VX,
    BALL_VY,
    BALL_X,
    BALL_Y,
    GOALKEEPER,
    IN_PLAY,
    PERIOD,
    PLACING,
    THEIR_GAP,
    from_ball,
    is_open,
    row_of,
)
from robobt.motion.speeds import BRAKING, FORWARD, LATERAL, LATERAL_BRAKING, REACTION
from robobt.world.avoiding import MARGIN, free_time
from robobt.world.compiled import compiled
from robobt.world.geometry import FloatArray, Point
from robobt.world.state import ROBOT_RADIUS

MOVES = 0.2
"""A robot that is faster is evaded, a slower one is gone round [m/s]."""

STANDS_APART, MOVES_APART = 2.0 * ROBOT_RADIUS + 0.03, 2.0 * ROBOT_RADIUS + MARGIN
"""Centres of the robot and of one that stands, or moves, are not to come nearer [m]."""

_HORIZON = 1.0
"""For how long a velocity has to be free [s]."""

_PENALTY = 0.67
"""A velocity that stays free for t costs this over t, one of the same speed the other way round 2 [s]."""

_WAYS, _SLOW_WAYS = 16, 8
"""How many directions are tried at the speed wanted and at half of it, evenly round."""

_SLOW = 0.1
"""Who hardly moves evades nobody [m/s]."""

_SOON = 0.05
"""Sooner than this is all the same [s]."""


@compiled
def is_moving(robots: FloatArray, i: int) -> bool:
    """Return whether robot ``i`` is evaded, and not gone round."""
    vx, vy = robots[i, VX], robots[i, VY]
    return bool(vx * vx + vy * vy > MOVES * MOVES)


@compiled
def clear_velocity(
    task: FloatArray,
    scene: FloatArray,
    robots: FloatArray,
    own: FloatArray,
    given: FloatArray,
    wanted: Point,
    goal: Point,
) -> Point:
    """Return ``wanted``, or a velocity near it that leads into nobody where that one meets who moves.

    The ball is in the way where it is to be avoided, and nothing is beyond the goal. Velocities from which
    the robot could not stop before a line that it may not cross are left out.

    Args:
        task: as of :func:`~robobt.motion.scene.task_of`.
        scene: as of :func:`~robobt.motion.scene.scene_of`.
        robots: as of :func:`~robobt.motion.arrival.movers_of`.
        own: what the robot can do, as of :func:`~robobt.motion.speeds.numbers`.
        given: how it is driven.
        wanted: the velocity in field coordinates [m/s].
        goal: where it is to get in the end [m].
    """
    x, y, now = task[0], task[1], (task[3], task[4])
    vx, vy = wanted
    speed = hypot(vx, vy)
    if speed < _SLOW:
        return wanted
    needed = min(_HORIZON, hypot(goal[0] - x, goal[1] - y) / speed)
    skip = row_of(task, scene)
    if not _any_moves(robots, skip, x, y, speed):
        return wanted
    near, count = np.empty((len(robots) + 1, 5)), 0
    for i in range(len(robots)):
        if i != skip and _is_near(robots, i, x, y, speed):
            apart = MOVES_APART if is_moving(robots, i) else STANDS_APART
            near[count] = robots[i, X] - x, robots[i, Y] - y, robots[i, VX], robots[i, VY], apart
            count += 1
    apart = from_ball(task, scene)
    if apart > 0.0:
        near[count] = scene[BALL_X] - x, scene[BALL_Y] - y, scene[BALL_VX], scene[BALL_VY], apart
        count += 1
    near = near[:count]
    for one in near:
        gx, gy = goal[0] - x - one[0], goal[1] - y - one[1]
        one[4] = min(one[4], 0.999 * min(hypot(gx, gy), hypot(gx - needed * one[2], gy - needed * one[3])))
    faster = min(given[FORWARD], given[LATERAL])
    slower = min(given[BRAKING], given[LATERAL_BRAKING])
    lag = own[REACTION] + 0.5 * scene[PERIOD]
    if _free_for(near, now, wanted, faster, slower, lag) >= needed:
        return wanted
    goalkeeper, placing = task[GOALKEEPER] > 0.0, task[PLACING] > 0.0
    bounded = is_open(scene, x, y, goalkeeper, placing)
    if scene[IN_PLAY] == 0.0:
        # What is open leaves out a little of their area's gap, which is the rules' in a restart.
        scene = scene.copy()
        scene[THEIR_GAP] += 2.0 * AREA_GAP
    best, least = wanted, inf
    for way in range(_WAYS + _SLOW_WAYS + 1):
        share, angle = 0.0, 0.0
        if way < _WAYS:
            share, angle = 1.0, 2.0 * pi * way / _WAYS
        elif way < _WAYS + _SLOW_WAYS:
            share, angle = 0.5, 2.0 * pi * (way - _WAYS) / _SLOW_WAYS
        ahead, aside = share * cos(angle), share * sin(angle)
        tried = vx * ahead - vy * aside, vy * ahead + vx * aside
        free = max(_SOON, _free_for(near, now, tried, faster, slower, lag))
        cost = hypot(1.0 - ahead, aside) + _PENALTY * max(0.0, 1.0 / free - 1.0 / needed)
        if cost >= least:
            continue
        stops = lag + 0.5 * share * speed / slower
        px, py = x + stops * tried[0], y + stops * tried[1]
        if way == 0 or not bounded or is_open(scene, px, py, goalkeeper, placing):
            best, least = tried, cost
    return best


@compiled
def _any_moves(robots: FloatArray, skip: int, x: float, y: float, speed: float) -> bool:
    """Return whether anybody near moves: most often nobody does."""
    for i in range(len(robots)):
        if is_moving(robots, i) and i != skip and _is_near(robots, i, x, y, speed):
            return True
    return False


@compiled
def _is_near(robots: FloatArray, i: int, x: float, y: float, speed: float) -> bool:
    """Return whether a robot at (x, y) that drives so fast can meet robot ``i`` soon enough to matter."""
    reach = MOVES_APART + (speed + hypot(robots[i, VX], robots[i, VY])) * _HORIZON
    return hypot(robots[i, X] - x, robots[i, Y] - y) < reach


@compiled
def _free_for(near: FloatArray, now: Point, then: Point, faster: float, slower: float, lag: float) -> float:
    """Return how soon the robot, changing from the velocity ``now`` to ``then``, is too near to another [s].

    ``near`` are place and velocity of the others from the robot, and how near each may come. While it changes
    it is taken to drive with the mean of both.
    """
    vx, vy = then
    rate = faster if vx * vx + vy * vy > now[0] * now[0] + now[1] * now[1] else slower
    changes = lag + hypot(vx - now[0], vy - now[1]) / rate
    mx, my = 0.5 * (vx + now[0]), 0.5 * (vy + now[1])
    free = inf
    for i in range(len(near)):
        ox, oy, wx, wy, apart = near[i]
        meets = free_time(ox, oy, wx - mx, wy - my, apart)
        if meets >= changes:
            ox, oy = ox + changes * (wx - mx), oy + changes * (wy - my)
            meets = changes + free_time(ox, oy, wx - vx, wy - vy, apart)
        free = min(free, meets)
    return free
