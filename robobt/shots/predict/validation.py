"""Cross-validation of shot predictors, and its results."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from sklearn.base import clone
from sklearn.metrics import log_loss
from sklearn.model_selection import RepeatedStratifiedKFold
from sklearn.pipeline import Pipeline

from robobt.shots.predict.network_classifier import NetworkClassifier
from robobt.statistics import calibration_error
from robobt.world.geometry import FloatArray

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
    """Judge probabilities (n,) of a goal by which shots scored (n,)."""
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
    """Return the runs of a repeated tenfold stratified cross-validation, repeat by repeat."""
    split = RepeatedStratifiedKFold(n_splits=FOLDS, n_repeats=repeats, random_state=seed)
    return list(split.split(labels, labels))


def predict_folds(
    predictor: Pipeline, inputs: FloatArray, labels: NDArray[np.int64], folds: Sequence[Fold]
) -> list[FloatArray]:
    """Return probabilities of a goal for every fold's test samples, from a fit on its others.

    Networks are trained all at once; the i-th fold's draws from its ``random_state + i``.
    """
    if isinstance(predictor[-1], NetworkClassifier):
        inputs = predictor[:-1].fit_transform(inputs)
        fitted = predictor[-1].fit_many([(inputs[train], labels[train]) for train, _ in folds])
    else:
        fitted = [clone(predictor).fit(inputs[train], labels[train]) for train, _ in folds]
    return [
        np.asarray(one.predict_proba(inputs[test])[:, 1])
        for one, (_, test) in zip(fitted, folds, strict=True)
    ]


def accuracies(
    predicted: Sequence[FloatArray], labels: NDArray[np.int64], folds: Sequence[Fold]
) -> FloatArray:
    """Return the accuracy of every run of a cross-validation, (runs,)."""
    return np.array(
        [np.mean((p >= 0.5) == (labels[test] == 1)) for p, (_, test) in zip(predicted, folds, strict=True)]
    )


def judge_repeats(
    predicted: Sequence[FloatArray], labels: NDArray[np.int64], folds: Sequence[Fold]
) -> list[Judgement]:
    """Judge every repeat of a cross-validation on all its samples."""
    judged = []
    for start in range(0, len(folds), FOLDS):
        p = np.empty(len(labels))
        for one, (_, test) in zip(
            predicted[start : start + FOLDS], folds[start : start + FOLDS], strict=True
        ):
            p[test] = one
        judged.append(judge(p, labels))
    return judged
