"""The predictors that Table 3 compares: unfitted scikit-learn estimators over a shot's scene.

All take X = :func:`~robobt.shots.data.inputs.shot_inputs` (n, 34) and y =
:func:`~robobt.shots.data.inputs.goals`, and answer ``predict_proba`` with the
probability of a goal in the second column.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import ArrayLike
from sklearn.linear_model import LogisticRegression
from sklearn.pipeline import Pipeline, make_pipeline
from sklearn.preprocessing import FunctionTransformer, StandardScaler

from robobt.shots import Layer, NetworkClassifier, Recipe, best_predictor, pair_features
from robobt.world import FloatArray

KIKS = (Layer(True, 8, "relu"), Layer(True, 8, "relu"), Layer(True, 1, "linear"))
"""Three dense layers with batch normalisation (Naito et al.); their sizes are not published."""

KICK_SPEED = 7.5
"""Speed of the recorded shots [m/s]: a constant input where the ball's speed is not recorded."""


def paper_features(scenes: ArrayLike) -> FloatArray:
    """Return Eq. 4 in the author's units: rad and mm."""
    return pair_features(scenes) * [1.0, 1e3, 1e3, 1e3, 1e3]


def table_one() -> Pipeline:
    """Return the paper's network (Table 1) on its five inputs, in millimetres as the author fed it."""
    return make_pipeline(FunctionTransformer(paper_features), NetworkClassifier())


def kiks_features(scenes: ArrayLike) -> FloatArray:
    """Return Naito et al.'s: speed of the shot [m/s], opponent's distance [m] and angle to the shot [rad]."""
    angle, _, distance, _, _ = pair_features(scenes).T
    return np.stack([np.full_like(angle, KICK_SPEED), distance, angle], axis=-1)


def kiks() -> Pipeline:
    """Return Naito et al.'s network on speed of the shot, opponent's distance and angle."""
    return make_pipeline(FunctionTransformer(kiks_features), NetworkClassifier(Recipe(KIKS)))


def logistic() -> Pipeline:
    """Return the paper's linear logistic regression: liblinear on the raw millimetres and radians."""
    return make_pipeline(FunctionTransformer(paper_features), LogisticRegression(solver="liblinear"))


def logistic_standardised() -> Pipeline:
    """Return the same on standardised inputs, which is all it lacked against the network."""
    return make_pipeline(FunctionTransformer(paper_features), StandardScaler(), LogisticRegression())


PREDICTORS: Mapping[str, Callable[[], Pipeline]] = {
    "table_one": table_one,
    "kiks": kiks,
    "logistic": logistic,
    "logistic_standardised": logistic_standardised,
    "best": best_predictor,
}
"""Functions without arguments that return an unfitted estimator, by name."""
