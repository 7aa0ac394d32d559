"""Table 3: the confusion matrix on the test shots, of the paper's network and of all others."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import pyarrow as pa
import torch
from numpy.typing import NDArray

from robobt.experiments.shot_sets import ShotSets
from robobt.shots.data.author_data import author_inputs
from robobt.shots.data.inputs import goals, shot_inputs
from robobt.shots.data.problems import ShotDataError
from robobt.shots.predict.network_classifier import NetworkClassifier
from robobt.shots.predict.networks import network_from_keras
from robobt.shots.predict.predictors import PREDICTORS, make_predictor
from robobt.shots.predict.subsample import Subsampled
from robobt.shots.predict.validation import judge, judge_repeats, predict_folds
from robobt.statistics import (
    log_loss,
    mcnemar,
    mean_interval,
    reliability,
    repeated_stratified_folds,
    wilson_interval,
)
from robobt.world.geometry import FloatArray

PAPER_CONFUSION = ((102, 20), (10, 69))
"""A row for failures and one for successes; columns: predicted as failure, as success."""

RETRAINED = "table_one"
"""The model that is trained again and again with the paper's recipe."""

MOST_FOR_RECIPE = 2000
"""Shots that the recipe's small networks learn from at most: four times the paper's.

Each step sees sixteen of them, and an epoch goes through all: more take hours and change nothing.
"""

MOST_TO_VALIDATE = 5000
"""Data sets up to this size are cross-validated; for larger ones the test shots say enough."""


