"""How a chipped ball flies, as cameras see it: a launch of its own, and hops that all chips share.

It flies as the league's model chip_fixed_loss says: between touch-downs it moves along the ground at a
constant speed, of which it keeps a share at each, and it rises with a share of the speed with which it fell.
So a change of its speed tells a share, and the times of the changes tell how high it rises. A camera whose
place is known shows the height too, because it takes every ball to lie on the ground.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, inf
from typing import NamedTuple

import numpy as np

from robobt.world.ball_model import GRAVITY, LOWEST_HOP
from robobt.world.geometry import FloatArray

USUAL_HOPS, _HOPS_ERROR = np.array([0.75, 0.9, 0.5]), 0.3
"""Shares kept at the first and the other touch-downs and of the rise before anything was seen, and their
standard error, which a single touch-down outweighs."""

_LOWER_HOPS, _UPPER_HOPS = np.array([0.05, 0.05, 0.05]), np.array([1.05, 1.05, 0.95])
"""Bounds of those shares."""

_SLOWEST_RISE, _FASTEST_RISE, _LAUNCHED_WITHIN = 0.3, 6.5, 0.005
"""Bounds of the speed with which a chip rises [m/s], and how long before it was last seen at rest or after it
was first seen on its way a ball may have been launched [s]."""

_ENOUGH, _MOST_STEPS = 1e-6, 2000
"""A fit ends when its cost changes by less than this share, or after this many evaluations."""

_BEYOND_BOUNDS = 0.01
"""Standard deviation of what is beyond the bounds, each in its unit."""

LEAST_NOISE = 0.0005
"""Standard deviation of a detection below which the model of flights is not exact [m]."""

_SEEN_AFTER = 0.04
"""A touch-down is seen if the ball was seen this long after it [s]."""

LAUNCH_NUMBERS = 9
"""Numbers that describe a launch; see :attr:`ChipFlight.launch`."""

_CAMERA_ERROR = 0.1
"""Standard deviation by which cameras are elsewhere than they say [m]. Source: ER-Force's simulator, whose
realistic level has 0.1."""

NEAREST = 0.9
"""A ball never counts as higher than this share of the camera's height."""


class Launched(NamedTuple):
    """When and where a ball was launched: as it was seen before.

    Attributes:
        first: when it was first seen on its way [s].
        last: when it was last seen before [s].
        place: (2,) where it would have been at ``first`` without the kick [m].
        drove: (2,) its velocity before the kick [m/s].
        error: standard deviation of the launch from there [m].
    """

    first: float
    last: float
    place: FloatArray
    drove: FloatArray
    error: float


@dataclass(slots=True)
class ChipFlight:
    """A chip as cameras saw it.

    Attributes:
        times: (n,) of the detections [s].
        places: (n, 2) of the detections [m].
        eyes: (n, 2) where the camera hangs that made each [m].
        nearness: (n,) 1 over the height of that camera above the ball on the ground [1/m]; 0 where places are
            those above which the ball is.
        launched: what is known of its launch beside the flight.
        launch: (9,) x, y [m], vx, vy, vz [m/s] at the kick, how long that was after the ball was first seen
            on its way [s], and by how much the cameras are elsewhere than they say, x, y and height [m].
        hops: (3,) as for :func:`flown`, as this flight alone shows them.
        slowing: of the ball once it rolls [m/s^2].
    """

    times: FloatArray
    places: FloatArray
    eyes: FloatArray
    nearness: FloatArray
    launched: Launched
    launch: FloatArray
    hops: FloatArray
    slowing: float

    @property
    def elevation(self) -> float:
        """Tangent of the angle at which the ball was chipped."""
        return float(self.launch[4]) / max(hypot(*self.launch[2:4]), 1e-6)

    def misses(self, launch: FloatArray, hops: FloatArray) -> FloatArray:
        """Return (n, 2) by how much what was seen misses a flight [m].

        Args:
            launch: (9,) as in :attr:`launch`.
            hops: (3,) as for :func:`flown`.
        """
        x, y, vx, vy, rise, start, *_, higher = launch.tolist()
        speed = max(hypot(vx, vy), 1e-6)
        gone, height = flown(self.times - self.launched.first - start, speed, rise, hops, self.slowing)
        ahead = np.array([vx, vy]) / speed
        over = np.array([x, y]) + gone[:, None] * ahead
        share = np.minimum(height * self.nearness / (1.0 + higher * self.nearness), NEAREST)[:, None]
        missed: FloatArray = self.places - (over - (self.eyes + launch[6:8]) * share) / (1.0 - share)
        return missed

    def astray(self, launch: FloatArray) -> FloatArray:
        """Return (5,) by how much a launch, (9,), is unexpected, in standard deviations.

        The first two say how far it is from where the ball was seen to go before.
        """
        before = self.launched.place + self.launched.drove * launch[5]
        return np.concatenate([(launch[:2] - before) / self.launched.error, launch[6:] / _CAMERA_ERROR])

    def seen_touch_downs(self, rebound: float) -> int:
        """Return how many touch-downs were seen, with some of what came after each."""
        lands = np.array(touch_downs(float(self.launch[4]), rebound)) + self.launch[5]
        return int(np.sum(lands < self.times[-1] - self.launched.first - _SEEN_AFTER))


