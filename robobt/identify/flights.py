"""Chipped balls, found among the kicks that were seen."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, inf, sqrt

import numpy as np

from robobt.identify.ball_ways import MOUTH_DISTANCE
from robobt.identify.flight_model import (
    LAUNCH_NUMBERS,
    NEAREST,
    USUAL_HOPS,
    ChipFlight,
    Launched,
    fit_flights,
    flown,
    touch_downs,
)
from robobt.identify.free_ball import FREE, Stretch, at_wall, carried_on
from robobt.identify.observations import Observations
from robobt.league.estimate.flat_kick import flat_misfit
from robobt.sim.settings import BallSettings
from robobt.world.ball_model import GRAVITY, BallModel
from robobt.world.geometry import FloatArray
from robobt.world.state import BALL_RADIUS

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


_LONGEST_FLIGHT, _LONGEST_FLIGHT_GAP = 2.0, 0.12
"""Time for which a ball is followed after a kick, and the longest time without a detection in it [s]."""

_LEAST_DETECTIONS = 12

_AT_FIRST_GLANCE = 15
"""Number of detections in which a chip has to be fast enough."""

_COMMAND_BEFORE, _COMMAND_AFTER = 0.35, 0.05
"""How long before and after a kick is seen its command may have been sent [s]."""

_AT_FIRST, _LEAST_BEFORE = 5, 3
"""Number of detections that tell where a ball goes, and the least that tell where it went before."""

_LAUNCHED_BEFORE, _ASTRAY = 0.25, 0.015
"""How long before it was free a ball may have been launched [s], and how far off its line it may be seen
[m]."""

_BALL_PLACE, _MOUTH_PLACE = 0.01, 0.03
"""Standard deviation of a launch from where the ball, or a robot's mouth, was seen to go before [m]."""

_WORST_CHIP, _BETTER_THAN_FLAT = 1.5, 0.3
"""A flight fits if it leaves at most this many times the noise, and this share of what a flat kick leaves."""

_POSE_TIME = 0.1
"""Ball and robot at the kick are where a line through what was seen within this time of it leads [s]."""


def flights_of(seen: Observations, free: list[Stretch], ball: BallModel, noise: float) -> list[ChipFlight]:
    """Return the chips among the kicks.

    Args:
        seen: what cameras saw and what was sent.
        free: its stretches of free ball.
        ball: how the ball slides and rolls.
        noise: standard deviation of a detected position of the ball, per axis [m].

    Returns:
        the chips, in their order, each with the launch that fits best.
    """
    poses = carried_on(seen.poses)
    sights = _sights(seen)
    found: list[ChipFlight] = []
    for stretch in free:
        if stretch.before < 0 or (found and stretch.times[0] < found[-1].times[-1]):
            continue
        if not _may_be_chip(seen, stretch):
            continue
        for flight in _candidates(seen, poses, sights, stretch, ball.roll_deceleration):
            if _fits(flight, ball, noise):
                found.append(flight)
                break
    return found


@dataclass(slots=True)
class _Sights:
    """Detections of the ball: (n,) times, (n, 2) places, (n, 2) and (n,) as in :class:`ChipFlight`."""

    times: FloatArray
    places: FloatArray
    eyes: FloatArray
    nearness: FloatArray


def _sights(seen: Observations) -> _Sights:
    views = seen.views
    if views is None or not views.places:
        known = np.isfinite(seen.ball[:, 0])
        count = int(known.sum())
        return _Sights(seen.times[known], seen.ball[known], np.zeros((count, 2)), np.zeros(count))
    known = np.isfinite(views.ball[:, 0]) & np.isin(views.cameras, list(views.places))
    hung = np.array([views.places[camera] for camera in views.cameras[known].tolist()]).reshape(-1, 3)
    return _Sights(
        views.times[known], views.ball[known], hung[:, :2], 1.0 / np.maximum(hung[:, 2] - BALL_RADIUS, 0.5)
    )


def _may_be_chip(seen: Observations, stretch: Stretch) -> bool:
    """Return whether the ball left fast, and its robot was not seen to be sent a flat kick."""
    count = min(len(stretch.times), _AT_FIRST_GLANCE)
    way, took = stretch.places[count - 1] - stretch.places[0], stretch.times[count - 1] - stretch.times[0]
    if hypot(*way) < SLOWEST_CHIP * took:
        return False
    if not seen.commanded(stretch.before):
        return True
    since = seen.sent - (float(stretch.times[0]) - seen.age)
    rows = np.flatnonzero((since > -_COMMAND_BEFORE) & (since < _COMMAND_AFTER))
    kicks = seen.commands[rows, stretch.before]
    return bool(np.any((kicks[:, 3] > 0.0) & (kicks[:, 4] > 0.0)))


