"""Table 3: the confusion matrix on the test shots, of the paper's network and of all others."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import torch
from numpy.typing import NDArray
from sklearn.pipeline import Pipeline

from paper.predictors import PREDICTORS, paper_features
from paper.validation import judge_repeats, predict_folds
from robobt.shots import (
    NetworkClassifier,
    ShotDataError,
    ShotSets,
    goals,
    judge,
    shot_inputs,
    stratified_folds,
)
from robobt.statistics import ReliabilityBin, mcnemar, mean_interval, reliability, wilson_interval
from robobt.world import FloatArray

PAPER_CONFUSION = [[102, 20], [10, 69]]
"""A row for failures and one for successes; columns: predicted as failure, as success."""

RETRAINED = "table_one"
"""The model that is trained again and again with the paper's recipe."""

MOST_SHOTS = 2000
"""Largest number of shots for training small networks and for cross-validation: four times the paper's.

Each step of a network's training sees sixteen of them: more take hours and change nothing.
"""


@dataclass(frozen=True)
class Paired:
    """McNemar's test against another model: shots that only one of them predicts right."""

    against: str
    only_this: int
    only_other: int
    p: float


@dataclass(frozen=True)
class CrossValidation:
    """Means over the repeats; the accuracy in percent."""

    accuracy: float
    log_loss: float
    calibration_error: float


@dataclass(frozen=True)
class ModelReport:
    """One model on the test shots; its accuracy in percent, with its Wilson interval."""

    confusion: list[list[int]]
    accuracy: float
    low: float
    high: float
    log_loss: float
    calibration_error: float
    reliability: list[ReliabilityBin]
    mcnemar: Paired | None
    cross_validation: CrossValidation | None


@dataclass(frozen=True)
class Retrained:
    """Accuracies in percent of the network of Table 1 trained with many seeds; low and high of the mean."""

    seeds: int
    mean: float
    low: float | None
    high: float | None
    sd: float | None
    median: float
    least: float
    most: float


@dataclass(frozen=True)
class Count:
    """How many shots there are and how many of them scored."""

    shots: int
    goals: int


@dataclass(frozen=True)
class Published:
    """The paper's table; the accuracy in percent."""

    confusion: list[list[int]]
    accuracy: float


@dataclass(frozen=True)
class Table3:
    """The table for every model by name; ``author`` among them where his weights are at hand."""

    source: str
    train: Count
    test: Count
    paper: Published
    retrained: Retrained | None
    models: dict[str, ModelReport]


def table3(
    sets: ShotSets,
    seeds: int = 100,
    repeats: int = 10,
    models: Sequence[str] = tuple(PREDICTORS),
    progress: Callable[[], object] = lambda: None,
) -> Table3:
    """Judge predictors on the test shots, and by cross-validation on the training shots.

    The network of Table 1 is trained ``seeds`` times with the paper's recipe, on the
    author's split for early stopping where the data names one; its report is that
    of the run with the median accuracy. Every other predictor is fitted once on all
    training shots. McNemar's test is against the author's network, else the retrained one.

    Args:
        sets: the shots.
        seeds: how often the network is trained, seeds 0, 1, ...
        repeats: of the tenfold cross-validation; 0 for none.
        models: names of :data:`~paper.predictors.PREDICTORS`.
        progress: called after every model.

    Raises:
        ShotDataError: the data has too few shots for it.
        KeyError: no such model.
    """
    x, y = shot_inputs(sets.train), goals(sets.train)
    test_x, test_y = shot_inputs(sets.test), goals(sets.test)
    if min(np.bincount(y, minlength=2)) < 10:
        raise ShotDataError(f"{sets.source}: has fewer than 10 goals or failures to learn from")
    predicted: dict[str, FloatArray] = {}
    if sets.author is not None:
        with torch.inference_mode():
            logits = sets.author(torch.tensor(paper_features(test_x), dtype=torch.float32))
            predicted["author"] = torch.sigmoid(logits)[:, 0].numpy().astype(np.float64)
    few = np.arange(len(y))
    if len(y) > MOST_SHOTS:
        few = np.random.default_rng(0).choice(few, MOST_SHOTS, replace=False)
    folds = stratified_folds(y, repeats) if repeats and len(y) <= MOST_SHOTS else []
    retrained = None
    validated: dict[str, CrossValidation] = {}
    for name in models:
        predictor = PREDICTORS[name]()
        if name == RETRAINED:
            split = np.array(sets.train.column("early_stop_split").to_pylist())
            runs = _retrain(predictor, (x[few], y[few]), split[few] == "valid", seeds, test_x)
            accuracy = 100.0 * np.mean((runs >= 0.5) == (test_y == 1), axis=1)
            predicted[name] = runs[np.argsort(accuracy, kind="stable")[seeds // 2]]
            retrained = _spread(accuracy)
        else:
            used = few if isinstance(predictor[-1], NetworkClassifier) else np.arange(len(y))
            fitted = PREDICTORS[name]().fit(x[used], y[used])
            predicted[name] = np.asarray(fitted.predict_proba(test_x)[:, 1])
        if folds:
            judged = judge_repeats(predict_folds(predictor, x, y, folds), y, folds)
            validated[name] = CrossValidation(
                100.0 * float(np.mean([one.accuracy for one in judged])),
                float(np.mean([one.log_loss for one in judged])),
                float(np.mean([one.calibration_error for one in judged])),
            )
        progress()
    reference = next((name for name in ("author", RETRAINED) if name in predicted), None)
    return Table3(
        sets.source,
        Count(len(y), int(y.sum())),
        Count(len(test_y), int(test_y.sum())),
        Published(PAPER_CONFUSION, 100.0 * (102 + 69) / 201),
        retrained,
        {name: _report(name, predicted, test_y, reference, validated.get(name)) for name in predicted},
    )


def _retrain(
    predictor: Pipeline,
    train: tuple[FloatArray, NDArray[np.int64]],
    held_out: NDArray[np.bool_],
    seeds: int,
    test_inputs: FloatArray,
) -> FloatArray:
    """Return probabilities of the test shots (seeds, n) from networks trained with the paper's recipe."""
    inputs, labels = predictor[:-1].fit_transform(train[0]), train[1]
    named = held_out if held_out.any() and not held_out.all() else None
    networks = predictor[-1].fit_many([(inputs, labels)] * seeds, named)
    judged = predictor[:-1].transform(test_inputs)
    return np.stack([one.predict_proba(judged)[:, 1] for one in networks])


def _spread(values: FloatArray) -> Retrained:
    several = len(values) > 1
    low, high = mean_interval(values) if several else (None, None)
    return Retrained(
        len(values),
        float(values.mean()),
        low,
        high,
        float(values.std(ddof=1)) if several else None,
        float(np.median(values)),
        float(values.min()),
        float(values.max()),
    )


def _report(
    name: str,
    predicted: dict[str, FloatArray],
    labels: NDArray[np.int64],
    reference: str | None,
    validated: CrossValidation | None,
) -> ModelReport:
    judged = judge(predicted[name], labels)
    right = (predicted[name] >= 0.5) == (labels == 1)
    interval = wilson_interval(int(right.sum()), len(right))
    paired = None
    if reference is not None and reference != name:
        theirs = (predicted[reference] >= 0.5) == (labels == 1)
        test = mcnemar(right, theirs)
        paired = Paired(reference, test.only_first, test.only_second, test.p)
    return ModelReport(
        judged.confusion,
        100.0 * judged.accuracy,
        100.0 * interval.low,
        100.0 * interval.high,
        judged.log_loss,
        judged.calibration_error,
        reliability(predicted[name], labels),
        paired,
        validated,
    )