def touch_downs(rise: float, rebound: float) -> list[float]:
    """Return when a chip that rises at a speed [m/s] touches down, up to where it begins to roll [s].

    Args:
        rise: speed with which the ball rises [m/s].
        rebound: share of the speed of falling with which it rises again.
    """
    times = [2.0 * rise / GRAVITY]
    while (rise := rise * rebound) ** 2 >= 2.0 * GRAVITY * LOWEST_HOP:
        times.append(times[-1] + 2.0 * rise / GRAVITY)
    return times


def flown(
    since: FloatArray, speed: float, rise: float, hops: FloatArray, slowing: float
) -> tuple[FloatArray, FloatArray]:
    """Return (n,) how far a chipped ball has come along the ground, and how high it is [m].

    Args:
        since: (n,) times after the kick, before which the ball rests [s].
        speed: along the ground [m/s].
        rise: speed with which it rises [m/s].
        hops: (3,) shares of the speed along the ground that the first and the other touch-downs leave, and of
            the speed of falling with which the ball rises.
        slowing: of the ball once it rolls [m/s^2].
    """
    first, others, rebound = hops.tolist()
    gone, height, began = np.zeros(len(since)), np.zeros(len(since)), 0.0
    for number, lands in enumerate(touch_downs(rise, rebound)):
        inside = np.clip(since, began, lands) - began
        gone += speed * inside
        height += np.maximum((rise - 0.5 * GRAVITY * inside) * inside, 0.0)
        speed *= others if number else first
        rise, began = rise * rebound, lands
    rolled = np.clip(since - began, 0.0, speed / slowing)
    gone += (speed - 0.5 * slowing * rolled) * rolled
    return gone, height


class FlightFit(NamedTuple):
    """A fit of flights.

    Attributes:
        hops: (3,) as for :func:`flown`.
        launches: (n, 9) as in :class:`ChipFlight`.
        slopes: derivatives of the misses by hops and launches.
        misses: three of the hops, then those of each flight, two a detection and five its launch, then what
            is beyond bounds, in standard deviations.
    """

    hops: FloatArray
    launches: FloatArray
    slopes: FloatArray
    misses: FloatArray


def fit_flights(flights: list[ChipFlight], starts: list[FloatArray], noise: float) -> FlightFit:
    """Fit the launch of each flight, and the hops that all share.

    Args:
        flights: at least one, each with a launch to start from.
        starts: hops, (3,) as for :func:`flown`, to start from; the best fit counts, as the number of
            touch-downs does not change smoothly.
        noise: standard deviation of a detection, per axis [m].

    Returns:
        the fit.
    """
    from scipy.optimize import least_squares

    least, most = [_LOWER_HOPS], [_UPPER_HOPS]
    for it in flights:
        before = it.launched.last - it.launched.first
        least.append(np.array([*[-inf] * 4, _SLOWEST_RISE, before - _LAUNCHED_WITHIN, *[-inf] * 3]))
        most.append(np.array([*[inf] * 4, _FASTEST_RISE, _LAUNCHED_WITHIN, *[inf] * 3]))
    low, high = np.concatenate(least), np.concatenate(most)

    def misses(numbers: FloatArray) -> FloatArray:
        within = np.clip(numbers, low, high)
        beyond = (numbers - within)[np.isfinite(low)] / _BEYOND_BOUNDS
        parts = [(numbers[:3] - USUAL_HOPS) / _HOPS_ERROR]
        for flight, launch in zip(flights, within[3:].reshape(-1, LAUNCH_NUMBERS), strict=True):
            parts += [flight.misses(launch, within[:3]).ravel() / noise, flight.astray(launch)]
        return np.concatenate([*parts, beyond])

    fits = []
    for hops in starts:
        start = np.clip(np.concatenate([hops, *[it.launch for it in flights]]), low, high)
        size = np.maximum(np.abs(start), 0.1)
        fits.append(
            least_squares(misses, start, method="lm", x_scale=size, ftol=_ENOUGH, max_nfev=_MOST_STEPS)
        )
    found = min(fits, key=lambda fit: fit.cost)
    numbers = np.clip(found.x, low, high)
    return FlightFit(numbers[:3], numbers[3:].reshape(-1, LAUNCH_NUMBERS), np.asarray(found.jac), found.fun)
