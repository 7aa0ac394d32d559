"""Noise and gaps of what cameras see of robots and ball."""

from __future__ import annotations

from itertools import product
from math import sqrt
from typing import NamedTuple

import numpy as np

from robobt.identify.estimate import Estimate, not_negative, of_values, unseen, widened
from robobt.identify.observations import Observations
from robobt.identify.views import each_alone
from robobt.identify.windows import windows
from robobt.statistics import wilson_interval
from robobt.world.geometry import FloatArray

_NOISE_WINDOW, _DEGREE, _NOISE_STEP = 8, 4, 4
"""Length [pictures] and degree of the polynomials around which noise is measured, and their distance."""

_SHARE = 0.35
"""The quietest windows up to this share decide: in others the robot changed its acceleration."""

_LEAST_WINDOWS = 20

_MOSTLY = 0.95
"""Share of pictures that all cameras took together from which something can be missing in one."""

_JITTER = 0.025
"""Relative half width that robots' own jitter, which looks like noise, adds to an interval."""

_LONGEST_ABSENCE = 0.5
"""What is not seen for longer has left the field [s]."""


class NoiseEstimate(NamedTuple):
    """Noise and gaps.

    Attributes:
        robot_noise: standard deviation of a robot's position, per axis [m].
        heading_noise: of its heading [rad].
        missing_ball: share of pictures in which the ball is not seen.
        missing_robot: share of pictures in which a robot on the field is not seen.
    """

    robot_noise: Estimate
    heading_noise: Estimate
    missing_ball: Estimate
    missing_robot: Estimate


def identify_noise(seen: Observations) -> NoiseEstimate:
    """Identify noise and gaps of what cameras saw.

    Args:
        seen: what they saw.

    Returns:
        the figures, each with its interval.
    """
    places, headings = [], []
    # The mean of several cameras has less noise than a detection.
    for view, robot in product(each_alone(seen), range(len(seen.robots))):
        found = windows(view, robot, _NOISE_WINDOW, _DEGREE, _NOISE_STEP)
        if len(found.times) >= _LEAST_WINDOWS:
            freedom = float(found.freedom.max())
            squares = found.spread[found.freedom == freedom] ** 2
            places.append(_quiet(squares[:, :2].mean(axis=1), 2.0 * freedom))
            headings.append(_quiet(squares[:, 2], freedom))
    # A camera that sees a part of the field misses nothing in the rest.
    whole = seen.cameras is None or float(np.mean(seen.cameras < 0)) > _MOSTLY
    missing = [_missing(seen.poses[:, robot, 0], seen.times) for robot in range(len(seen.robots))]
    return NoiseEstimate(
        not_negative(widened(of_values(np.array(places), 2, "m"), _JITTER)),
        not_negative(widened(of_values(np.array(headings), 2, "rad"), _JITTER)),
        _share(*_missing(seen.ball[:, 0], seen.times)) if whole else unseen(),
        _share(sum(lost for lost, _ in missing), sum(count for _, count in missing)) if whole else unseen(),
    )


def _quiet(squares: FloatArray, freedom: float) -> float:
    """Return the standard deviation whose squares' lower quantile is that of the windows."""
    # Wilson and Hilferty: the cube root of a chi squared variable is nearly normal.
    third = 2.0 / (9.0 * freedom)
    expected = (1.0 - third + _Z * sqrt(third)) ** 3
    return sqrt(float(np.quantile(squares, _SHARE)) / expected)


_Z = -0.385320
"""The normal distribution's quantile of :data:`_SHARE`."""


def _missing(seen: FloatArray, times: FloatArray) -> tuple[int, int]:
    """Return in how many pictures something was not seen, and in how many it could be."""
    lost = np.isnan(seen)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], lost, [False]])))
    missed, away = 0, 0
    for start, end in zip(edges[::2], edges[1::2], strict=True):
        inside = start > 0 and end < len(seen)
        if inside and times[end] - times[start] < _LONGEST_ABSENCE:
            missed += end - start
        else:
            away += end - start
    return int(missed), int(len(seen) - away)


def _share(lost: int, count: int) -> Estimate:
    if count < 100:
        return unseen(count)
    low, high = wilson_interval(lost, count)
    return Estimate(lost / count, low, high, count, True)
