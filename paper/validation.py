"""Cross-validation of shot predictors, fold by fold."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from sklearn.base import clone
from sklearn.pipeline import Pipeline

from robobt.shots import FOLDS, Judgement, NetworkClassifier, judge
from robobt.world import FloatArray

Fold = tuple[NDArray[np.intp], NDArray[np.intp]]
"""Indices to train on and to test on."""


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
