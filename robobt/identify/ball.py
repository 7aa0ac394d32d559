"""How the ball slides and rolls: two decelerations, and the share of a kick's speed at which it rolls.

All stretches of free ball are fitted at once, each with its own place and speed and all with one ball. A
stretch that began with a kick began without spin, so it rolls from ``switch_share`` of the kick's speed on;
any other stretch may roll from any speed on. The errors are the sandwich's, with a stretch as the unit, so
that what the model leaves out of a stretch widens the interval.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt
from typing import NamedTuple

import numpy as np

from robobt.identify.ball_fit import derivatives, first_fit, fit, misfit
from robobt.identify.ball_ways import SLOWEST_WAY, Way, residuals_of, rolling_speed, speed_after, ways_of
from robobt.identify.estimate import Estimate, from_error, quantile, unseen
from robobt.identify.free_ball import Stretch
from robobt.identify.observations import Observations
from robobt.world.ball_model import DEFAULT_BALL, BallModel
from robobt.world.geometry import FloatArray

_WORST = 1.5
"""A way whose residuals are this many times the noise was touched, or flew."""

_SIFTINGS = 3

_WORSE = 9.0
"""Rise of the summed squared residuals, over the noise, with which a way does not count as kicked."""

_SURE, _ROLLED, _SAME_SHARE = 0.03, 0.05, 0.06
"""A kick counts for the switch share if that is known this well from it, after rolling for this time [s], and
is this near to that of the others."""

_AT_ONCE = 0.02
"""A ball that was at the robot for longer than this was not kicked on the first touch [s]."""

_LEAST_SLIDES, _LEAST_ROLLS = 2, 2
"""Number of kicks and of ways below which the ball's figures are not seen enough."""

_MOST_BALL_ERROR = 0.1
"""Relative half width of an interval beyond which a figure is not seen enough."""


class BallEstimate(NamedTuple):
    """The ball on the ground, and what is left over.

    Attributes:
        slide_deceleration: while it slides [m/s^2].
        roll_deceleration: while it rolls [m/s^2].
        switch_share: share of a kick's speed at which it begins to roll.
        noise: standard deviation of a detected position, per axis [m].
        kicks: the stretches that began with a kick, with their speeds.
    """

    slide_deceleration: Estimate
    roll_deceleration: Estimate
    switch_share: Estimate
    noise: Estimate
    kicks: list[SeenKick]


@dataclass(slots=True)
class SeenKick:
    """A kick as cameras saw it.

    Attributes:
        robot: place of the robot in the arrays.
        time: when the ball left [s].
        speed: of the ball as it left [m/s].
        direction: of the ball [rad].
        came: (2,) velocity of a ball that was kicked on the first touch, just before [m/s]; None for a ball
            that the robot had.
    """

    robot: int
    time: float
    speed: float
    direction: float
    came: FloatArray | None


def identify_ball(seen: Observations, free: list[Stretch]) -> BallEstimate:
    """Identify how the ball slides and rolls.

    Args:
        seen: what cameras saw.
        free: its stretches of free ball.

    Returns:
        the ball's figures, each with its interval.
    """
    ways = ways_of(seen, free)
    if not ways:
        return BallEstimate(unseen(0, "m/s²"), unseen(0, "m/s²"), unseen(), unseen(0, "m"), [])
    ball, noise = explain(ways)
    good = [it for it in ways if it.good]
    errors = _errors(good, ball, noise)
    kicked = [it for it in good if it.kicked]
    slides = sum(_slides(it, ball) for it in good)
    rolls = sum(_rolls(it, ball) for it in good)
    names = [
        (0, slides, slides >= _LEAST_SLIDES, "m/s²"),
        (1, rolls, rolls >= _LEAST_ROLLS, "m/s²"),
        (2, len(kicked), len(kicked) >= _LEAST_SLIDES, ""),
    ]
    figures = [
        from_error(
            float(ball[i]),
            errors[i],
            count,
            enough and quantile(count - 1) * errors[i] < _MOST_BALL_ERROR * ball[i],
            unit,
            freedom=max(count - 1, 1),
        )
        for i, count, enough, unit in names
    ]
    count = sum(len(it.times) for it in good)
    noise = sqrt(sum(it.sideways**2 * len(it.times) for it in good) / max(count - 2 * len(good), 1))
    spread = from_error(noise, noise / sqrt(2.0 * max(count, 1)), count, count >= 50, "m")
    return BallEstimate(figures[0], figures[1], figures[2], spread, _kicks(ways, ball))


def explain(ways: list[Way]) -> tuple[FloatArray, float]:
    """Fit one ball to ways, and tell those that it explains from those that were touched or flew.

    Args:
        ways: at least one; their own numbers, ``kicked`` and ``good`` are changed.

    Returns:
        slide deceleration, roll deceleration [m/s^2] and switch share; and the noise across the ways [m].
    """
    # Across its line a ball only shows noise.
    noise = max(float(np.median([it.sideways for it in ways])), 1e-5)
    ball = first_fit(ways, noise)
    for _ in range(_SIFTINGS):
        _sift(ways, ball, noise)
        good = [it for it in ways if it.good]
        if good:
            ball = fit(good, ball, noise)
    good = [it for it in ways if it.good]
    ball[2] = _tie(good, ball, noise)
    if good:
        ball = fit(good, ball, noise)
        _sift(ways, ball, noise)
    return ball, noise


