"""Find a way that keeps clear of everything for certain, also of areas and lines that move.

Obstacles are capsules: all points nearer than a radius to a segment whose ends may move. A robot is one whose
ends are equal, the way of a ball that is placed is one from ball to spot. Defence areas and the walls are
passed beside them.

Two steps: a map of the travel time to the target over a grid, in which places near obstacles are slow
(:func:`time_map`, the eikonal equation by fast sweeping: Zhao, "A fast sweeping method for eikonal
equations", 2005), and from it the velocity that gets farthest within a horizon without touching what moves
(:func:`clear_velocity_of`, after the dynamic window approach: Fox, Burgard and Thrun, 1997).
"""

from __future__ import annotations

from math import cos, hypot, inf, pi, sin, sqrt
from typing import NamedTuple

import numpy as np

from robobt.world.compiled import compiled
from robobt.world.geometry import FloatArray

CAPSULE_COLUMNS = 9
"""Columns of an obstacle: ends and their velocities (ax, ay, avx, avy, bx, by, bvx, bvy), and its radius."""

CELL = 0.06
"""Width of a cell of the map [m]."""

_HOLDS = 1.2
"""Obstacles keep their velocity for this long, and then stand, as far as is foreseen [s]."""

_UNSURE = 0.15
"""Share of its way by which a moving obstacle grows, because it may turn or change its speed."""

_CLOSE = 0.15
"""Places nearer to an obstacle than this are slower [m]."""

_BLOCKED_SLOWNESS = 40.0
"""How many times slower a blocked place is than a free one."""

_TRIED_FOR, _ROLLOUT_STEP = 0.45, 0.05
"""How long a velocity is tried before the robot brakes, and in which steps [s]."""

_WATCHES = 0.4
"""How long after it has stopped nothing may touch the robot [s]."""

_COMFORT_GAP, _COMFORT_COST = 0.12, 2.0
"""Least distance that costs nothing [m], and cost of a metre less, in metres of way."""

_TOUCH_COST, _DEPTH_COST = 4.0, 200.0
"""Cost of coming too near to anything at all, and of each metre of it, in metres of way."""

_LEAVES = 0.3
"""How quickly a robot that is too near already has to leave [m/s]."""

_DIRECTIONS = 32
"""Number of directions that are tried."""

_ARRIVAL_RADIUS = 0.05
"""Distance from the target that counts as there [m]."""


class Ground(NamedTuple):
    """The fixed part of the field for a way.

    Attributes:
        half_length, half_width: how far the robot's centre may go from the field's centre [m].
        area_x: distance of the front of the opponents' defence area from the half-way line [m].
        area_y: half its width [m].
        area_gap: least distance of the robot's centre from it [m].
    """

    half_length: float
    half_width: float
    area_x: float
    area_y: float
    area_gap: float


@compiled
def clearance(x: float, y: float, time: float, obstacles: FloatArray, ground: Ground) -> float:
    """Return how far (x, y) is from the nearest obstacle in ``time`` seconds [m]; negative inside one."""
    ahead = min(time, _HOLDS)
    least = min(ground.half_length - abs(x), ground.half_width - abs(y))
    front, aside = max(0.0, ground.area_x - x), max(0.0, abs(y) - ground.area_y)
    least = min(least, hypot(front, aside) - ground.area_gap)
    for i in range(len(obstacles)):
        one = obstacles[i]
        ax, ay = one[0] + ahead * one[2], one[1] + ahead * one[3]
        bx, by = one[4] + ahead * one[6], one[5] + ahead * one[7]
        dx, dy = bx - ax, by - ay
        length = dx * dx + dy * dy
        share = 0.0
        if length > 0.0:
            share = min(1.0, max(0.0, ((x - ax) * dx + (y - ay) * dy) / length))
        pace = max(hypot(one[2], one[3]), hypot(one[6], one[7]))
        radius = one[8] + _UNSURE * pace * ahead
        least = min(least, hypot(x - ax - share * dx, y - ay - share * dy) - radius)
    return least