def _candidates(
    seen: Observations, poses: FloatArray, sights: _Sights, stretch: Stretch, slowing: float
) -> list[ChipFlight]:
    """Return what was seen after a kick, up to several ends, the longest first.

    A ball in the air passes over robots; on the ground its way ends there.
    """
    launched = _launched(seen, sights, stretch)
    if launched is None:
        return []
    kicked = launched.first
    rows = np.flatnonzero((sights.times >= kicked - 1e-9) & (sights.times < kicked + _LONGEST_FLIGHT))
    gaps = np.flatnonzero(np.diff(sights.times[rows]) > _LONGEST_FLIGHT_GAP)
    rows = rows[: gaps[0] + 1] if len(gaps) else rows
    walls = [i for i, row in enumerate(rows.tolist()) if at_wall(seen.field, sights.places[row])]
    rows = rows[: walls[0]] if walls else rows
    at = np.clip(np.searchsorted(seen.times, sights.times[rows]), 0, len(seen.times) - 1)
    away = np.hypot(*(poses[at, :, :2] - sights.places[rows, None]).transpose(2, 0, 1)).min(axis=1)
    near = (away < FREE) & (sights.times[rows] > stretch.times[0])
    ends = [*(np.flatnonzero(near[1:] & ~near[:-1]) + 1).tolist(), len(rows)]
    flights: list[ChipFlight] = []
    for end in reversed(ends):
        kept = rows[:end][~near[:end]]
        if len(kept) < _LEAST_DETECTIONS:
            break
        if flights and len(kept) == len(flights[-1].times):
            continue
        seen_on_way = sights.times[kept], sights.places[kept], sights.eyes[kept], sights.nearness[kept]
        flights.append(ChipFlight(*seen_on_way, launched, np.zeros(LAUNCH_NUMBERS), USUAL_HOPS, slowing))
    return flights


def _launched(seen: Observations, sights: _Sights, stretch: Stretch) -> Launched | None:
    """Return when and where a ball was launched that was free from a stretch's start on; None if unclear.

    It may have flown past robots before that, in a straight line. Where cameras see a flying ball farther
    away, that line is none, but the flight itself tells when it began.
    """
    if np.any(sights.nearness):
        time = float(stretch.times[0])
        mouth = _mouth(seen, stretch.before, time)
        return None if mouth is None else Launched(time, time - _LAUNCHED_BEFORE, *mouth, _MOUTH_PLACE)
    first = int(np.searchsorted(sights.times, float(stretch.times[0]) - 1e-9))
    near = slice(first, first + _AT_FIRST)
    if len(sights.times[near]) < _AT_FIRST:
        return None
    velocity, start = np.polyfit(sights.times[near] - sights.times[first], sights.places[near], 1)
    while first > 0 and stretch.times[0] - sights.times[first - 1] < _LAUNCHED_BEFORE:
        since = sights.times[first - 1] - stretch.times[0]
        if hypot(*(sights.places[first - 1] - start - since * velocity)) > _ASTRAY:
            break
        first -= 1
    time = float(sights.times[first])
    rows = np.arange(max(first - _AT_FIRST, 0), first)
    rows = rows[sights.times[rows] > time - _POSE_TIME]
    if len(rows) >= _LEAST_BEFORE:
        drove, place = np.polyfit(sights.times[rows] - time, sights.places[rows], 1)
        return Launched(time, float(sights.times[rows[-1]]), place, drove, _BALL_PLACE)
    mouth = _mouth(seen, stretch.before, time)
    return None if mouth is None else Launched(time, time - _POSE_TIME, *mouth, _BALL_PLACE)


def _mouth(seen: Observations, robot: int, time: float) -> tuple[FloatArray, FloatArray] | None:
    """Return place and velocity of a robot's mouth, (2,) each; None if it was hardly seen."""
    rows = np.flatnonzero(np.abs(seen.times - time) < _POSE_TIME)
    rows = rows[np.isfinite(seen.poses[rows, robot, 0])]
    if len(rows) < 4:
        return None
    heading = np.unwrap(seen.poses[rows, robot, 2])
    ahead = np.column_stack([np.cos(heading), np.sin(heading)])
    drove, place = np.polyfit(
        seen.times[rows] - time, seen.poses[rows, robot, :2] + MOUTH_DISTANCE * ahead, 1
    )
    return place, drove


def _fits(flight: ChipFlight, ball: BallModel, noise: float) -> bool:
    """Find the launch that fits best, and return whether a chip explains what was seen, and no flat kick."""
    count = len(flight.times)
    since = flight.times - flight.launched.first + 1e-3
    flat = flat_misfit(since, flight.places, BallSettings(**ball.model_dump()))
    most = 2 * count * (_WORST_CHIP * (1.0 + 2.0 / sqrt(count)) * noise) ** 2
    if flat < most or not start_flight(flight):
        return False
    fit = fit_flights([flight], [flight.hops, USUAL_HOPS], noise)
    (flight.launch,), flight.hops = fit.launches, fit.hops
    left = float(np.sum(flight.misses(flight.launch, flight.hops) ** 2))
    return CHIP_LEAST < flight.elevation < CHIP_MOST and left < min(most, _BETTER_THAN_FLAT * flat)
