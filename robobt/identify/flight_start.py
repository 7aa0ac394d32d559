"""Roughly how a ball was chipped, by trying every duration of its first flight: a fit starts from there."""

from __future__ import annotations

from math import hypot, inf

import numpy as np

from robobt.identify.flight_model import NEAREST, ChipFlight, flown, touch_downs
from robobt.world.ball_model import GRAVITY
from robobt.world.geometry import FloatArray

SLOWEST_CHIP = 1.0
"""No chip of interest is slower along the ground [m/s]."""

CHIP_LEAST, CHIP_MOST = 0.75, 1.35
"""Least and greatest tangent of the angle at which a ball was chipped: robots chip at about 45 degrees, and
what seems to be another angle was touched on its way."""

_ROUGHLY = 1.1
"""Factor by which it may be off here."""

_DURATIONS = np.arange(0.2, 1.26, 0.03)
"""Durations of the first flight that are tried [s]: chips that rise 5 cm to 2 m."""

_REBOUNDS = (0.35, 0.45, 0.55, 0.65)
"""Shares of the speed of falling with which the ball rises that are tried."""

_EARLIER = (0.0, 0.04, 0.08, 0.12, 0.16)
"""How long before the ball was first seen on its way it is taken to be launched, where only the flight itself
tells [s]."""

_LEAST_KEPT, _MOST_KEPT = 0.3, 1.0
"""Bounds of the shares of its speed that a ball keeps at a touch-down."""


def start_flight(flight: ChipFlight) -> bool:
    """Find roughly the best launch and hops of a flight; return whether there is any.

    Args:
        flight: whose ``launch`` and ``hops`` are set.
    """
    least = inf
    for start in _starts(flight):
        since = flight.times - flight.launched.first - start
        for duration in _DURATIONS.tolist():
            for rebound in _REBOUNDS:
                rise = 0.5 * GRAVITY * duration
                found, left = _speeds(flight, since, rise, rebound)
                speeds = np.hypot(*found[1:].T)
                steep = rise / max(float(speeds[0]), 1e-6) if len(speeds) else 0.0
                if left < least and CHIP_LEAST / _ROUGHLY < steep < CHIP_MOST * _ROUGHLY:
                    least = left
                    kept = np.clip(speeds[1:] / np.maximum(speeds[:-1], 1e-6), _LEAST_KEPT, _MOST_KEPT)
                    flight.hops = np.array([*kept[:2], *flight.hops[len(kept[:2]) : 2], rebound])
                    flight.launch = np.array([*found[0], *found[1], rise, start, 0.0, 0.0, 0.0])
    return least < inf


def _starts(flight: ChipFlight) -> tuple[float, ...]:
    """Return launch times to try, after the ball was first seen on its way [s]."""
    if np.any(flight.nearness):
        return tuple([-earlier for earlier in _EARLIER])
    count = min(len(flight.times), 5)
    took = flight.times[count - 1] - flight.times[0]
    speed = hypot(*(flight.places[count - 1] - flight.places[0])) / took
    return (-hypot(*(flight.places[0] - flight.launched.place)) / max(speed, SLOWEST_CHIP),)


def _speeds(flight: ChipFlight, since: FloatArray, rise: float, rebound: float) -> tuple[FloatArray, float]:
    """Return (k, 2) place of the launch and velocities from touch-down to touch-down, and their misfit."""
    lands = [0.0, *touch_downs(rise, rebound)]
    _, height = flown(since, 1.0, rise, np.array([1.0, 1.0, rebound]), flight.slowing)
    share = np.minimum(height * flight.nearness, NEAREST)[:, None]
    over = flight.places * (1.0 - share) + flight.eyes * share
    way = over[-1] - over[0]
    rolled = np.maximum(since - lands[-1], 0.0)
    over = over + 0.5 * flight.slowing * rolled[:, None] ** 2 * way / max(hypot(*way), 1e-9)
    columns = [np.clip(since, a, b) - a for a, b in zip(lands, [*lands[1:], inf], strict=True)]
    basis = np.column_stack([np.ones(len(since)), *[column for column in columns if np.ptp(column) > 0.0]])
    found: FloatArray = np.linalg.lstsq(basis, over, rcond=None)[0]
    return found, float(np.sum((over - basis @ found) ** 2))
