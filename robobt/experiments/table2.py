"""Table 2: the network against linear logistic regression in a repeated cross-validation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from robobt.experiments.shot_sets import ShotSets
from robobt.shots.data.inputs import goals, shot_inputs
from robobt.shots.predict.predictors import make_predictor
from robobt.shots.predict.validation import accuracies, predict_folds
from robobt.statistics import PairedTest, corrected_resampled_t_test, mean_interval, repeated_stratified_folds
from robobt.world.geometry import FloatArray

FOLDS = REPEATS = 10
HOLD_OUTS = (0.33, 0.25)
"""Shares of the training shots held out for early stopping."""


@dataclass(frozen=True)
class Row:
    """A row of the table; accuracies in percent, differences of the network to the other in points."""

    network: float
    logistic: float
    difference: float
    variance: float
    t: float
    p: float


PAPER = {
    0.33: Row(87.4024, 84.4512, 2.9512, 18.5950, 1.9666, 0.0520),
    0.25: Row(87.5478, 84.5923, 2.9556, 17.0759, 2.0552, 0.0425),
}
"""The published table."""


def table2(
    sets: ShotSets, replications: int = 10, seed: int = 0, progress: Callable[[], object] = lambda: None
) -> dict[str, Any]:
    """Replicate the table: folds, hold-outs and seeds are drawn anew each time.

    The training shots alone are used. Beside the paper's regression, which
    liblinear regularises unevenly on raw millimetres and radians, stands the same
    on standardised inputs.

    Args:
        replications: how often.
        seed: of the first; the next ones count up.
        progress: called after every replication of a hold-out.

    Returns:
        ``source``, ``shots``, ``goals``, ``replications``, ``seed`` and
        ``hold_outs``: for each share ``paper`` (the published row) and our ``network``,
        ``logistic``, ``standardised`` (mean over the replications, ``low`` and
        ``high`` of its 95 % interval, ``least`` and ``most``), and the tests of the
        network against both, ``test_logistic`` and ``test_standardised``: means of
        ``difference``, ``variance``, ``t``, ``p``, the range of p, and in how many
        replications p was below 0.05, ``significant``.
    """
    inputs, labels = shot_inputs(sets.train), goals(sets.train)
    found: dict[float, list[_Replication]] = {share: [] for share in HOLD_OUTS}
    for share in HOLD_OUTS:
        for i in range(replications):
            found[share].append(_replicate(inputs, labels, share, seed + i))
            progress()
    return {
        "source": sets.source,
        "shots": len(labels),
        "goals": int(labels.sum()),
        "replications": replications,
        "seed": seed,
        "hold_outs": {
            f"{share:.0%}": {"paper": asdict(PAPER[share])} | _summary(found[share]) for share in HOLD_OUTS
        },
    }


@dataclass(frozen=True)
class _Replication:
    network: float
    logistic: float
    standardised: float
    test_logistic: PairedTest
    test_standardised: PairedTest


def _replicate(inputs: FloatArray, labels: Any, share: float, seed: int) -> _Replication:
    folds = repeated_stratified_folds(labels, FOLDS, REPEATS, seed)
    network = make_predictor("table_one").set_params(
        networkclassifier__hold_out=share, networkclassifier__random_state=len(folds) * seed
    )
    runs = {
        name: 100.0 * accuracies(predict_folds(estimator, inputs, labels, folds), labels, folds)
        for name, estimator in (
            ("network", network),
            ("logistic", make_predictor("logistic")),
            ("standardised", make_predictor("logistic_standardised")),
        )
    }
    ratio = 1.0 / (FOLDS - 1)
    return _Replication(
        float(runs["network"].mean()),
        float(runs["logistic"].mean()),
        float(runs["standardised"].mean()),
        corrected_resampled_t_test(runs["network"] - runs["logistic"], ratio),
        corrected_resampled_t_test(runs["network"] - runs["standardised"], ratio),
    )


def _summary(found: list[_Replication]) -> dict[str, Any]:
    summary: dict[str, Any] = {}
    for name in ("network", "logistic", "standardised"):
        values = np.array([getattr(one, name) for one in found])
        low, high = mean_interval(values) if len(values) > 1 else (None, None)
        summary[name] = {
            "mean": float(values.mean()),
            "low": low,
            "high": high,
            "least": float(values.min()),
            "most": float(values.max()),
        }
    for name in ("test_logistic", "test_standardised"):
        tests = [getattr(one, name) for one in found]
        summary[name] = {
            "difference": float(np.mean([test.mean for test in tests])),
            "variance": float(np.mean([test.variance for test in tests])),
            "t": float(np.mean([test.t for test in tests])),
            "p": float(np.mean([test.p for test in tests])),
            "least_p": min(test.p for test in tests),
            "most_p": max(test.p for test in tests),
            "significant": sum(test.p < 0.05 for test in tests),
        }
    return summary
