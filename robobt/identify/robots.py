"""A robot's limits, gains and whole delay from the commands that it was sent and how it was seen to move.

The motion model of the simulator follows the robot from picture to picture; the limits are those with which
it predicts the next picture best. What the robot was never asked to do leaves no trace: not seen enough.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import hypot, inf

import numpy as np

from robobt.identify.estimate import Estimate, quantile, unseen
from robobt.identify.observations import Observations
from robobt.identify.robot_motion import DRIVE_PARAMETERS, motion_after
from robobt.identify.windows import undisturbed
from robobt.world.geometry import FloatArray
from robobt.world.state import RobotId

UNITS = dict(
    zip(
        DRIVE_PARAMETERS,
        ("s", "m/s", *["m/s²"] * 4, "rad/s", "rad/s²", *[""] * 3, *["s"] * 3, "", ""),
        strict=True,
    )
)

_USUAL_LIMITS = np.array(
    [0.08, 3.0, 3.0, 4.5, 2.7, 4.0, 10.0, 40.0, 0.95, 0.95, 0.97, 0.02, 0.02, 0.02, 0.0, 0.0]
)
_LIMITS_ERROR = np.array(
    [0.05, 0.5, 0.7, 0.7, 0.7, 0.7, 0.7, 0.7, 0.15, 0.15, 0.15, 0.03, 0.03, 0.03, 0.05, 0.05]
)
"""What is assumed of a robot before anything was seen, and by how much it may be off: times and cross-talk as
they are, the logarithm of everything else. A minute of play outweighs it where a limit was met."""

_SMALLEST_LIMITS = np.array([0.0, *[0.2] * 5, 0.5, 2.0, *[0.3] * 3, *[0.0] * 3, *[-0.4] * 2])
_LARGEST_LIMITS = np.array([0.4, 8.0, *[30.0] * 4, 60.0, 500.0, *[1.5] * 3, *[0.2] * 3, *[0.4] * 2])

_GAIN, _FIRST_LAG, _CROSS = (DRIVE_PARAMETERS.index(name) for name in ("gain", "lag", "cross_ahead"))
_LINEAR = np.array([i == 0 or i >= _FIRST_LAG for i in range(len(DRIVE_PARAMETERS))])
"""Which of them are taken as they are."""

_DELAYS = np.arange(0.0, 0.25, 0.01)
"""Delays that are tried first [s]."""

_DELAYS_NEAR = np.arange(-0.012, 0.0121, 0.003)
_LIMIT_FACTORS = np.array([1.0, 0.4, 0.5, 0.63, 0.8, 0.9, 1.12, 1.25, 1.6, 2.0, 2.5])
_GAIN_FACTORS = np.array([1.0, 0.6, 0.7, 0.8, 0.9, 0.95, 1.05])
_TRIED_LAGS = np.array([0.02, 0.0, 0.03, 0.045, 0.06])
_CROSSES = np.array([0.0, -0.06, -0.03, 0.03, 0.06])
"""Factors of the usual limits and gains, and time constants [s] and cross-talk, that are tried first."""

_TRUST = (0.25, 0.035)
"""Share of a miss by which the observer corrects place and speed."""

_PATIENCE = 0.3
"""The observer starts again after this time without a sight [s]."""

_LARGE_MISS = 3.0
_MOST_FIT_STEPS = 30
_BLOCK = 0.5
"""Length of the stretches whose misses count as independent of each other [s]."""

_UNRESOLVED_TIME, _UNRESOLVED_SHARE = 0.0006, 0.005
"""Standard errors that lost commands and the simulator's steps leave: of times [s], and relative ones of all
else; found on fields other than the blind ones."""

_RELAXED, _CLEARLY = 1.3, 20.0
"""A limit was met if the cost rises by this much when it is that many times as large."""

_OTHER_TIMES, _OBEYING = (0.2, 0.4, 0.6, 0.8), 2.0
"""Shifts of the commands, as shares of the play, and how many times as badly they then have to explain the
motion. Robots that obey: 3 (goalkeepers under realistic noise) to 120; one that others drive: 1.1."""

_MOST_LIMIT_ERROR, _MOST_TIME_ERROR = 0.1, 0.01
"""Half width of an interval beyond which a limit (relative) and a time [s] are not seen enough."""


Misses = Callable[[FloatArray], FloatArray]
Shape = Callable[[FloatArray], tuple[FloatArray, FloatArray]]


@dataclass(frozen=True, slots=True)
class RobotEstimate:
    """What was identified of a robot.

    Attributes:
        robot: which one.
        figures: by the names of :data:`robobt.identify.robot_motion.DRIVE_PARAMETERS`; ``delay`` is the
            whole delay from a command to its seen effect.
        commanded: whether its commands were known.
    """

    robot: RobotId
    figures: dict[str, Estimate]
    commanded: bool


def identify_robot(seen: Observations, robot: int) -> RobotEstimate:
    """Identify the robot at this place of the arrays from its commands and how it moved.

    Args:
        seen: what cameras saw and what was sent.
        robot: its place.

    Returns:
        its figures, each with its interval.
    """
    times, poses = seen.times, seen.poses[:, robot]
    commands = np.nan_to_num(seen.commands[:, robot, :3])
    mask = undisturbed(seen, robot)
    place, speed = _TRUST
    trust = np.array([place, speed, place, speed])
    known = np.isfinite(poses[:, 0])
    if known.sum() < 100 or not np.any(commands):
        return RobotEstimate(seen.robots[robot], {n: unseen(0, UNITS[n]) for n in DRIVE_PARAMETERS}, True)

    def misses(p: FloatArray, commands: FloatArray = commands) -> FloatArray:
        found = motion_after(p, times, poses, seen.sent, commands, trust, _PATIENCE)
        found[~mask] = np.nan
        return found

    first = _first(misses)
    exact = first.copy()
    exact[1], exact[_GAIN:_FIRST_LAG] = _LARGEST_LIMITS[1], 1.0
    best, least = first, inf
    for start in (first, exact):
        fitted, scale = start, _scale(misses(first))
        for shape in (_huber, _cauchy, _cauchy):
            fitted = _fit(misses, fitted, scale, shape)
            scale = _scale(misses(fitted))
        size = _size(misses(fitted))
        if size < least:
            best, least = fitted, size
    scale = _scale(misses(best))
    if not _obeys(misses, commands, best, scale):
        return RobotEstimate(seen.robots[robot], {n: unseen(0, UNITS[n]) for n in DRIVE_PARAMETERS}, True)
    figures = _figures(misses, best, scale, times)
    delay = figures["delay"]
    whole = replace(delay, value=delay.value + seen.age, low=delay.low + seen.age, high=delay.high + seen.age)
    return RobotEstimate(seen.robots[robot], figures | {"delay": whole}, True)


def _obeys(
    misses: Callable[[FloatArray, FloatArray], FloatArray],
    commands: FloatArray,
    p: FloatArray,
    scale: FloatArray,
) -> bool:
    """Return whether the commands say clearly more of the motion than the same commands at other times do.

    They do not where somebody else drove the robot; then limits would be fitted to what is no answer to them.
    """
    costs = [
        float(np.nansum(_cauchy(np.abs(misses(p, np.roll(commands, shift, axis=0)) / scale))[0]))
        for shift in (0, *(round(share * len(commands)) for share in _OTHER_TIMES))
    ]
    return min(costs[1:]) > _OBEYING * costs[0]


def _first(misses: Misses) -> FloatArray:
    """Return roughly the best parameters, looked for one by one over their whole ranges."""
    p = _USUAL_LIMITS.copy()
    for sweep in range(2):
        for i in range(len(p)):
            values = _tried(p, i, sweep > 0)
            trials = [
                np.clip(np.where(np.arange(len(p)) == i, value, p), _SMALLEST_LIMITS, _LARGEST_LIMITS)
                for value in values
            ]
            p = min(trials, key=lambda tried: _size(misses(tried)))
    return p


def _tried(p: FloatArray, i: int, near: bool) -> FloatArray:
    """Return the values of one parameter to try, beside those of the others."""
    if i == 0:
        return float(p[0]) + _DELAYS_NEAR if near else _DELAYS
    if i < _GAIN:
        return float(p[i]) * _LIMIT_FACTORS
    if i < _FIRST_LAG:
        return float(p[i]) * _GAIN_FACTORS
    return _TRIED_LAGS if i < _CROSS else _CROSSES


def _size(found: FloatArray) -> float:
    """Return how large misses are, bounded for each, so that what no parameters explain does not decide."""
    scale = _scale(found)
    return float(np.nansum(1.0 - np.exp(-0.5 * (found / (3.0 * scale)) ** 2) + np.log(scale)))


def _scale(found: FloatArray) -> FloatArray:
    """Return robust standard deviations of the misses along and about the axes."""
    # Numpy's median that skips gaps takes longer than to predict all poses.
    spread = 1.4826 * np.array([np.median(column[~np.isnan(column)]) for column in np.abs(found).T])
    linear = max(float(spread[:2].mean()), 1e-5)
    return np.array([linear, linear, max(float(spread[2]), 1e-5)])


def _huber(size: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return cost and weight of misses by their size in standard deviations."""
    return np.where(
        size < _LARGE_MISS, 0.5 * size**2, _LARGE_MISS * (size - 0.5 * _LARGE_MISS)
    ), 1.0 / np.maximum(1.0, size / _LARGE_MISS)