def _sift(ways: list[Way], ball: FloatArray, noise: float) -> None:
    """Leave out the stretches that no free ball on the ground explains."""
    for it in ways:
        most = _WORST * (1.0 + 2.0 / sqrt(len(it.times))) * noise
        spread = sqrt(float(np.mean(residuals_of(it, ball, it.local) ** 2)))
        it.good = max(spread, it.sideways) < most and it.local[1] > SLOWEST_WAY


def _tie(ways: list[Way], ball: FloatArray, noise: float) -> float:
    """Let the stretches that began with a kick share one switch share, and return it.

    Stretches of which that is not true, because the ball had spin, are from now on as if not kicked.
    """
    shares = {}
    for i, it in enumerate(ways):
        if not it.looks_kicked or not _slides(it, ball):
            continue
        by_local = derivatives(it, ball)[1]
        error = noise * sqrt(float(np.linalg.pinv(by_local.T @ by_local)[2, 2]))
        began = sqrt(it.local[1] ** 2 + 2.0 * ball[0] * it.back)
        if error < _SURE * began and it.times[-1] > (it.local[1] - it.local[2]) / ball[0] + _ROLLED:
            shares[i] = it.local[2] / began
    if not shares:
        return float(ball[2])
    middle = float(np.median(list(shares.values())))
    for i, it in enumerate(ways):
        if i in shares:
            it.kicked = abs(shares[i] - middle) < _SAME_SHARE
        elif it.looks_kicked:
            _try_tied(it, np.array([ball[0], ball[1], middle]), noise)
    return middle


def _try_tied(it: Way, ball: FloatArray, noise: float) -> None:
    """Let a stretch count as kicked unless that makes it fit clearly worse."""
    before = len(it.times) * misfit(residuals_of(it, ball, it.local), noise)
    kept, it.kicked = it.local, True
    fit([it], ball, noise, own_only=True)
    after = len(it.times) * misfit(residuals_of(it, ball, it.local), noise)
    if after > before + _WORSE:
        it.local, it.kicked = kept, False


def _errors(ways: list[Way], ball: FloatArray, noise: float) -> FloatArray:
    """Return the standard errors of the ball's figures."""
    bread, meat = np.zeros((3, 3)), np.zeros((3, 3))
    for it in ways:
        by_ball, by_local = derivatives(it, ball)
        residuals = residuals_of(it, ball, it.local)
        weights = it.weights[:, None]
        inner = by_local.T @ (weights * by_local) + 1e-9 * np.eye(by_local.shape[1])
        free = by_ball - by_local @ np.linalg.solve(inner, by_local.T @ (weights * by_ball))
        bread += free.T @ (weights * free)
        score = free.T @ (it.weights * residuals)
        meat += np.outer(score, score)
    inverse = np.linalg.pinv(bread)
    count = len(ways)
    sandwich = inverse @ meat @ inverse * (count / max(count - 3, 1))
    plain = noise**2 * inverse
    return np.sqrt(np.maximum(np.diag(sandwich), np.diag(plain)))


def _slides(it: Way, ball: FloatArray) -> bool:
    """Return whether a stretch shows 0.1 s of sliding."""
    return bool(it.local[1] - min(rolling_speed(it, ball, it.local), it.local[1]) > 0.1 * ball[0])


def _rolls(it: Way, ball: FloatArray) -> bool:
    """Return whether a stretch shows 0.3 s of rolling."""
    rolling = min(rolling_speed(it, ball, it.local), it.local[1])
    return bool(it.times[-1] - (it.local[1] - rolling) / ball[0] > 0.3)


def _kicks(ways: list[Way], ball: FloatArray) -> list[SeenKick]:
    """Return the kicks whose way is understood, each with the ball's velocity before it."""
    kicks = []
    for i, it in enumerate(ways):
        if not (it.looks_kicked and it.good):
            continue
        began = sqrt(it.local[1] ** 2 + 2.0 * ball[0] * it.back)
        time = float(it.stretch.times[0]) - it.back / began
        came, arrived = None, it.arrived
        before = ways[i - 1] if i else None
        if arrived is not None and before is not None and before.good and abs(time - arrived) < _AT_ONCE:
            speed = speed_after(before, ball, arrived - float(before.stretch.times[-1]))
            came = speed * np.array([np.cos(before.direction), np.sin(before.direction)])
        kicks.append(SeenKick(it.stretch.before, time, began, it.direction, came))
    return kicks


def model_of(estimate: BallEstimate, otherwise: BallModel = DEFAULT_BALL) -> BallModel:
    """Return the ball that was identified, with figures of another where not enough was seen."""
    changes = {
        name: getattr(estimate, name).value
        for name in ("slide_deceleration", "roll_deceleration", "switch_share")
        if getattr(estimate, name).seen
    }
    return otherwise.model_copy(update=changes)
