"""How well a ball model foretells where a free ball will be."""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt

import numpy as np

from robobt.identify.ball import explain
from robobt.identify.ball_ways import Way, rolling_speed, way_gone, ways_of
from robobt.identify.free_ball import stretches
from robobt.identify.observations import Observations
from robobt.world.ball_model import BallModel
from robobt.world.geometry import FloatArray

_HISTORY, _LEAST_HISTORY = 0.3, 0.15
"""Most and least time before a prediction from which the ball's speed is taken [s]."""

_PREDICTED_EVERY = 0.25
"""Time from one prediction on a way to the next [s]."""

_STATE_STEPS = 8

_PICTURE = 0.03
"""Longest time from the moment foretold to a sight of the ball [s]."""


def misses_ahead(seen: Observations, model: BallModel, seconds: float = 1.0) -> FloatArray:
    """Return by how much a model misses the ball some time ahead, along its way, wherever it stays free.

    Balls that a robot's side or a wall deflected count once they roll: while they slide, nobody can see their
    spin.

    A prediction knows what was seen up to then, since the ball was free. It takes a ball to roll, or to slide
    as after a kick, whichever explains the last 0.3 s better.

    Args:
        seen: what cameras saw; not what the model was identified from.
        model: of the ball.
        seconds: how far ahead [s].

    Returns:
        (n,) predicted less seen [m].
    """
    ball = np.array([model.slide_deceleration, model.roll_deceleration, model.switch_share])
    misses = []
    ways = ways_of(seen, stretches(seen))
    if not ways:
        return np.zeros(0)
    # Which ways were free, and when their balls rolled, is found from themselves, not from the model.
    own, _ = explain(ways)
    for way in ways:
        if not way.good:
            continue
        rolls = (way.local[1] - min(rolling_speed(way, own, way.local), way.local[1])) / own[0]
        for now in np.arange(_LEAST_HISTORY, way.times[-1] - seconds, _PREDICTED_EVERY):
            then = int(np.argmin(np.abs(way.times - now - seconds)))
            understood = way.kicked or now > rolls + _HISTORY / 2.0
            if understood and abs(way.times[then] - now - seconds) < _PICTURE:
                misses.append(_predicted(way, now, ball, way.times[then]) - way.ways[then])
    return np.array(misses)


def _predicted(way: Way, now: float, ball: FloatArray, then: float) -> float:
    """Return where the ball is at a time, from what was known before [m].

    It rolls, or it slides since its stretch began, whichever explains what was seen last.
    """
    explanations = []
    for kicked in (False, True):
        known = way.times <= now
        if not kicked:
            known &= way.times >= now - _HISTORY
        times, ways = way.times[known], way.ways[known]
        gone = _gone(way, ball, kicked, float(times[0]))
        numbers = _fitted(gone, times, ways)
        latest = times >= now - _HISTORY
        spread = float(np.mean((ways - gone(times, numbers))[latest] ** 2))
        explanations.append((spread, float(gone(np.array([then]), numbers)[0])))
    return min(explanations)[1]


_Gone = Callable[[FloatArray, FloatArray], FloatArray]


def _gone(way: Way, ball: FloatArray, kicked: bool, first: float) -> _Gone:
    """Return the function of time and (start, speed) that says where a ball is."""

    def gone(at: FloatArray, numbers: FloatArray) -> FloatArray:
        start, speed = float(numbers[0]), float(numbers[1])
        rolling = ball[2] * sqrt(speed**2 + 2.0 * ball[0] * way.back) if kicked else speed
        return way_gone(ball, at - first, start, speed, rolling)

    return gone


def _fitted(gone: _Gone, times: FloatArray, ways: FloatArray) -> FloatArray:
    """Return start and speed at the first of the times, by Gauss-Newton steps."""
    speed, start = np.polyfit(times - times[0], ways, 1)
    numbers = np.array([start, max(speed, 0.01)])
    for _ in range(_STATE_STEPS):
        now = gone(times, numbers)
        by_speed = (gone(times, numbers + np.array([0.0, 1e-4])) - now) / 1e-4
        step = np.linalg.lstsq(np.column_stack([np.ones(len(times)), by_speed]), ways - now, rcond=None)[0]
        numbers = np.array([numbers[0] + step[0], max(numbers[1] + step[1], 0.01)])
    return numbers