def _cauchy(size: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return cost and weight of misses by their size in standard deviations; large ones hardly count."""
    ratio = (size / _LARGE_MISS) ** 2
    return 0.5 * _LARGE_MISS**2 * np.log1p(ratio), 1.0 / (1.0 + ratio)


def _coordinates(p: FloatArray) -> FloatArray:
    ratio = np.where(_LINEAR, 1.0, p / np.where(_LINEAR, 1.0, _USUAL_LIMITS))
    z: FloatArray = np.where(_LINEAR, p, np.log(ratio)) / _LIMITS_ERROR
    return z


def _parameters(z: FloatArray) -> FloatArray:
    size = z * _LIMITS_ERROR
    p = np.where(_LINEAR, size, _USUAL_LIMITS * np.exp(np.where(_LINEAR, 0.0, size)))
    within: FloatArray = np.clip(p, _SMALLEST_LIMITS, _LARGEST_LIMITS)
    return within


def _centre() -> FloatArray:
    return _coordinates(_USUAL_LIMITS)


def _cost(found: FloatArray, z: FloatArray, scale: FloatArray, shape: Shape) -> float:
    sizes = np.abs(found / scale)
    return float(np.nansum(shape(sizes)[0]) + 0.5 * np.sum((z - _centre()) ** 2))


def _slopes(misses: Misses, z: FloatArray, scale: FloatArray) -> FloatArray:
    """Return (T, 3, P) derivatives of the scaled misses."""
    slopes = []
    for i in range(len(z)):
        step = np.zeros(len(z))
        step[i] = (0.002 if _LINEAR[i] else 0.01) / _LIMITS_ERROR[i]
        change = misses(_parameters(z + step)) - misses(_parameters(z - step))
        slopes.append(change / (2.0 * step[i]) / scale)
    known: FloatArray = np.nan_to_num(np.stack(slopes, axis=2))
    return known


def _fit(misses: Misses, p: FloatArray, scale: FloatArray, shape: Shape) -> FloatArray:
    """Return the parameters with the least robust cost, by Levenberg and Marquardt's method."""
    z, damping = _coordinates(p), 1e-2
    found = misses(_parameters(z))
    cost = _cost(found, z, scale, shape)
    for _ in range(_MOST_FIT_STEPS):
        slopes = _slopes(misses, z, scale)
        left = np.nan_to_num(found / scale)
        weights = shape(np.abs(left))[1]
        normal = np.einsum("tai,ta,taj->ij", slopes, weights, slopes) + np.eye(len(z))
        gradient = np.einsum("tai,ta,ta->i", slopes, weights, left) + z - _centre()
        gained = 0.0
        while damping < 1e5:
            step = -np.linalg.solve(normal + damping * np.diag(np.diag(normal)), gradient)
            new = z + np.clip(step, -1.0, 1.0)
            tried = misses(_parameters(new))
            lower = _cost(tried, new, scale, shape)
            if lower < cost:
                gained, z, found, cost = cost - lower, new, tried, lower
                damping = max(damping / 5.0, 1e-6)
                break
            damping *= 4.0
        if gained < 1e-5 * cost:
            break
    return _parameters(z)


def _matters(misses: Misses, p: FloatArray, i: int, scale: FloatArray) -> bool:
    """Return whether a limit was met: whether the robot is followed clearly worse without it."""
    if i == 0 or i >= _GAIN:
        return True
    without = p.copy()
    without[i] *= _RELAXED
    costs = [float(np.nansum(_cauchy(np.abs(misses(tried) / scale))[0])) for tried in (p, without)]
    return costs[1] - costs[0] > _CLEARLY


def _figures(misses: Misses, p: FloatArray, scale: FloatArray, times: FloatArray) -> dict[str, Estimate]:
    """Return the figures with intervals from the sandwich over blocks of time."""
    z = _coordinates(p)
    slopes = _slopes(misses, z, scale)
    left = np.nan_to_num(misses(p) / scale)
    weights = _cauchy(np.abs(left))[1]
    bread = np.einsum("tai,ta,taj->ij", slopes, weights, slopes) + np.eye(len(z))
    scores = np.einsum("tai,ta,ta->ti", slopes, weights, left)
    blocks = ((times - times[0]) / _BLOCK).astype(int)
    sums = np.zeros((blocks[-1] + 1, len(z)))
    np.add.at(sums, blocks, scores)
    inverse = np.linalg.inv(bread)
    covariance = inverse @ (sums.T @ sums + np.eye(len(z))) @ inverse
    plain = inverse * 1.0
    errors = np.sqrt(np.maximum(np.diag(covariance), np.diag(plain)))
    active = np.zeros((blocks[-1] + 1, len(z)))
    np.add.at(active, blocks, np.einsum("tai,ta->ti", slopes**2, weights))
    figures = {}
    for i, name in enumerate(DRIVE_PARAMETERS):
        # The number of blocks that share the information evenly.
        told = active[:, i]
        count = int(told.sum() ** 2 / max(float((told**2).sum()), 1e-12)) if told.sum() > 1.0 else 0
        error = errors[i] * _LIMITS_ERROR[i]
        error = hypot(error, _UNRESOLVED_TIME if _LINEAR[i] and i < _CROSS else _UNRESOLVED_SHARE)
        half = quantile(max(count - 1, 1)) * error
        value = float(p[i])
        low, high = value - half, value + half
        if not _LINEAR[i]:
            low, high = value * np.exp(-half), value * np.exp(half)
        if not name.startswith("cross"):
            # Nothing but what appears on the other axis can be negative.
            low = max(low, 0.0)
        most = _MOST_TIME_ERROR if _LINEAR[i] and i < _CROSS else _MOST_LIMIT_ERROR
        enough = count >= 2 and half < most and _matters(misses, p, i, scale)
        figures[name] = Estimate(value, float(low), float(high), count, bool(enough), UNITS[name])
    return figures
