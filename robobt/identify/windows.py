"""Short windows of a robot's motion, each described by a polynomial."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

import numpy as np

from robobt.identify.free_ball import carried_on
from robobt.identify.observations import Observations
from robobt.world.geometry import FloatArray
from robobt.world.state import ROBOT_RADIUS

_TOUCHING, _RECOVERY = 2 * ROBOT_RADIUS + 0.02, 0.25
"""Robots nearer than this may push each other [m], and for how long afterwards nothing is concluded [s]."""


def undisturbed(seen: Observations, robot: int) -> np.ndarray:
    """Return (T,) whether neither another robot nor a wall touches this robot, or has done so just before.

    Args:
        seen: what cameras saw.
        robot: place of the robot in the arrays.
    """
    poses = carried_on(seen.poses)
    gaps = np.hypot(*(poses[:, :, :2] - poses[:, robot : robot + 1, :2]).transpose(2, 0, 1))
    gaps[:, robot] = inf
    x, y = np.abs(poses[:, robot, :2]).T
    outer_x, outer_y = seen.field.outer
    near = _TOUCHING / 2.0
    at_goal = (x > seen.field.half_length - near) & (y < seen.field.goal_width / 2 + near)
    touching = (gaps.min(axis=1) < _TOUCHING) | at_goal | (x > outer_x - near) | (y > outer_y - near)
    since = np.where(touching, seen.times, -inf)
    return np.asarray(seen.times - np.maximum.accumulate(since) > _RECOVERY)


_MOST_MISSING = 0.2
"""Largest share of a window's sights that may be missing."""


@dataclass(slots=True)
class Windows:
    """Windows of one robot's motion, in order; n is their number.

    Attributes:
        rows: (n,) first row of each in the observations.
        times: (n,) middle of each [s].
        velocity: (n, 2) there, in world coordinates [m/s].
        acceleration: (n, 2) the same [m/s^2]; 0 for polynomials of the first degree.
        heading: (n,) there [rad].
        turn: (n,) turning rate there [rad/s].
        spread: (n, 3) standard deviation of what the polynomial leaves in x, y [m] and heading [rad].
        freedom: (n,) detections beyond the polynomial's numbers.
    """

    rows: np.ndarray
    times: FloatArray
    velocity: FloatArray
    acceleration: FloatArray
    heading: FloatArray
    turn: FloatArray
    spread: FloatArray
    freedom: FloatArray


def windows(seen: Observations, robot: int, length: int, degree: int, step: int) -> Windows:
    """Return the windows of a robot's motion in which it was seen nearly always.

    Args:
        seen: what cameras saw.
        robot: its place in the arrays.
        length: of a window [pictures].
        degree: of the polynomial.
        step: from the start of one window to that of the next [pictures].

    Returns:
        the windows.
    """
    poses = seen.poses[:, robot]
    known = np.isfinite(poses[:, 0])
    turned = np.full(len(poses), np.nan)
    turned[known] = np.unwrap(poses[known, 2])
    values = np.column_stack([poses[:, :2], turned])
    longest = 1.3 * length * seen.period
    parts = []
    for first in range(0, len(poses) - length + 1, step):
        rows = np.flatnonzero(known[first : first + length]) + first
        if len(rows) < (1.0 - _MOST_MISSING) * length or seen.times[rows[-1]] - seen.times[rows[0]] > longest:
            continue
        middle = 0.5 * (seen.times[rows[0]] + seen.times[rows[-1]])
        powers = (seen.times[rows] - middle)[:, None] ** np.arange(degree + 1)
        numbers = np.linalg.lstsq(powers, values[rows], rcond=None)[0]
        freedom = len(rows) - degree - 1
        left = values[rows] - powers @ numbers
        spread = np.sqrt((left**2).sum(axis=0) / freedom)
        second = 2.0 * numbers[2, :2] if degree > 1 else np.zeros(2)
        parts.append((first, middle, numbers[1, :2], second, numbers[0, 2], numbers[1, 2], spread, freedom))
    if not parts:
        none, pairs = np.zeros(0), np.zeros((0, 2))
        return Windows(none.astype(int), none, pairs, pairs, none, none, np.zeros((0, 3)), none)
    columns = [np.array(column) for column in zip(*parts, strict=True)]
    return Windows(*columns)
