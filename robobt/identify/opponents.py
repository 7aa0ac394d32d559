"""A robot's top speed, acceleration and braking from how it was seen to move alone.

Robots drive as hard as they can most of the time, so the limits are where what they do piles up: the share
of an ellipse of accelerations that a short window of motion used, of which most are at one and none beyond.
"""

from __future__ import annotations

from math import inf, log

import numpy as np

from robobt.identify.estimate import Estimate, quantile, unseen, widened
from robobt.identify.observations import Observations
from robobt.identify.robots import UNITS, RobotEstimate
from robobt.identify.windows import Windows, undisturbed, windows
from robobt.world.geometry import FloatArray, wrap_angles

_SPEED_TIME, _RATE_TIME = 0.2, 0.25
"""Length of the windows in which speed and acceleration are measured [s]."""

_STEADY_WINDOW = 1.6
"""A window whose polynomial leaves more than this many times the noise holds a change of acceleration."""

_AT_TOP_SPEED = 0.985
"""Share of the fastest window's speed from which windows count as at top speed."""

_LEAST_SPRINTS, _LEAST_TOP = 2, 1.6
"""Number of separate sprints at top speed, and the least such speed: in stops the rules allow 1.5 [m/s]."""

_LEAST_RATE, _MOST_TURNED = 0.8, 0.25
"""Least acceleration of a window that tells something [m/s^2], and the most that the robot turns in it
[rad]."""

_ALONG = 0.35
"""Least cosine between acceleration and velocity of windows that speed up or slow down."""

_LEAST_TELLING_WINDOWS = 6

_GRID, _FINER_GRIDS = 61, (1.06, 1.04)
"""Size of the grid on which half axes are looked for, and the two finer ones around what was found."""

_ELLIPSES = (
    (1.0, 0.02, "acceleration", "side_acceleration"),
    (-1.0, 0.04, "braking", "side_braking"),
)
"""For speeding up and slowing down: its sign, the relative half width for robots that do not use all of their
limit (found on fields other than the blind ones), and the figures."""

_MOST_PILE_ERROR = 0.1
"""Relative half width of an interval beyond which a limit is not seen enough."""


