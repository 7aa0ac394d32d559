"""One ball for many ways: a robust joint fit, each way with its own place and speeds."""

from __future__ import annotations

from math import inf, log1p

import numpy as np

from robobt.identify.ball_ways import Way, residuals_of
from robobt.world.geometry import FloatArray

_MOST_BALL_STEPS = 40

_LEAST_BALL, _MOST_BALL = np.array([0.3, 0.03, 0.3]), np.array([20.0, 3.0, 0.95])
"""Bounds of slide and roll deceleration [m/s^2] and of the switch share."""

_STARTS = ((3.0, 0.3, 0.66), (2.0, 0.2, 0.66), (5.0, 0.5, 0.66), (10.0, 0.7, 0.7))
"""Balls that the fit starts from: slide, roll, switch share."""

_LARGE_MISFIT = 4.0
"""Mean squared residual, over that of noise, from which a way counts less than half."""

_HUBER = 2.5
"""Residuals beyond this many standard deviations count less."""


def derivatives(it: Way, ball: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return (n, 3) derivatives of a way's residuals by the ball, and (n, 2 or 3) by its own numbers.

    Args:
        it: the way.
        ball: slide deceleration, roll deceleration [m/s^2] and switch share.
    """
    steps_ball, steps_local = 1e-5 * np.maximum(ball, 0.1), np.array([1e-5, 1e-5, 1e-5])
    by_ball = np.zeros((len(it.times), 3))
    for i in range(3):
        up, down = ball.copy(), ball.copy()
        up[i] += steps_ball[i]
        down[i] -= steps_ball[i]
        change = residuals_of(it, up, it.local) - residuals_of(it, down, it.local)
        by_ball[:, i] = change / (2.0 * steps_ball[i])
    own = 2 if it.kicked else 3
    by_local = np.zeros((len(it.times), own))
    for i in range(own):
        up, down = it.local.copy(), it.local.copy()
        up[i] += steps_local[i]
        down[i] -= steps_local[i]
        change = residuals_of(it, ball, up) - residuals_of(it, ball, down)
        by_local[:, i] = change / (2.0 * steps_local[i])
    return by_ball, by_local


def misfit(residuals: FloatArray, noise: float) -> float:
    """Return the mean of a way's squared residuals over the noise's, in which outliers count less.

    Args:
        residuals: of the way [m].
        noise: standard deviation of a detection [m].
    """
    size = np.abs(residuals) / noise
    return float(np.mean(np.where(size < _HUBER, size**2, _HUBER * (2.0 * size - _HUBER))))


def _cost(ways: list[Way], ball: FloatArray, noise: float, locals_: list[FloatArray]) -> float:
    """Return Cauchy's cost, with a stretch as the unit: a stretch that does not fit counts little."""
    total = 0.0
    for it, local in zip(ways, locals_, strict=True):
        size = misfit(residuals_of(it, ball, local), noise)
        total += 0.5 * len(it.times) * _LARGE_MISFIT * log1p(size / _LARGE_MISFIT)
    return total


def fit(ways: list[Way], ball: FloatArray, noise: float, own_only: bool = False) -> FloatArray:
    """Fit the ball and every way's own numbers by Levenberg and Marquardt's method; return the ball.

    Args:
        ways: whose ``local`` and ``weights`` are changed.
        ball: slide deceleration, roll deceleration [m/s^2] and switch share to start from.
        noise: standard deviation of a detection [m].
        own_only: whether the ball stays as it is.
    """
    damping = 1e-3
    cost = _cost(ways, ball, noise, [it.local for it in ways])
    for _ in range(_MOST_BALL_STEPS):
        systems = []
        for it in ways:
            residuals = residuals_of(it, ball, it.local)
            it.weights = 1.0 / np.maximum(1.0, np.abs(residuals) / (_HUBER * noise))
            it.weights /= 1.0 + misfit(residuals, noise) / _LARGE_MISFIT
            by_ball, by_local = derivatives(it, ball)
            root = np.sqrt(it.weights)[:, None]
            systems.append((by_ball * root, by_local * root, residuals * root[:, 0]))
        while damping < 1e6:
            step, steps = _step(systems, damping, own_only)
            new = np.clip(ball + step, _LEAST_BALL, _MOST_BALL)
            locals_ = [_moved(it, own) for it, own in zip(ways, steps, strict=True)]
            better = _cost(ways, new, noise, locals_)
            if better <= cost:
                break
            damping *= 5.0
        else:
            break
        gained, cost = cost - better, better
        ball, damping = new, max(damping / 5.0, 1e-9)
        for it, local in zip(ways, locals_, strict=True):
            it.local = local
        if gained < 1e-6 * cost + 1e-9:
            break
    return ball


def first_fit(ways: list[Way], noise: float) -> FloatArray:
    """Fit all ways from each of several balls, as each way alone has several explanations; return the ball.

    Args:
        ways: whose ``local`` and ``weights`` are changed.
        noise: standard deviation of a detection [m].
    """
    best, least = np.array(_STARTS[0]), inf
    kept = [it.local for it in ways]
    starts = [it.local.copy() for it in ways]
    for start in _STARTS:
        for it, local in zip(ways, starts, strict=True):
            it.local = local.copy()
        ball = fit(ways, np.array(start), noise)
        cost = _cost(ways, ball, noise, [it.local for it in ways])
        if cost < least:
            best, least, kept = ball, cost, [it.local for it in ways]
    for it, local in zip(ways, kept, strict=True):
        it.local = local
    return best


def _step(
    systems: list[tuple[FloatArray, FloatArray, FloatArray]], damping: float, own_only: bool
) -> tuple[FloatArray, list[FloatArray]]:
    """Return the step of the ball's numbers and of every stretch's own."""
    normal, gradient = np.zeros((3, 3)), np.zeros(3)
    kept: list[FloatArray] = []
    for by_ball, by_local, residuals in systems:
        inner = by_local.T @ by_local
        inner += np.diag(damping * np.diag(inner) + 1e-9)
        keep = _solved(inner, by_local.T @ np.column_stack([by_ball, residuals]))
        normal += by_ball.T @ (by_ball - by_local @ keep[:, :3])
        gradient += by_ball.T @ (residuals - by_local @ keep[:, 3])
        kept.append(keep)
    normal += np.diag(damping * np.diag(normal) + 1e-9)
    step = np.zeros(3) if own_only else -_solved(normal, gradient)
    return step, [-(keep[:, 3] + keep[:, :3] @ step) for keep in kept]


def _moved(it: Way, step: FloatArray) -> FloatArray:
    local = it.local.copy()
    local[: len(step)] += step
    local[1] = max(local[1], 0.01)
    local[2] = min(max(local[2], 0.0), local[1])
    return local


def _solved(matrix: FloatArray, values: FloatArray) -> FloatArray:
    return np.asarray(np.linalg.solve(matrix, values), dtype=np.float64)
