"""How a chipped ball hops: the shares of its speed that it keeps where it touches down."""

from __future__ import annotations

from dataclasses import replace
from math import sqrt
from typing import NamedTuple

import numpy as np

from robobt.identify.estimate import Estimate, from_error, not_negative, quantile, unseen
from robobt.identify.flight_model import LEAST_NOISE, ChipFlight, FlightFit, fit_flights
from robobt.identify.flights import flights_of
from robobt.identify.free_ball import Stretch
from robobt.identify.observations import Observations
from robobt.world.ball_model import BallModel
from robobt.world.geometry import FloatArray

_TOUCH_DOWNS = (1, 2, 2)
"""Number of touch-downs that a chip needs to tell each of the shares."""

_MOST_HOP_ERROR = 0.04
"""Half width of an interval beyond which a share is not seen enough."""

_CHIPS_DIFFER = 0.01
"""Standard deviation by which chips on one carpet are taken to differ, because few of them cannot show it."""

_HOP_STARTS = 4
"""Number of chips from whose own hops a fit of all is started, beside their median."""

_CHIPS_SHOW_SPREAD = 3
"""Number of chips from which what they differ by counts too."""


class HopEstimate(NamedTuple):
    """What touch-downs leave of a chipped ball's speed.

    Attributes:
        first_hop: share of its speed along the ground that it keeps at the first touch-down.
        other_hops: the same at all others.
        rebound: share of the speed of falling with which it rises.
    """

    first_hop: Estimate
    other_hops: Estimate
    rebound: Estimate


def identify_hops(seen: Observations, free: list[Stretch], ball: BallModel, noise: float) -> HopEstimate:
    """Identify how a chipped ball hops.

    Args:
        seen: what cameras saw and what was sent.
        free: its stretches of free ball.
        ball: how the ball slides and rolls.
        noise: standard deviation of a detected position of the ball, per axis [m].

    Returns:
        the shares, each with its interval.
    """
    noise = max(noise, LEAST_NOISE)
    flights = flights_of(seen, free, ball, noise)
    if not flights:
        return HopEstimate(unseen(), unseen(), unseen())
    own = [flight.hops for flight in flights]
    fit = fit_flights(flights, [np.median(own, axis=0), *own[:_HOP_STARTS]], noise)
    for flight, launch in zip(flights, fit.launches, strict=True):
        flight.launch = launch
    return HopEstimate(
        *[
            _judged(
                float(share), error, sum(it.seen_touch_downs(float(fit.hops[2])) >= least for it in flights)
            )
            for share, error, least in zip(fit.hops, _errors(fit, flights), _TOUCH_DOWNS, strict=True)
        ]
    )


def _judged(share: float, error: float, count: int) -> Estimate:
    estimate = not_negative(from_error(share, error, count, count > 0))
    return replace(estimate, seen=estimate.seen and estimate.half_width < _MOST_HOP_ERROR)


def _errors(fit: FlightFit, flights: list[ChipFlight]) -> list[float]:
    """Return the standard errors of the shares: those of the noise, or those by which chips differ."""
    inverse = np.linalg.pinv(fit.slopes.T @ fit.slopes)[:3, :3]
    freedom = max(len(fit.misses) - fit.slopes.shape[1], 1)
    spread = max(float(np.sum(fit.misses**2)) / freedom, 1.0)
    errors = np.sqrt(spread * np.diag(inverse))
    if len(flights) >= _CHIPS_SHOW_SPREAD:
        meat, row = np.zeros((3, 3)), 3
        for flight in flights:
            rows = slice(row, row := row + 2 * len(flight.times) + 5)
            score: FloatArray = fit.slopes[rows, :3].T @ fit.misses[rows]
            meat += np.outer(score, score)
        count = len(flights)
        sandwich = np.diag(inverse @ meat @ inverse) * count / (count - 1)
        errors = np.maximum(errors, np.sqrt(sandwich) * quantile(count - 1) / quantile(0))
    return [sqrt(float(error) ** 2 + _CHIPS_DIFFER**2 / len(flights)) for error in errors]