def identify_opponent(seen: Observations, robot: int, noise: float) -> RobotEstimate:
    """Identify the robot at this place of the arrays from how it moved.

    Args:
        seen: what cameras saw.
        robot: its place.
        noise: standard deviation of a robot's position [m].

    Returns:
        its figures, each with its interval; those that need commands are not seen enough.
    """
    figures = {name: unseen(0, unit) for name, unit in UNITS.items()}
    free = undisturbed(seen, robot)
    figures["max_speed"] = _top_speed(seen, robot, noise, free)
    length = max(8, round(_RATE_TIME / seen.period))
    found = windows(seen, robot, length, 2, max(1, length // 3))
    rates = _rates(found, free, noise, length, seen.period)
    for sign, slack, *names in _ELLIPSES:
        for name, figure in zip(names, _ellipse(rates[rates[:, 2] == sign]), strict=True):
            figures[name] = widened(figure, slack)
    return RobotEstimate(seen.robots[robot], figures, False)


def _top_speed(seen: Observations, robot: int, noise: float, free: np.ndarray) -> Estimate:
    length = max(6, round(_SPEED_TIME / seen.period))
    found = windows(seen, robot, length, 1, max(1, length // 3))
    steady = free[found.rows] & (found.spread[:, :2].max(axis=1) < _STEADY_WINDOW * noise)
    speeds = np.hypot(*found.velocity.T)[steady]
    times = found.times[steady]
    if len(speeds) < _LEAST_TELLING_WINDOWS:
        return unseen(len(speeds), "m/s")
    # What a single window's noise adds to the fastest of many does not count.
    top = float(np.sort(speeds)[-3:].min())
    fast = speeds > _AT_TOP_SPEED * top
    sprints = 1 + int(np.sum(np.diff(times[fast]) > 2.0 * _SPEED_TIME))
    values = speeds[fast]
    middle = float(np.median(values))
    spread = float(values.std(ddof=1)) if len(values) > 1 else inf
    error = spread / np.sqrt(sprints) + 0.001 * middle
    half = quantile(max(sprints - 1, 1) + 2) * error
    enough = sprints >= _LEAST_SPRINTS and middle > _LEAST_TOP and half < _MOST_PILE_ERROR * middle
    return Estimate(middle, middle - half, middle + half, sprints, bool(enough), "m/s")


def _rates(found: Windows, free: np.ndarray, noise: float, length: int, period: float) -> FloatArray:
    """Return (m, 4) accelerations along and across the heading, 1 for speeding up or -1, and their error."""
    n = length
    error = noise * np.sqrt(720.0 / (n * (n * n - 1.0) * (n * n - 4.0))) / period**2
    size = np.hypot(*found.acceleration.T)
    speed = np.hypot(*found.velocity.T)
    along = (found.acceleration * found.velocity).sum(axis=1) / np.maximum(size * speed, 1e-9)
    turned = np.abs(found.turn) * n * period
    good = free[found.rows] & (found.spread[:, :2].max(axis=1) < _STEADY_WINDOW * noise)
    good &= (size > _LEAST_RATE) & (turned < _MOST_TURNED) & (np.abs(along) > _ALONG)
    # The whole window has to speed up, or slow down.
    good &= speed > 0.5 * size * n * period
    bearing = wrap_angles(np.arctan2(found.acceleration[:, 1], found.acceleration[:, 0]) - found.heading)
    errors = np.full(len(size), error)
    rows: FloatArray = np.column_stack(
        [size * np.cos(bearing), size * np.sin(bearing), np.sign(along), errors]
    )
    told: FloatArray = rows[good]
    return told


def _ellipse(rates: FloatArray) -> tuple[Estimate, Estimate]:
    """Return the ellipse's half axes ahead and aside at which accelerations pile up."""
    nothing = unseen(len(rates), "m/s²"), unseen(len(rates), "m/s²")
    if len(rates) < _LEAST_TELLING_WINDOWS:
        return nothing
    size = np.hypot(rates[:, 0], rates[:, 1])
    top = float(np.quantile(size, 0.9))
    along = across = top * np.exp(np.linspace(log(0.4), log(1.6), _GRID))
    costs = _surface(rates, along, across)
    for step in _FINER_GRIDS:
        i, j = np.unravel_index(int(costs.argmin()), costs.shape)
        near = step ** np.linspace(-2.0, 2.0, _GRID)
        along, across = along[i] * near, across[j] * near
        costs = _surface(rates, along, across)
    return _profile(costs.min(axis=1), along, len(rates)), _profile(costs.min(axis=0), across, len(rates))


def _surface(rates: FloatArray, along: FloatArray, across: FloatArray) -> FloatArray:
    """Return the negative logarithm of the likelihood for every pair of half axes.

    A window is at the limit with a probability of its own, or anywhere below it.
    """
    ahead, aside, error = rates[:, 0], rates[:, 1], rates[:, 3]
    share = np.sqrt((ahead / along[:, None, None]) ** 2 + (aside / across[None, :, None]) ** 2)
    size = np.hypot(ahead, aside)
    spread = np.hypot(share * error / size, _ROUGH)
    off = (share - 1.0) / spread
    at = np.exp(-0.5 * off**2) / (2.5066 * spread)
    below = 1.0 / (1.0 + np.exp(np.clip(1.702 * off, -50.0, 50.0)))
    best = np.full(share.shape[:2], inf)
    for often in _OFTEN:
        chance = often * at + (1.0 - often) * below + _OUTLIER_DENSITY
        best = np.minimum(best, -np.log(chance).sum(axis=2) - np.log(share / size).sum(axis=2))
    return best


_OFTEN = (0.2, 0.4, 0.6, 0.8)
"""Shares of windows at the limit that are tried."""

_OUTLIER_DENSITY = 1e-3
"""Density of windows that nothing explains, such as after a push."""

_ROUGH = 0.01
"""Relative standard deviation of accelerations at the limit beyond noise."""


def _profile(costs: FloatArray, values: FloatArray, count: int) -> Estimate:
    """Return the best value and the interval in which the cost stays within what chance explains."""
    best = int(costs.argmin())
    inside = np.flatnonzero(costs < costs[best] + _COST_WITHIN)
    low, high = float(values[inside[0]]), float(values[inside[-1]])
    value = float(values[best])
    open_ended = inside[0] == 0 or inside[-1] == len(values) - 1
    enough = not open_ended and (high - low) / 2.0 < _MOST_PILE_ERROR * value
    return Estimate(value, low, high, count, bool(enough), "m/s²")


_COST_WITHIN = 2.0 * 1.92
"""Rise of the cost at the ends of a 95 % interval; windows overlap by half, so it is doubled."""
