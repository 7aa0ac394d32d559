"""How well a flat kick explains where the ball was seen."""

from __future__ import annotations

import numpy as np

from robobt.sim.settings import BallSettings
from robobt.world.ball_model import way_in
from robobt.world.geometry import FloatArray

_SPEED_REFINEMENTS = 4
"""Improvements of the speed, each by the slope of the misfit."""


def flat_misfit(times: FloatArray, places: FloatArray, ball: BallSettings) -> float:
    """Return the least squared distance of detections from any flat kick [m^2].

    That is a straight line on which the ball slides, then rolls as the settings say, or has one
    deceleration, whatever the carpet's.

    Args:
        times: (n,) of the detections, from the last one before the kick on [s].
        places: (n, 2) of the detections [m].
        ball: how it is expected to slide and roll.
    """
    middle = places.mean(axis=0)
    _, _, (ahead, left) = np.linalg.svd(places - middle, full_matrices=False)
    along, aside = (places - middle) @ ahead, (places - middle) @ left
    if along[-1] < along[0]:
        along = -along
    gap, *_ = times.tolist()
    t = times - gap
    off = min(_braking(along, t, ball), _sliding(along, t, gap, ball))
    return float(aside @ aside) + off


def _braking(along: FloatArray, t: FloatArray, ball: BallSettings) -> float:
    """Return the squared misfit of a ball with one deceleration, at most that of sliding."""
    lag = -0.5 * t * t
    rows = np.column_stack((np.ones_like(t), t, lag))
    found, *_ = np.linalg.lstsq(rows, along, rcond=None)
    *_, braking = found.tolist()
    brake = min(max(braking, 0.0), ball.slide_deceleration)
    if brake != braking:
        along = along - brake * lag
        rows = rows[:, :2]
        found, *_ = np.linalg.lstsq(rows, along, rcond=None)
    off = rows @ found - along
    return float(off @ off)


def _sliding(along: FloatArray, t: FloatArray, gap: float, ball: BallSettings) -> float:
    """Return that of a ball that was kicked within ``gap`` before the first detection [s]."""

    def off(speed: float) -> FloatArray:
        rolls = ball.switch_share * (speed + 0.5 * gap * ball.slide_deceleration)
        slide, roll = ball.slide_deceleration, ball.roll_deceleration
        apart: FloatArray = np.array([way_in(time, speed, rolls, slide, roll) for time in t.tolist()]) - along
        return apart - float(apart.mean())

    speed = max(float((along[-1] - along[0]) / (t[-1] - t[0])), 0.1)
    for _ in range(_SPEED_REFINEMENTS):
        now = off(speed)
        slope = (off(speed + 1e-3) - now) / 1e-3
        speed = max(speed - float(slope @ now) / max(float(slope @ slope), 1e-12), 0.1)
    now = off(speed)
    return float(now @ now)
