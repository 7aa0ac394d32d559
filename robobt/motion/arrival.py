"""When a robot can be somewhere: time-optimal motion in closed form, compiled.

Each of two axes, along the way and across it, accelerates and brakes at its limits; the limits
are shared out so that both are done at the same time.

Source of the idea: Purwin and D'Andrea, "Trajectory generation and control for four wheeled
omnidirectional vehicles" (2006), as the league's teams use it.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import cos, hypot, pi, sin, sqrt

import numpy as np
from numpy.typing import NDArray

from robobt.world.ball_model import way_in
from robobt.world.compiled import compiled
from robobt.world.geometry import FloatArray
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, Frame, RobotState

X, Y, VX, VY, TOP, ACCELERATION, BRAKING = range(7)
"""Columns of :func:`movers`."""

STEP = 0.1
"""From one place where a ball may be met to the next [s]."""

_HALVINGS = 7
_DRIFT = 0.15
"""Sideways speed that does not count [m/s]."""
_BODY = ROBOT_RADIUS + BALL_RADIUS
_HORIZON = 4.0


def movers(robots: Iterable[RobotState]) -> FloatArray:
    """Return place, velocity and limits of every robot, (n, 7), for the functions of this module."""
    row: list[float] = []
    for robot in robots:
        limits = robot.limits
        row += (robot.x, robot.y, robot.vx, robot.vy)
        row += (limits.max_speed, limits.acceleration, limits.braking)
    # From one list, for numpy takes twice as long over a list of rows.
    return np.array(row, dtype=np.float64).reshape(-1, 7)


def movers_of(frame: Frame) -> FloatArray:
    """Return :func:`movers` of everybody on the field, the own team first; made once a frame."""
    made: FloatArray | None = frame.made.get("movers")
    if made is None:
        made = frame.made["movers"] = movers((*frame.own, *frame.opponents))
    return made


@compiled
def axis_time(gap: float, speed: float, top: float, acceleration: float, braking: float) -> float:
    """Compute the least time to cover ``gap`` [m] along a line and to stop there, from ``speed`` [s].

    A negative gap or speed is one the other way.
    """
    if gap < 0.0:
        gap, speed = -gap, -speed
    time = 0.0
    if speed < 0.0:
        time = -speed / braking
        gap += 0.5 * speed * speed / braking
        speed = 0.0
    stopping = 0.5 * speed * speed / braking
    if stopping > gap:
        time += speed / braking
        gap, speed = stopping - gap, 0.0
    if speed > top:
        # It slows down to the top speed first.
        slowed = 0.5 * (speed * speed - top * top) / braking
        time += (speed - top) / braking
        gap, speed = max(0.0, gap - slowed), top
    peak = sqrt((gap + 0.5 * speed * speed / acceleration) / (0.5 / acceleration + 0.5 / braking))
    if peak <= top:
        return time + (peak - speed) / acceleration + peak / braking
    used = 0.5 * (top * top - speed * speed) / acceleration + 0.5 * top * top / braking
    return time + (top - speed) / acceleration + top / braking + (gap - used) / top


@compiled
def arrival_time(robot: FloatArray, x: float, y: float, slack: float) -> float:
    """Compute when a robot, a row of :func:`movers`, can stand within ``slack`` [m] of (x, y) [s]."""
    dx, dy = x - robot[0], y - robot[1]
    gap = hypot(dx, dy)
    top, acceleration, braking = robot[4], robot[5], robot[6]
    if gap <= slack:
        return 0.0
    ux, uy = dx / gap, dy / gap
    along = ux * robot[2] + uy * robot[3]
    across = abs(ux * robot[3] - uy * robot[2])
    gap -= slack
    if across < _DRIFT:
        return axis_time(gap, along, top, acceleration, braking)
    low, high = 0.0, 0.5 * pi
    time = 0.0
    for _ in range(_HALVINGS):
        share = 0.5 * (low + high)
        c, s = cos(share), sin(share)
        ahead = axis_time(gap, along, top * c, acceleration * c, braking * c)
        aside = axis_time(0.0, across, top * s, acceleration * s, braking * s)
        time = max(ahead, aside)
        if ahead > aside:
            high = share
        else:
            low = share
    return time


@compiled
def out_of_reach(robot: FloatArray, x: float, y: float, fastest: float, time: float) -> bool:
    """Return whether a robot can surely not meet a ball at (x, y) by ``time`` [s].

    It never drives faster than ``fastest`` [m/s], nor gets there before one that need not mind its drift;
    but for one that is too fast now, and covers the more ground the later it brakes.
    """
    dx, dy = x - robot[X], y - robot[Y]
    gap = hypot(dx, dy)
    if gap - _BODY >= fastest * time + 1e-6:
        return True
    if gap <= _BODY or fastest > robot[TOP]:
        return False
    along = (dx * robot[VX] + dy * robot[VY]) / gap
    return bool(axis_time(gap - _BODY, along, robot[TOP], robot[ACCELERATION], robot[BRAKING]) > time + 1e-6)


@compiled
def arrival_times(robots: FloatArray, rows: NDArray[np.int64], places: FloatArray) -> FloatArray:
    """Compute when the robots of these rows of :func:`movers` can stand at every place (m, 2): (n, m) [s]."""
    out = np.empty((len(rows), len(places)))
    for i in range(len(rows)):
        for j in range(len(places)):
            out[i, j] = arrival_time(robots[rows[i]], places[j, 0], places[j, 1], 0.0)
    return out


@compiled
def meetings(
    robots: FloatArray,
    ball: FloatArray,
    rolling: float,
    slide: float,
    roll: float,
    half_length: float,
    half_width: float,
) -> FloatArray:
    """Find where and when every robot can meet the ball first: (n, 3), the time [s] and the place [m].

    A robot meets a rolling ball where it can stand in its way no later than the ball comes; where it
    never can, where the ball comes to rest or leaves the field.

    Args:
        robots: as of :func:`movers`.
        ball: its x, y, vx, vy.
        rolling: the speed from which on it rolls [m/s].
        slide: its deceleration while it slides [m/s^2].
        roll: the same while it rolls [m/s^2].
        half_length: half the field's length [m].
        half_width: half its width [m].
    """
    # Where the ball is from step to step, up to where it has to be met at the latest.
    path = np.empty((int(_HORIZON / STEP) + 2, 3))
    speed = hypot(ball[2], ball[3])
    ux, uy = 0.0, 0.0
    if speed > 0.0:
        ux, uy = ball[2] / speed, ball[3] / speed
    last, time, way = 0, 0.0, 0.0
    while True:
        x, y = ball[0] + way * ux, ball[1] + way * uy
        path[last, 0], path[last, 1], path[last, 2] = time, x, y
        further = way_in(time + STEP, speed, rolling, slide, roll)
        gone = abs(x) > half_length or abs(y) > half_width
        if gone or further - way < 0.02 or time >= _HORIZON:
            break
        last += 1
        time += STEP
        way = further
    out = np.empty((len(robots), 3))
    for i in range(len(robots)):
        robot = robots[i]
        fastest = max(robot[TOP], hypot(robot[VX], robot[VY]))
        k, late = 0, 0.0
        while True:
            time, x, y = path[k, 0], path[k, 1], path[k, 2]
            # Most steps are out of its reach, which is seen without computing when it would be there.
            if k == last or not out_of_reach(robot, x, y, fastest, time):
                late = arrival_time(robot, x, y, _BODY) - time
                if k == last or late <= 0.0:
                    break
            k += 1
        if late > 0.0:
            time += late
        elif k > 0:
            before = arrival_time(robot, path[k - 1, 1], path[k - 1, 2], _BODY) - path[k - 1, 0]
            time += STEP * late / (before - late)
        out[i, 0] = time
        out[i, 1] = x
        out[i, 2] = y
    return out
