"""How well a population of goalkeepers explains recorded shots: predicted against real outcomes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from paper.goalkeeper_fit import fit_population, validate_population
from paper.goalkeeper_race import race_inputs
from robobt.models import Measured
from robobt.shots import (
    FOLDS,
    Population,
    ShotDataError,
    goals,
    load_shot_sets,
    measured,
    read_shots,
    stratified_folds,
)
from robobt.world import FloatArray

DISTANCES = (0.0, 2.6, 3.0, 3.4, 3.8, 20.0)
"""Between which distances from shooter to target goals are counted [m]."""

ANGLES = (0.0, 0.1, 0.14, 0.18, 0.25, 3.2)
"""Bins of the angle between the goalkeeper and the line of the shot, as the shooter sees it [rad]."""


@dataclass(frozen=True)
class Bin:
    """Shots between two values: how many scored and how many should have."""

    low: float
    high: float
    shots: int
    goals: int
    predicted: float


@dataclass(frozen=True)
class Explained:
    """A fit: the population on all shots, and how others, fitted without a tenth, predict that tenth.

    ``figures`` are accuracy, log-loss and calibration error; ``predicted`` is the mean of the
    probabilities, ``base_rate`` the share that scored.
    """

    population: Population
    shots: int
    base_rate: float
    predicted: float
    figures: Mapping[str, Measured]
    by_distance: list[Bin]
    by_angle: list[Bin]


def explain(table: pa.Table, seed: int = 0, on_fit: Callable[[], object] = lambda: None) -> Explained:
    """Fit a population of goalkeepers to recorded shots and cross-validate it.

    Args:
        table: shots, with the goalkeeper's position and velocity at the kick.
        seed: of the ten folds.
        on_fit: called after each of the eleven fits.

    Raises:
        ShotDataError: too few goals or misses.
    """
    shots, scored = race_inputs(table), goals(table)
    if min(np.bincount(scored, minlength=2)) < FOLDS:
        raise ShotDataError(
            f"a fit needs {FOLDS} goals and misses or more, not {scored.sum()} goals of {len(scored)}"
        )
    population = fit_population(shots, scored)
    on_fit()
    predicted = validate_population(shots, scored, stratified_folds(scored, 1, seed), on_fit)
    angle = np.abs(np.arctan2(table.column("opp_y").to_numpy(), table.column("opp_x").to_numpy()))
    return Explained(
        population,
        len(scored),
        float(scored.mean()),
        float(predicted.mean()),
        measured(predicted, scored),
        _bins(table.column("distance_to_goal").to_numpy(), DISTANCES, predicted, scored),
        _bins(angle, ANGLES, predicted, scored),
    )


def shots_to_fit(data: Path) -> pa.Table:
    """Return the shots of a file, or those to train on of a folder."""
    return load_shot_sets(data).train if data.is_dir() else read_shots(data)


def _bins(
    values: FloatArray, edges: tuple[float, ...], predicted: FloatArray, scored: NDArray[np.int64]
) -> list[Bin]:
    found = []
    for low, high in pairwise(edges):
        there = (values >= low) & (values < high)
        found.append(
            Bin(low, high, int(there.sum()), int(scored[there].sum()), float(predicted[there].sum()))
        )
    return found
