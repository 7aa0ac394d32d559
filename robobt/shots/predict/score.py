"""How good a model file is on given shots."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow as pa
from numpy.typing import ArrayLike

from robobt.models.card import Measured
from robobt.models.policy import load_policy
from robobt.shots.data.inputs import asked_inputs
from robobt.shots.data.problems import ShotDataError
from robobt.shots.predict.features import pair_features
from robobt.shots.predict.validation import judge
from robobt.statistics import calibration_error, mean_interval, wilson_interval
from robobt.world.features import SHOT
from robobt.world.geometry import FloatArray

RESAMPLES = 1000
_SURE = 1e-6


def predicted_by(model: str | Path, table: pa.Table) -> FloatArray:
    """Return the probability of a goal (n,) that a shot predictor gives each shot of a table.

    It is asked as a rater asks it in play: about a kick that goes out along the line to the target.

    Raises:
        ModelError: there is no such model, or it is no shot predictor.
        ShotDataError: a shot lacks what the model needs to know.
    """
    policy = load_policy(model, kind="shot_predictor")
    scenes = asked_inputs(table)
    inputs = pair_features(scenes) if policy.card.observation.name == SHOT.name else scenes
    unknown = np.flatnonzero(~np.isfinite(inputs).all(axis=1))
    if len(unknown):
        raise ShotDataError(f"shot {unknown[0] + 1}: lacks something that {policy.card.name} needs to know")
    answers: FloatArray = np.asarray(policy(inputs.astype(np.float32)), dtype=np.float64)
    return answers.reshape(len(inputs))


def measured(probabilities: ArrayLike, scored: ArrayLike, prefix: str = "") -> dict[str, Measured]:
    """Return accuracy, log-loss and calibration error with their 95 % intervals, by name.

    The interval of the accuracy is Wilson's, that of the log-loss Student's over the shots, that of
    the calibration error from :data:`RESAMPLES` resamplings of the shots. Names begin with ``prefix``.
    """
    p = np.clip(np.asarray(probabilities, dtype=np.float64), _SURE, 1.0 - _SURE)
    goal = np.asarray(scored) == 1
    judged = judge(p, goal)
    right = wilson_interval(round(judged.accuracy * judged.shots), judged.shots)
    loss = mean_interval(-np.where(goal, np.log(p), np.log1p(-p)))
    drawn = np.random.default_rng(0).integers(0, len(p), (RESAMPLES, len(p)))
    low, high = np.quantile([calibration_error(p[rows], goal[rows]) for rows in drawn], (0.025, 0.975))
    figures = {
        "accuracy": (judged.accuracy, right.low, right.high, "95 % Wilson"),
        "log_loss": (judged.log_loss, loss.low, loss.high, "95 % Student"),
        "calibration_error": (judged.calibration_error, float(low), float(high), "95 % bootstrap"),
    }
    return {
        prefix + name: Measured(value=value, low=low, high=high, n=judged.shots, interval=kind)
        for name, (value, low, high, kind) in figures.items()
    }
