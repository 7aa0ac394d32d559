"""Cross-validation of shot predictors, and what comes of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from sklearn.base import clone
from sklearn.pipeline import Pipeline, make_pipeline

from robobt.shots.predict.network_classifier import NetworkClassifier
from robobt.statistics import Fold, calibration_error, log_loss
from robobt.world.geometry import FloatArray


@dataclass(frozen=True)
class Judgement:
    """How good predictions are.

    Attributes:
        accuracy: share of shots on the right side of a half.
        log_loss: mean negative log-likelihood.
        calibration_error: mean gap between predicted and observed, ten bins.
        confusion: a row for failures and one for successes; columns: predicted as
            failure, predicted as success.
    """

    accuracy: float
    log_loss: float
    calibration_error: float
    confusion: tuple[tuple[int, int], tuple[int, int]]


def judge(probabilities: ArrayLike, scored: ArrayLike) -> Judgement:
    """Judge probabilities (n,) of a goal by which shots scored (n,)."""
    p, goal = np.asarray(probabilities, dtype=np.float64), np.asarray(scored) == 1
    said = p >= 0.5
    counts = [int((said == s)[goal == g].sum()) for g in (False, True) for s in (False, True)]
    return Judgement(
        float((said == goal).mean()),
        log_loss(p, goal),
        calibration_error(p, goal),
        ((counts[0], counts[1]), (counts[2], counts[3])),
    )


def fit_folds(
    estimator: Any,
    inputs: FloatArray,
    labels: NDArray[Any],
    folds: Sequence[Fold],
    progress: Callable[[], object] = lambda: None,
) -> list[Any]:
    """Clones of an estimator, each fitted on the training samples of a fold.

    Networks of a cross-validation, by themselves or at the end of a pipeline, are
    trained all at once; the i-th fold's draws from its ``random_state + i``.

    Args:
        progress: called after every fold that is fitted by itself.
    """
    steps = [step for _, step in estimator.steps] if isinstance(estimator, Pipeline) else [estimator]
    if not isinstance(steps[-1], NetworkClassifier):
        fitted = []
        for fold in folds:
            fitted.append(clone(estimator).fit(inputs[fold.train], labels[fold.train]))
            progress()
        return fitted
    before: list[list[Any]] = []
    sets = []
    for fold in folds:
        x, transformers = inputs[fold.train], []
        for step in steps[:-1]:
            transformers.append(clone(step))
            x = transformers[-1].fit_transform(x, labels[fold.train])
        before.append(transformers)
        sets.append((x, labels[fold.train]))
    networks = steps[-1].fit_many(sets)
    return [make_pipeline(*first, last) for first, last in zip(before, networks, strict=True)]


def predict_folds(
    estimator: Any,
    inputs: FloatArray,
    labels: NDArray[Any],
    folds: Sequence[Fold],
    progress: Callable[[], object] = lambda: None,
) -> list[FloatArray]:
    """Probabilities of the second label for every fold's test samples, from a fit on its others."""
    fitted = fit_folds(estimator, inputs, labels, folds, progress)
    return [
        np.asarray(one.predict_proba(inputs[fold.test])[:, 1])
        for one, fold in zip(fitted, folds, strict=True)
    ]


def accuracies(predicted: Sequence[FloatArray], labels: NDArray[Any], folds: Sequence[Fold]) -> FloatArray:
    """Accuracy of every run of a cross-validation, (runs,)."""
    return np.array(
        [np.mean((p >= 0.5) == (labels[fold.test] == 1)) for p, fold in zip(predicted, folds, strict=True)]
    )


def judge_repeats(
    predicted: Sequence[FloatArray], labels: NDArray[Any], folds: Sequence[Fold], repeats: int
) -> list[Judgement]:
    """A judgement for every repeat of a cross-validation, each of all samples."""
    size = len(folds) // repeats
    judged = []
    for start in range(0, len(folds), size):
        p = np.empty(len(labels))
        for one, fold in zip(predicted[start : start + size], folds[start : start + size], strict=True):
            p[fold.test] = one
        judged.append(judge(p, labels))
    return judged
