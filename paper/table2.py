"""Table 2: the network against linear logistic regression in a repeated cross-validation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from paper.predictors import logistic, logistic_standardised, table_one
from paper.validation import accuracies, predict_folds
from robobt.shots import FOLDS, ShotSets, goals, shot_inputs, stratified_folds
from robobt.statistics import PairedTest, corrected_resampled_t_test, mean_interval
from robobt.world import FloatArray

REPEATS = 10
HOLD_OUTS = (0.33, 0.25)
"""Shares of the training shots held out for early stopping."""


@dataclass(frozen=True)
class PaperRow:
    """A row of the published table.

    Accuracies are in percent, the difference of the network to the other in points.
    """

    network: float
    logistic: float
    difference: float
    variance: float
    t: float
    p: float


PAPER = {
    0.33: PaperRow(87.4024, 84.4512, 2.9512, 18.5950, 1.9666, 0.0520),
    0.25: PaperRow(87.5478, 84.5923, 2.9556, 17.0759, 2.0552, 0.0425),
}


@dataclass(frozen=True)
class Spread:
    """Mean accuracy in percent over the replications, its 95 % interval and its range."""

    mean: float
    low: float | None
    high: float | None
    least: float
    most: float


@dataclass(frozen=True)
class Comparison:
    """The paired tests of the network against another, over the replications.

    Means of difference, variance, t and p; the range of p; in how many it was below 0.05.
    """

    difference: float
    variance: float
    t: float
    p: float
    least_p: float
    most_p: float
    significant: int


@dataclass(frozen=True)
class HoldOut:
    """What one share held out for early stopping gives, beside the published row."""

    paper: PaperRow
    network: Spread
    logistic: Spread
    standardised: Spread
    test_logistic: Comparison
    test_standardised: Comparison


@dataclass(frozen=True)
class Table2:
    """The table replicated; ``hold_outs`` by the share held out (33%, 25%)."""

    source: str
    shots: int
    goals: int
    replications: int
    seed: int
    hold_outs: dict[str, HoldOut]


def table2(
    sets: ShotSets, replications: int = 10, seed: int = 0, progress: Callable[[], object] = lambda: None
) -> Table2:
    """Replicate the table; folds, hold-outs and seeds are drawn again each time, from ``seed`` on.

    The training shots alone are used. Beside the paper's regression, which
    liblinear regularises unevenly on raw millimetres and radians, stands the same
    on standardised inputs.
    """
    inputs, labels = shot_inputs(sets.train), goals(sets.train)
    found: dict[str, HoldOut] = {}
    for share in HOLD_OUTS:
        runs = []
        for i in range(replications):
            runs.append(_replicate(inputs, labels, share, seed + i))
            progress()
        network, linear, standardised = (np.array(column) for column in zip(*runs, strict=True))
        found[f"{share:.0%}"] = HoldOut(
            PAPER[share],
            _spread(network),
            _spread(linear),
            _spread(standardised),
            _compared(network - linear),
            _compared(network - standardised),
        )
    return Table2(sets.source, len(labels), int(labels.sum()), replications, seed, found)


def _replicate(
    inputs: FloatArray, labels: NDArray[np.int64], share: float, seed: int
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the accuracies of the network and both regressions in every run, in percent."""
    folds = stratified_folds(labels, REPEATS, seed)
    network = table_one().set_params(
        networkclassifier__hold_out=share, networkclassifier__random_state=len(folds) * seed
    )
    found = [
        100.0 * accuracies(predict_folds(predictor, inputs, labels, folds), labels, folds)
        for predictor in (network, logistic(), logistic_standardised())
    ]
    return found[0], found[1], found[2]


def _spread(runs: FloatArray) -> Spread:
    means = runs.mean(axis=1)
    low, high = mean_interval(means) if len(means) > 1 else (None, None)
    return Spread(float(means.mean()), low, high, float(means.min()), float(means.max()))


def _compared(differences: FloatArray) -> Comparison:
    tests: list[PairedTest] = [corrected_resampled_t_test(row, 1.0 / (FOLDS - 1)) for row in differences]
    ps = [test.p for test in tests]
    return Comparison(
        float(np.mean([test.mean for test in tests])),
        float(np.mean([test.variance for test in tests])),
        float(np.mean([test.t for test in tests])),
        float(np.mean(ps)),
        min(ps),
        max(ps),
        sum(p < 0.05 for p in ps),
    )