def table3(
    sets: ShotSets,
    seeds: int = 100,
    repeats: int = 10,
    models: Sequence[str] | None = None,
    progress: Callable[[], object] = lambda: None,
) -> dict[str, Any]:
    """Judge predictors on the test shots, and by cross-validation on the training shots.

    The network of Table 1 is trained ``seeds`` times with the paper's recipe, on the
    author's split for early stopping where the data names one; its confusion is that
    of the run with the median accuracy. Every other predictor is fitted once on all
    training shots.

    Args:
        seeds: how often the network is trained, seeds 0, 1, ...
        repeats: of the tenfold cross-validation; 0 for none.
        models: names of predictors; None for all.
        progress: called after every model.

    Returns:
        ``source``, ``train``, ``test`` (shots and goals), ``paper`` (its confusion and
        accuracy), ``retrained`` (``seeds``; of their accuracies ``mean`` with its 95 %
        interval ``low`` and ``high``, ``sd``, ``median``, ``least``, ``most``) and
        ``models``: for each, ``author`` among them where his weights are at hand,
        ``confusion``, ``accuracy`` with its Wilson interval ``low`` and ``high``,
        ``log_loss``, ``calibration_error``, ``reliability``, ``mcnemar`` against the
        author's network (else the retrained one), and ``cross_validation`` (accuracy,
        log_loss and calibration_error, means over the repeats) or null. Accuracies in percent.

    Raises:
        ShotDataError: the data has too few shots for it, or lacks what a model needs.
        KeyError: no such model.
    """
    names = list(PREDICTORS) if models is None else list(models)
    predictors = {name: make_predictor(name) for name in names}
    x, y = shot_inputs(sets.train), goals(sets.train)
    test_x, test_y = shot_inputs(sets.test), goals(sets.test)
    if min(np.bincount(y, minlength=2)) < 10:
        raise ShotDataError(f"{sets.source}: has fewer than 10 goals or failures to learn from")
    predicted: dict[str, FloatArray] = {}
    if sets.author is not None:
        predicted["author"] = author_outputs(sets.author, sets.test)
    retrained = _retrain(predictors[RETRAINED], sets, seeds, test_x) if RETRAINED in predictors else None
    if retrained is not None:
        accuracy = np.array([np.mean((p >= 0.5) == (test_y == 1)) for p in retrained])
        middle = int(np.argsort(accuracy, kind="stable")[len(accuracy) // 2])
        predicted[RETRAINED] = retrained[middle]
        progress()
    folds = repeated_stratified_folds(y, 10, repeats) if repeats and len(y) <= MOST_TO_VALIDATE else []
    validated: dict[str, dict[str, float]] = {}
    for name, predictor in predictors.items():
        if name != RETRAINED:
            fitted = _sparing(predictor).fit(x, y)
            predicted[name] = np.asarray(fitted.predict_proba(test_x)[:, 1])
        if folds:
            judged = judge_repeats(predict_folds(predictor, x, y, folds), y, folds, repeats)
            validated[name] = {
                "accuracy": 100.0 * float(np.mean([one.accuracy for one in judged])),
                "log_loss": float(np.mean([one.log_loss for one in judged])),
                "calibration_error": float(np.mean([one.calibration_error for one in judged])),
            }
        progress()
    reference = next((name for name in ("author", RETRAINED) if name in predicted), None)
    return {
        "source": sets.source,
        "train": {"shots": len(y), "goals": int(y.sum())},
        "test": {"shots": len(test_y), "goals": int(test_y.sum())},
        "paper": {"confusion": [list(row) for row in PAPER_CONFUSION], "accuracy": 100.0 * (102 + 69) / 201},
        "retrained": None if retrained is None else _spread(100.0 * accuracy),
        "models": {
            name: _report(p, test_y, predicted, reference) | {"cross_validation": validated.get(name)}
            for name, p in predicted.items()
        },
    }


def author_outputs(author: dict[str, Any], shots: pa.Table) -> FloatArray:
    """Probabilities (n,) that the published predictor gives shots."""
    network = network_from_keras(author["layers"])
    with torch.inference_mode():
        logits = network(torch.tensor(author_inputs(shots), dtype=torch.float32))
        return np.asarray(torch.sigmoid(logits).numpy(), dtype=np.float64)


def _retrain(predictor: Any, sets: ShotSets, seeds: int, test_inputs: FloatArray) -> list[FloatArray]:
    """Probabilities of the test shots from networks trained with the paper's recipe."""
    features, network = predictor[0], predictor[-1]
    inputs, labels = features.fit_transform(shot_inputs(sets.train)), goals(sets.train)
    if len(labels) > MOST_FOR_RECIPE:
        drawn = np.random.default_rng(0).choice(len(labels), MOST_FOR_RECIPE, replace=False)
        inputs, labels = inputs[drawn], labels[drawn]
        held = None
    else:
        held = np.array(sets.train.column("early_stop_split").to_pylist()) == "valid"
        held = None if held.all() or not held.any() else held
    networks = network.fit_many([(inputs, labels)] * seeds, held)
    judged = features.transform(test_inputs)
    return [np.asarray(one.predict_proba(judged)[:, 1]) for one in networks]


def _sparing(predictor: Any) -> Any:
    """A predictor that learns from no more shots than its recipe is for."""
    last = getattr(predictor, "steps", [(None, predictor)])[-1][1]
    return Subsampled(predictor, MOST_FOR_RECIPE) if isinstance(last, NetworkClassifier) else predictor


def _spread(values: FloatArray) -> dict[str, Any]:
    low, high = mean_interval(values) if len(values) > 1 else (None, None)
    return {
        "seeds": len(values),
        "mean": float(values.mean()),
        "low": low,
        "high": high,
        "sd": float(values.std(ddof=1)) if len(values) > 1 else None,
        "median": float(np.median(values)),
        "least": float(values.min()),
        "most": float(values.max()),
    }


def _report(
    p: FloatArray, labels: NDArray[np.int64], predicted: dict[str, FloatArray], reference: str | None
) -> dict[str, Any]:
    judged = judge(p, labels)
    right = (p >= 0.5) == (labels == 1)
    interval = wilson_interval(int(right.sum()), len(right))
    report: dict[str, Any] = {
        "confusion": [list(row) for row in judged.confusion],
        "accuracy": 100.0 * judged.accuracy,
        "low": 100.0 * interval.low,
        "high": 100.0 * interval.high,
        "log_loss": log_loss(p, labels),
        "calibration_error": judged.calibration_error,
        "reliability": [row._asdict() for row in reliability(p, labels)],
        "mcnemar": None,
    }
    if reference is not None and predicted[reference] is not p:
        theirs = (predicted[reference] >= 0.5) == (labels == 1)
        test = mcnemar(right, theirs)
        report["mcnemar"] = {
            "against": reference,
            "only_this": test.only_first,
            "only_other": test.only_second,
            "p": test.p,
            "mid_p": mcnemar(right, theirs, "mid_p").p,
        }
    return report