@compiled
def time_map(
    me: tuple[float, float], target: tuple[float, float], pace: float, obstacles: FloatArray, ground: Ground
) -> FloatArray:
    """Return the way to ``target`` from each cell, in metres of free way (rows x, columns y).

    A cell's obstacles are where they will be when the robot, at ``me`` and with ``pace`` [m/s], gets there.
    """
    rows = int(2.0 * ground.half_length / CELL) + 1
    columns = int(2.0 * ground.half_width / CELL) + 1
    slow = np.empty((rows, columns))
    for i in range(rows):
        x = i * CELL - ground.half_length
        for j in range(columns):
            y = j * CELL - ground.half_width
            room = clearance(x, y, hypot(x - me[0], y - me[1]) / pace, obstacles, ground)
            slow[i, j] = _BLOCKED_SLOWNESS if room < 0.0 else 1.0 + 2.0 * max(0.0, 1.0 - room / _CLOSE)
    way = np.full((rows, columns), inf)
    ti = min(rows - 1, max(0, round((target[0] + ground.half_length) / CELL)))
    tj = min(columns - 1, max(0, round((target[1] + ground.half_width) / CELL)))
    way[ti, tj] = 0.0
    for sweep in range(12):
        changed = False
        for i_ in range(rows):
            i = i_ if sweep & 1 == 0 else rows - 1 - i_
            for j_ in range(columns):
                j = j_ if sweep & 2 == 0 else columns - 1 - j_
                a = min(way[i - 1, j] if i > 0 else inf, way[i + 1, j] if i < rows - 1 else inf)
                b = min(way[i, j - 1] if j > 0 else inf, way[i, j + 1] if j < columns - 1 else inf)
                cost = slow[i, j] * CELL
                if abs(a - b) >= cost or a == inf or b == inf:
                    found = min(a, b) + cost
                else:
                    found = 0.5 * (a + b + sqrt(2.0 * cost * cost - (a - b) * (a - b)))
                if found < way[i, j] - 1e-9:
                    way[i, j] = found
                    changed = True
        if not changed:
            break
    return way


@compiled
def _way_from(x: float, y: float, way: FloatArray, ground: Ground) -> float:
    """Return the way from (x, y): over the best corner of its cell [m]."""
    i = min(way.shape[0] - 2, max(0, int((x + ground.half_length) / CELL)))
    j = min(way.shape[1] - 2, max(0, int((y + ground.half_width) / CELL)))
    least = inf
    for k in range(i, i + 2):
        for m in range(j, j + 2):
            gap = hypot(x + ground.half_length - k * CELL, y + ground.half_width - m * CELL)
            least = min(least, way[k, m] + gap)
    return least


@compiled
def clear_velocity_of(
    me: tuple[float, float, float, float],
    target: tuple[float, float],
    limits: tuple[float, float, float],
    delay: float,
    way: FloatArray,
    obstacles: FloatArray,
    ground: Ground,
) -> tuple[float, float]:
    """Return the velocity to command [m/s], in field coordinates.

    Args:
        me: the robot's x, y, vx, vy [m, m/s].
        target: where to [m].
        limits: its top speed, acceleration and braking [m/s, m/s^2].
        delay: time until a command takes effect [s].
        way: the map of :func:`time_map`.
        obstacles: the obstacles, their radii grown by the robot's and a margin.
        ground: the fixed part of the field.
    """
    top, acceleration, braking = limits
    best_x, best_y, least = 0.0, 0.0, inf
    now = clearance(me[0], me[1], 0.0, obstacles, ground)
    for k in range(4 * _DIRECTIONS + 1):
        pace = (k // _DIRECTIONS + 1) / 4.0 * top if k < 4 * _DIRECTIONS else 0.0
        angle = 2.0 * pi * (k % _DIRECTIONS) / _DIRECTIONS
        wx, wy = pace * cos(angle), pace * sin(angle)
        x, y, vx, vy = me
        depth, closest, time, end = 0.0, inf, 0.0, inf
        arrived = inf
        # Afterwards it brakes: a velocity from which it cannot stop in time is refused.
        while time < _TRIED_FOR + hypot(wx, wy) / braking + _WATCHES:
            if time < delay:
                tx, ty, rate = vx, vy, 0.0
            elif time < _TRIED_FOR:
                tx, ty = wx, wy
                rate = braking if pace == 0.0 else acceleration
            else:
                tx, ty, rate = 0.0, 0.0, braking
            dx, dy = tx - vx, ty - vy
            change = hypot(dx, dy)
            if change > rate * _ROLLOUT_STEP:
                dx, dy = dx * rate * _ROLLOUT_STEP / change, dy * rate * _ROLLOUT_STEP / change
            x, y = x + (vx + 0.5 * dx) * _ROLLOUT_STEP, y + (vy + 0.5 * dy) * _ROLLOUT_STEP
            vx, vy = vx + dx, vy + dy
            time += _ROLLOUT_STEP
            if time <= _TRIED_FOR:
                if hypot(x - target[0], y - target[1]) < _ARRIVAL_RADIUS:
                    arrived = time
                    break
                if time + _ROLLOUT_STEP > _TRIED_FOR:
                    end = _way_from(x, y, way, ground)
            room = clearance(x, y, time, obstacles, ground)
            # A robot that is too near already may leave.
            depth = max(depth, min(0.0, now + _LEAVES * time) - room)
            closest = min(closest, room)
        cost = end if arrived == inf else (arrived - _TRIED_FOR) * top
        if depth > 0.0:
            cost += _TOUCH_COST + _DEPTH_COST * depth
        cost += _COMFORT_COST * max(0.0, _COMFORT_GAP - closest)
        if cost < least - 1e-9:
            best_x, best_y, least = wx, wy, cost
    return best_x, best_y
