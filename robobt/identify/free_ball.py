"""Stretches of play on which nothing touches the ball, cut from what cameras saw."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import numpy as np

from robobt.identify.observations import Observations
from robobt.world.field import FieldGeometry
from robobt.world.geometry import FloatArray
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

FREE = ROBOT_RADIUS + BALL_RADIUS + 0.02
"""A ball this far from a robot's centre is free, whatever the noise [m]."""

_FASTEST_BALL = 12.0
"""No ball moves faster: it was placed [m/s]."""

_LONGEST_BALL_GAP = 0.12
"""Longest time without a detection within a stretch [s]."""

_BESIDE, _JUMP = 7, 6.0
"""Detections on either side by which a jump is measured, and from how many standard deviations it is one."""

_WALL_DISTANCE = BALL_RADIUS + 0.03
"""Distance from the walls in which the ball may touch them [m]."""

_GOAL_DISTANCE = 0.05
"""Distance from a goal in which the ball may touch it [m]."""


@dataclass(slots=True)
class Stretch:
    """A stretch on which the ball moved by itself.

    Attributes:
        times: (n,) [s].
        places: (n, 2) where it was seen [m].
        before: place of the robot, in the arrays of the observations, that it came from; -1 for none.
        after: place of the robot that it went to; -1 for none.
        first: row of the observations where the stretch begins.
        last: row where it ends.
    """

    times: FloatArray
    places: FloatArray
    before: int
    after: int
    first: int
    last: int


def carried_on(poses: FloatArray) -> FloatArray:
    """Return poses (T, K, 3) with what was not seen filled in from the last sight, or from the first."""
    filled = np.array(poses)
    rows = np.arange(len(filled))
    for k in range(filled.shape[1]):
        known = np.isfinite(filled[:, k, 0])
        if not known.any():
            filled[:, k] = 1e6
            continue
        last = np.maximum.accumulate(np.where(known, rows, -1))
        filled[:, k] = filled[np.where(last < 0, int(np.argmax(known)), last), k]
    return filled


def stretches(seen: Observations, least: int = 6) -> list[Stretch]:
    """Return the stretches of free ball with at least this many detections, in their order."""
    poses = carried_on(seen.poses)
    parts: list[Stretch] = []
    run: list[int] = []
    before = last = -1
    for row in np.flatnonzero(np.isfinite(seen.ball[:, 0])).tolist():
        ball, came = seen.ball[row], seen.ball[last if last >= 0 else row]
        step = seen.times[row] - seen.times[last] if last >= 0 else 0.0
        touching = _nearest(ball, ball, poses[row])
        between = _nearest(came, ball, poses[row])
        last = row
        if at_wall(seen.field, seen.ball[row]):
            _close(parts, seen, run, before, -1, least)
            run, before = [], -1
        elif touching >= 0:
            _close(parts, seen, run, before, touching, least)
            run, before = [], touching
        elif step > _LONGEST_BALL_GAP or float(np.hypot(*(ball - came))) > _FASTEST_BALL * step + 0.02:
            _close(parts, seen, run, before, -1, least)
            run, before = [row], -1
        elif run and between >= 0:
            _close(parts, seen, run, before, between, least)
            run, before = [row], between
        else:
            run.append(row)
    _close(parts, seen, run, before, -1, least)
    return [piece for part in parts for piece in _without_jumps(part, least)]


def _close(
    parts: list[Stretch], seen: Observations, run: list[int], before: int, after: int, least: int
) -> None:
    if len(run) >= least:
        rows = np.array(run)
        parts.append(Stretch(seen.times[rows], seen.ball[rows], before, after, run[0], run[-1]))


def _without_jumps(part: Stretch, least: int) -> list[Stretch]:
    """Cut a stretch where the ball jumps, as it does from a camera to another that sees it elsewhere."""
    sizes = _jumps(part)
    cuts = [
        i
        for i in range(_BESIDE, len(sizes) - _BESIDE)
        if sizes[i] > _JUMP and sizes[i] == sizes[i - _BESIDE : i + _BESIDE + 1].max()
    ]
    pieces = []
    for start, end in zip([0, *cuts], [*cuts, len(sizes)], strict=True):
        if end - start >= least:
            pieces.append(
                Stretch(
                    part.times[start:end],
                    part.places[start:end],
                    part.before if start == 0 else -1,
                    part.after if end == len(sizes) else -1,
                    part.first if start == 0 else part.last,
                    part.last,
                )
            )
    return pieces


def _jumps(part: Stretch) -> FloatArray:
    """Return (n,) how far each place is off a smooth way up to there, in standard deviations."""
    count = len(part.times)
    sizes = np.zeros(count)
    if count < 2 * _BESIDE:
        return sizes
    noise = max(1.4826 * float(np.median(np.abs(np.diff(part.places, 3, axis=0)))) / sqrt(20.0), 1e-5)
    for i in range(_BESIDE, count - _BESIDE):
        near = slice(i - _BESIDE, i + _BESIDE)
        since = part.times[near] - part.times[i]
        columns = np.column_stack([np.ones(len(since)), since, since**2, np.arange(len(since)) >= _BESIDE])
        inverse = np.linalg.inv(columns.T @ columns)
        jump = (inverse @ columns.T @ part.places[near])[3]
        sizes[i] = float(np.hypot(*jump)) / (noise * sqrt(float(inverse[3, 3])))
    return sizes


def _nearest(start: FloatArray, end: FloatArray, robots: FloatArray) -> int:
    """Return the robot that the way from start to end comes near to, or -1."""
    way = end - start
    squared = float(way @ way)
    offsets = robots[:, :2] - start
    share = np.clip(offsets @ way / squared, 0.0, 1.0) if squared > 0.0 else np.zeros(len(robots))
    gaps = np.hypot(*(offsets - share[:, None] * way).T)
    nearest = int(gaps.argmin())
    return nearest if gaps[nearest] < FREE else -1


def at_wall(field: FieldGeometry, ball: FloatArray) -> bool:
    """Return whether a ball may touch a wall or a goal.

    Args:
        field: with its walls.
        ball: (2,) where the ball was seen [m].
    """
    x, y = np.abs(ball)
    outer_x, outer_y = field.outer
    if x > outer_x - _WALL_DISTANCE or y > outer_y - _WALL_DISTANCE:
        return True
    return bool(x > field.half_length - _GOAL_DISTANCE and y < field.goal_width / 2 + _GOAL_DISTANCE)
