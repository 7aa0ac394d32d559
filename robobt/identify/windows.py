"""Short windows of a robot's motion, each described by a polynomial."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from robobt.identify.observations import Observations
from robobt.world.geometry import FloatArray

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
