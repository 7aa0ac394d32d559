"""Fit a population of goalkeepers to recorded shots by their likelihood."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.stats import norm, qmc

from paper.goalkeeper_race import GOAL_LINE, goal_chances
from paper.validation import Fold
from robobt.shots import Population
from robobt.world import FloatArray

DRAWS = 32
"""Goalkeepers that each shot meets."""

_DIMENSIONS = 6
"""Random numbers that one goalkeeper's traits take."""

START = Population(
    max_speed=1.125,
    acceleration=2.5,
    braking=0.8,
    delay=0.06,
    spread=0.2,
    offset=0.02,
    kick_speed=7.5,
    kick_error=0.01,
    kick_follows=0.1,
)
"""Where a fit starts: the paper's half-speed goalkeeper with RoboBulls' pilot."""

_POSITIVE = ("max_speed", "acceleration", "braking", "delay", "spread", "offset", "kick_speed", "kick_error")
_DOUBT = np.array([0.7, 0.7, 0.7, 0.7, 0.7, 0.7, 0.1, 0.7, 0.3])
"""Standard deviations of the prior about the start: of logarithms, and of ``kick_follows`` itself.

It decides only what the shots say nothing about.
"""

_STEP, _LONGEST, _FARTHEST = 0.05, 1.0, 3.0
_MOST_STEPS, _HALVINGS, _ENOUGH = 20, 5, 0.05
"""Of the search: in standard deviations of the prior, and the gain in log-likelihood that ends it."""

_LOW = 0.1587
"""Share of a normal distribution that lies more than one standard deviation below its mean."""

_LEAST = 0.002
"""No outcome is taken for less likely: a label may be wrong."""


def chances(population: Population, shots: FloatArray, draws: int = DRAWS) -> FloatArray:
    """Return the probability of a goal (n,) of shots (n, 8) against a population.

    ``shots`` are :func:`~paper.goalkeeper_race.race_inputs`, ``draws`` is a power of 2; the same
    goalkeepers are drawn each time.
    """
    normal = norm.ppf(qmc.Sobol(_DIMENSIONS, seed=1).random(draws))
    return goal_chances(shots, population.traits(normal), population.offset, population.kick_follows)


def fit_population(shots: FloatArray, goals: NDArray[np.int64]) -> Population:
    """Return the most likely population behind shots (n, 8) and which of them scored (n,).

    Fisher's scoring on the likelihood times the prior, with slopes from small steps: the race
    has no formula, but with the same goalkeepers drawn each time its chances are smooth.
    """
    start = _vector(START)

    def predicted(place: FloatArray) -> FloatArray:
        return np.clip(chances(_population(start + _DOUBT * place), shots), _LEAST, 1.0 - _LEAST)

    def cost(place: FloatArray, p: FloatArray) -> float:
        return float(0.5 * place @ place - np.where(goals == 1, np.log(p), np.log1p(-p)).sum())

    place = np.zeros(len(start))
    p = predicted(place)
    least = cost(place, p)
    for _ in range(_MOST_STEPS):
        slopes = np.stack(
            [(predicted(place + step) - p) / _STEP for step in _STEP * np.eye(len(place))], axis=1
        )
        weights = 1.0 / (p * (1.0 - p))
        uphill = slopes.T @ (weights * (goals - p)) - place
        step = np.linalg.solve(slopes.T @ (weights[:, None] * slopes) + np.eye(len(place)), uphill)
        step *= min(1.0, _LONGEST / float(np.abs(step).max()))
        for _ in range(_HALVINGS):
            tried = np.clip(place + step, -_FARTHEST, _FARTHEST)
            p_tried = predicted(tried)
            found = cost(tried, p_tried)
            if found < least:
                break
            step *= 0.5
        else:
            break
        gained, least, place, p = least - found, found, tried, p_tried
        if gained < _ENOUGH:
            break
    *_, bearing = shots.T
    side = bearing * np.sign(_across(shots))
    # Quantiles: a ball far aside is one that the robot had lost.
    low, middle, high = (float(np.quantile(side, share)) for share in (_LOW, 0.5, 1.0 - _LOW))
    found_bearing = {"bearing": middle, "bearing_spread": 0.5 * (high - low)}
    return _population(start + _DOUBT * place).model_copy(update=found_bearing)


def validate_population(
    shots: FloatArray,
    goals: NDArray[np.int64],
    folds: Sequence[Fold],
    on_fold: Callable[[], object] = lambda: None,
) -> FloatArray:
    """Return every shot's probability of a goal (n,) by a population fitted without its fold."""
    predicted = np.empty(len(goals))
    for train, test in folds:
        predicted[test] = chances(fit_population(shots[train], goals[train]), shots[test])
        on_fold()
    return predicted


def _across(shots: FloatArray) -> FloatArray:
    """Return how far goalkeepers stand beside the line ball -> target, to its left [m]."""
    x, y, target_y, keeper_x, keeper_y, *_ = shots.T
    dx, dy = GOAL_LINE - x, target_y - y
    across: FloatArray = (dx * (keeper_y - y) - dy * (keeper_x - x)) / np.hypot(dx, dy)
    return across


def _vector(population: Population) -> FloatArray:
    positive = np.log([getattr(population, name) for name in _POSITIVE])
    return np.append(positive, population.kick_follows)


def _population(vector: FloatArray) -> Population:
    values = dict(zip(_POSITIVE, np.exp(vector[:-1]).tolist(), strict=True))
    values["spread"], values["offset"] = min(values["spread"], 1.0), min(values["offset"], 0.2)
    values["delay"], values["kick_error"] = min(values["delay"], 0.5), min(values["kick_error"], 0.3)
    return Population(**values, kick_follows=float(np.clip(vector[-1], -1.0, 1.0)))
