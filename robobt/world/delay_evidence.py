"""How likely each delay of a robot is: predictions under it, compared with what is seen.

As in a multiple-model Kalman filter: one uncertainty holds for all predictions, each of which is corrected
with every detection. How well it foresaw that counts as evidence for its delay.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import exp, log, log1p, pi, sqrt
from typing import Any

from robobt.world.compiled import compiled_lean
from robobt.world.delay_hypotheses import (
    HEADING_NOISE,
    HYPOTHESIS,
    NOISE,
    SEEN_ROBOT,
    Hypothesis,
    Uncertainty,
)
from robobt.world.geometry import FloatArray

_ACCELERATION_NOISE, _TURN_ACCELERATION_NOISE = 1.7, 10.0
"""Accelerations that no command explains [m/s^2, rad/s^2]."""

_TAIL = 3.0
"""Degrees of freedom of the detections' errors: collisions and lost commands make large ones likely."""

_FIT_WEIGHT = 0.07
"""Weight of the newest detection in the running misfits: they look back by a quarter of a second at 60 Hz."""

_UNFIT = 2.0
"""Misfit of the best hypothesis, in variances, at which no motion model holds, as in a duel for the ball."""

_JUMPS = 0.01
"""Share of the belief that a delay is another one a second later: a link that was changed [1/s]."""

_DRIFT = 0.0003
"""Standard deviation of a delay's drift in a second [s]."""

_PEAK = 0.02
"""The delay is the mean of the belief this far about its peak [s]."""


@compiled_lean
def judge(hypotheses_: FloatArray, sight_: FloatArray, dt: float) -> tuple[float, float, float]:
    """Correct each hypothesis with a detection, add to its evidence, and read the delay from the belief.

    Nothing is learned where no hypothesis has fitted for a while.

    Args:
        hypotheses_: (n, ...) of :class:`Hypothesis`; changed.
        sight_: a :class:`SeenRobot`; its uncertainty is changed.
        dt: since the last detection [s].

    Returns:
        the mean of the belief about its peak and its standard deviation there [s], and what share of the
        belief lies there.
    """
    rows: Any = hypotheses_.view(HYPOTHESIS)
    hypotheses, sight = rows[:, 0], sight_.view(SEEN_ROBOT)[0]
    _grow(sight.place, _ACCELERATION_NOISE, dt)
    _grow(sight.turn, _TURN_ACCELERATION_NOISE, dt)
    variance = sight.place.pp + NOISE * NOISE
    turn_variance = sight.turn.pp + HEADING_NOISE * HEADING_NOISE
    best = best_turn = 1e9
    for i in range(len(hypotheses)):
        it = hypotheses[i]
        dx, dy = sight.x - it.robot.x, sight.y - it.robot.y
        turn = _wrapped(sight.heading - it.robot.heading)
        it.misfit += _FIT_WEIGHT * (0.5 * (dx * dx + dy * dy) / variance - it.misfit)
        it.turn_misfit += _FIT_WEIGHT * (turn * turn / turn_variance - it.turn_misfit)
        best, best_turn = min(best, it.misfit), min(best_turn, it.turn_misfit)
    worth, turn_worth = _worth(best), _worth(best_turn)
    gain, speed_gain = sight.place.pp / variance, sight.place.pv / variance
    turn_gain, turn_speed_gain = sight.turn.pp / turn_variance, sight.turn.pv / turn_variance
    for i in range(len(hypotheses)):
        it = hypotheses[i]
        robot = it.robot
        dx, dy = sight.x - robot.x, sight.y - robot.y
        turn = _wrapped(sight.heading - robot.heading)
        # Student's t of two dimensions, and of one.
        square = (dx * dx + dy * dy) / variance
        it.evidence -= worth * 0.5 * (_TAIL + 2.0) * log1p(square / _TAIL)
        square = turn * turn / turn_variance
        it.evidence -= turn_worth * 0.5 * (_TAIL + 1.0) * log1p(square / _TAIL)
        robot.x += gain * dx
        robot.y += gain * dy
        robot.vx += speed_gain * dx
        robot.vy += speed_gain * dy
        robot.heading += turn_gain * turn
        robot.omega += turn_speed_gain * turn
    _shrink(sight.place, gain, speed_gain)
    _shrink(sight.turn, turn_gain, turn_speed_gain)
    _believe(hypotheses, dt)
    return _read(hypotheses)


@compiled_lean
def _believe(hypotheses: Sequence[Hypothesis], dt: float) -> None:
    """Turn evidence into belief, and let that spread as delays change in time."""
    count = len(hypotheses)
    most = hypotheses[0].evidence
    for i in range(count):
        most = max(most, hypotheses[i].evidence)
    total = 0.0
    for i in range(count):
        it = hypotheses[i]
        it.belief = exp(it.evidence - most)
        total += it.belief
    step = hypotheses[1].delay - hypotheses[0].delay
    spread, jumps = 0.5 * (_DRIFT / step) ** 2 * dt, _JUMPS * dt
    before = hypotheses[0].belief / total
    for i in range(count):
        it = hypotheses[i]
        own = it.belief / total
        after = hypotheses[i + 1].belief / total if i + 1 < count else own
        new = own + spread * (before + after - 2.0 * own)
        new += jumps * (1.0 / count - new)
        before = own
        it.belief = new
        it.evidence = log(new)


@compiled_lean
def _read(hypotheses: Sequence[Hypothesis]) -> tuple[float, float, float]:
    """Read the delay from the belief about its peak."""
    count, peak = len(hypotheses), 0
    for i in range(count):
        if hypotheses[i].belief > hypotheses[peak].belief:
            peak = i
    centre = hypotheses[peak].delay
    share = first = second = 0.0
    for i in range(count):
        it = hypotheses[i]
        off = it.delay - centre
        if abs(off) < _PEAK:
            share += it.belief
            first += it.belief * off
            second += it.belief * off * off
    mean = first / share
    return centre + mean, sqrt(max(0.0, second / share - mean * mean)), share


@compiled_lean
def _grow(spread: Uncertainty, noise: float, dt: float) -> None:
    """Let an uncertainty grow for ``dt`` [s] under an acceleration noise."""
    q = noise * noise
    spread.pp += dt * (2.0 * spread.pv + dt * (spread.vv + 0.25 * q * dt * dt))
    spread.pv += dt * (spread.vv + 0.5 * q * dt * dt)
    spread.vv += q * dt * dt


@compiled_lean
def _shrink(spread: Uncertainty, gain: float, speed_gain: float) -> None:
    """Let an uncertainty shrink after a correction with these gains."""
    spread.vv -= speed_gain * spread.pv
    spread.pv *= 1.0 - gain
    spread.pp *= 1.0 - gain


@compiled_lean
def _worth(misfit: float) -> float:
    """Return what a detection is worth while the best hypothesis has this misfit, from 0 to 1."""
    ratio = (misfit / _UNFIT) ** 2
    return 1.0 / (1.0 + ratio * ratio)


@compiled_lean
def _wrapped(angle: float) -> float:
    return (angle + pi) % (2.0 * pi) - pi
