"""Arrival times of robots: time-optimal motion in closed form, compiled.

Each of two axes, along the way and across it, accelerates and brakes at its limits; the limits
are shared out so that both are done at the same time.

Source of the idea: Purwin and D'Andrea, "Trajectory generation and control for four wheeled
omnidirectional vehicles" (2006), as the league's teams use it.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, hypot, pi, sin, sqrt

import numpy as np

from robobt.world.ball_model import way_in
from robobt.world.compiled import compiled, compiled_merged, records
from robobt.world.geometry import FloatArray
from robobt.world.records import BALL, MEETING, MOVER, Ball, Meeting, Mover, mover_records
from robobt.world.state import TOUCH_DISTANCE

MEETING_STEP = 0.1
"""Time between the places at which a ball may be met [s]."""

_TIME_HALVINGS = 7
_NEGLIGIBLE_DRIFT = 0.15
"""Sideways speed that is ignored [m/s]."""
_MEETING_HORIZON = 4.0


@compiled
def axis_time(gap: float, speed: float, top: float, acceleration: float, braking: float) -> float:
    """Compute the least time to cover ``gap`` [m] along a line and to stop there, from ``speed`` [s].

    A negative gap or speed means the opposite direction.
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
def arrival_time(mover_: FloatArray, x: float, y: float, slack: float) -> float:
    """Like :func:`time_to`, for a row of :func:`robobt.world.records.movers`. Return the time [s]."""
    return time_to(mover_.view(MOVER)[0], x, y, slack)


@compiled
def time_to(mover: Mover, x: float, y: float, slack: float) -> float:
    """Compute when a robot can stand within ``slack`` [m] of (x, y) [s]."""
    dx, dy = x - mover.x, y - mover.y
    gap = hypot(dx, dy)
    top, acceleration, braking = mover.max_speed, mover.acceleration, mover.braking
    if gap <= slack:
        return 0.0
    ux, uy = dx / gap, dy / gap
    along = ux * mover.vx + uy * mover.vy
    across = abs(ux * mover.vy - uy * mover.vx)
    gap -= slack
    if across < _NEGLIGIBLE_DRIFT:
        return axis_time(gap, along, top, acceleration, braking)
    low, high = 0.0, 0.5 * pi
    time = 0.0
    for _ in range(_TIME_HALVINGS):
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


@compiled_merged
def out_of_reach(mover: Mover, x: float, y: float, fastest: float, time: float) -> bool:
    """Return whether a robot certainly cannot meet a ball at (x, y) by ``time`` [s].

    This uses the bounds that the robot never drives faster than ``fastest`` [m/s] and is never earlier than
    without drift; a robot that is too fast now is excepted, because it covers more ground the later it
    brakes.
    """
    dx, dy = x - mover.x, y - mover.y
    gap = hypot(dx, dy)
    if gap - TOUCH_DISTANCE >= fastest * time + 1e-6:
        return True
    if gap <= TOUCH_DISTANCE or fastest > mover.max_speed:
        return False
    along = (dx * mover.vx + dy * mover.vy) / gap
    return (
        axis_time(gap - TOUCH_DISTANCE, along, mover.max_speed, mover.acceleration, mover.braking)
        > time + 1e-6
    )


@compiled
def meetings(
    movers_: FloatArray,
    ball_: FloatArray,
    rolling: float,
    slide: float,
    roll: float,
    half_length: float,
    half_width: float,
) -> FloatArray:
    """Find where and when every robot can meet the ball first: (n, 3), the time [s] and the place [m].

    A robot meets a rolling ball at the first place where it can stand before the ball arrives; if there is
    none, where the ball comes to rest or leaves the field.

    Args:
        movers_: as of :func:`robobt.world.records.movers`.
        ball_: as of :func:`robobt.world.records.ball_of`.
        rolling: the speed from which on it rolls [m/s].
        slide: its deceleration while it slides [m/s^2].
        roll: the same while it rolls [m/s^2].
        half_length: half the field's length [m].
        half_width: half its width [m].

    Returns:
        A :class:`~robobt.world.records.Meeting` in each row.
    """
    path = _path(ball_.view(BALL)[0], rolling, slide, roll, half_length, half_width)
    movers = mover_records(movers_)
    out = np.empty((len(movers), 3))
    found = out.view(MEETING)[:, 0]
    for i in range(len(movers)):
        _meet(movers[i], path, found[i])
    return out


@compiled_merged
def _path(
    ball: Ball, rolling: float, slide: float, roll: float, half_length: float, half_width: float
) -> Sequence[Meeting]:
    """Return the ball's positions at each step, up to the last place to meet it."""
    path: Sequence[Meeting] = records(int(_MEETING_HORIZON / MEETING_STEP) + 2, MEETING)
    speed = hypot(ball.vx, ball.vy)
    ux, uy = 0.0, 0.0
    if speed > 0.0:
        ux, uy = ball.vx / speed, ball.vy / speed
    last, time, way = 0, 0.0, 0.0
    while True:
        x, y = ball.x + way * ux, ball.y + way * uy
        path[last].time, path[last].x, path[last].y = time, x, y
        further = way_in(time + MEETING_STEP, speed, rolling, slide, roll)
        gone = abs(x) > half_length or abs(y) > half_width
        if gone or further - way < 0.02 or time >= _MEETING_HORIZON:
            break
        last += 1
        time += MEETING_STEP
        way = further
    return path[: last + 1]


@compiled_merged
def _meet(mover: Mover, path: Sequence[Meeting], meeting: Meeting) -> None:
    """Fill in where on its path a robot can meet the ball first."""
    fastest = max(mover.max_speed, hypot(mover.vx, mover.vy))
    last = len(path) - 1
    k, late = 0, 0.0
    while True:
        at = path[k]
        # Most steps are out of its reach, which can be checked without computing the arrival time.
        if k == last or not out_of_reach(mover, at.x, at.y, fastest, at.time):
            late = time_to(mover, at.x, at.y, TOUCH_DISTANCE) - at.time
            if k == last or late <= 0.0:
                break
        k += 1
    meeting.time, meeting.x, meeting.y = at.time, at.x, at.y
    if late > 0.0:
        meeting.time += late
    elif k > 0:
        earlier = path[k - 1]
        before = time_to(mover, earlier.x, earlier.y, TOUCH_DISTANCE) - earlier.time
        meeting.time += MEETING_STEP * late / (before - late)
