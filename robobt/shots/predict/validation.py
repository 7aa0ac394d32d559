"""Cross-validation of shot predictors, and its results."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from sklearn.metrics import log_loss
from sklearn.model_selection import RepeatedStratifiedKFold

from robobt.statistics import calibration_error

FOLDS = 10

Fold = tuple[NDArray[np.intp], NDArray[np.intp]]
"""Indices to train on and to test on."""


@dataclass(frozen=True)
class Judgement:
    """Quality of predictions.

    Attributes:
        shots: how many were predicted.
        accuracy: share of shots on the right side of a half.
        log_loss: mean negative log-likelihood.
        calibration_error: mean gap between predicted and observed, ten bins.
        confusion: a row for failures and one for successes; columns: predicted as
            failure, predicted as success.
    """

    shots: int
    accuracy: float
    log_loss: float
    calibration_error: float
    confusion: list[list[int]]


def judge(probabilities: ArrayLike, scored: ArrayLike) -> Judgement:
    """Return how good ``probabilities`` (n,) of a goal are, by which shots ``scored`` (n,)."""
    p, goal = np.asarray(probabilities, dtype=np.float64), np.asarray(scored) == 1
    likely = p >= 0.5
    return Judgement(
        len(p),
        float((likely == goal).mean()),
        float(log_loss(goal, p, labels=[False, True])),
        calibration_error(p, goal),
        [[int((likely[goal == was] == answer).sum()) for answer in (False, True)] for was in (False, True)],
    )


def stratified_folds(labels: NDArray[np.int64], repeats: int, seed: int = 0) -> list[Fold]:
    """Return the runs of a repeated tenfold stratified cross-validation, repeat by repeat.

    Args:
        labels: label of each sample (n,), of which every fold has the same shares.
        repeats: how often to divide the samples.
        seed: of the divisions.

    Returns:
        For each run the indices to train on and those to test on.
    """
    split = RepeatedStratifiedKFold(n_splits=FOLDS, n_repeats=repeats, random_state=seed)
    return list(split.split(labels, labels))
