"""Shot predictors by name: unfitted scikit-learn estimators over a shot's scene.

All take X = :func:`~robobt.shots.data.inputs.shot_inputs` (n, 34) and y =
:func:`~robobt.shots.data.inputs.goals`, and answer ``predict_proba`` with the
probability of a goal in the second column.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Literal

from sklearn.calibration import CalibratedClassifierCV
from sklearn.ensemble import VotingClassifier
from sklearn.gaussian_process import GaussianProcessClassifier
from sklearn.gaussian_process.kernels import ConstantKernel, DotProduct, Matern
from sklearn.linear_model import LogisticRegression
from sklearn.pipeline import Pipeline, make_pipeline
from sklearn.preprocessing import PolynomialFeatures, StandardScaler

from robobt.shots.predict.features import ShotFeatures
from robobt.shots.predict.network_classifier import NetworkClassifier
from robobt.shots.predict.networks import KIKS, TABLE_ONE
from robobt.shots.predict.physics_margin import MarginFeatures, PhysicsMargin
from robobt.shots.predict.set_network import SetNetworkClassifier
from robobt.shots.predict.subsample import Subsampled
from robobt.tree.registry import Registry

PREDICTORS: Registry[Callable[[], Any]] = Registry("shot predictor")
"""Functions without arguments that return an unfitted estimator."""


def make_predictor(name: str) -> Any:
    """An unfitted predictor by its name.

    Raises:
        KeyError: no such name; the message lists those there are.
    """
    return PREDICTORS[name]()


@PREDICTORS.register("table_one")
def table_one() -> Pipeline:
    """The paper's network (Table 1) on its five inputs, in millimetres as the author fed it."""
    return make_pipeline(ShotFeatures("paper"), NetworkClassifier(TABLE_ONE))


@PREDICTORS.register("table_one_velocity")
def table_one_velocity() -> Pipeline:
    """The same network with the goalkeeper's speed towards the line as a sixth input."""
    return make_pipeline(ShotFeatures("paper_velocity"), NetworkClassifier(TABLE_ONE))


@PREDICTORS.register("kiks")
def kiks() -> Pipeline:
    """Naito et al.'s network on speed of the shot, opponent's distance and angle."""
    return make_pipeline(ShotFeatures("kiks"), NetworkClassifier(KIKS))


@PREDICTORS.register("logistic")
def logistic() -> Pipeline:
    """The paper's linear logistic regression: liblinear on the raw millimetres and radians."""
    return make_pipeline(ShotFeatures("paper"), LogisticRegression(solver="liblinear"))


@PREDICTORS.register("logistic_standardised")
def logistic_standardised() -> Pipeline:
    """The same five inputs, standardised first, which is all it lacked against the network."""
    return make_pipeline(ShotFeatures("paper"), StandardScaler(), LogisticRegression())


@PREDICTORS.register("logistic_velocity")
def logistic_velocity() -> Pipeline:
    """Logistic regression on b, x, L and v."""
    return make_pipeline(ShotFeatures("motion"), StandardScaler(), LogisticRegression())


@PREDICTORS.register("quadratic")
def quadratic() -> Pipeline:
    """Logistic regression on b, x, L, v, their squares and products."""
    return make_pipeline(
        ShotFeatures("motion"),
        StandardScaler(),
        PolynomialFeatures(2, include_bias=False),
        LogisticRegression(max_iter=1000),
    )


@PREDICTORS.register("physics_margin")
def physics_margin() -> Pipeline:
    """The ball's time to the goalkeeper's interception point against the goalkeeper's."""
    return make_pipeline(ShotFeatures("motion"), PhysicsMargin())


@PREDICTORS.register("quadratic_margin")
def quadratic_margin() -> Pipeline:
    """Logistic regression on that race's margin, x, L, their squares and products."""
    return make_pipeline(
        ShotFeatures("motion"),
        MarginFeatures(),
        StandardScaler(),
        PolynomialFeatures(2, include_bias=False),
        LogisticRegression(max_iter=1000),
    )


@PREDICTORS.register("gaussian_process")
def gaussian_process() -> Pipeline:
    """A Gaussian process on b, x, L, v: linear far from all shots, free where there are many.

    Its kernel is fixed, so that a few hundred shots take a moment. Time grows with
    the cube of their number: of many it sees 1500.
    """
    kernel = ConstantKernel(4.0) * DotProduct(1.0) + ConstantKernel(4.0) * Matern([4.0] * 4, nu=2.5)
    process = Subsampled(GaussianProcessClassifier(kernel, optimizer=None), most=1500)
    return make_pipeline(ShotFeatures("motion"), StandardScaler(), process)


@PREDICTORS.register("set")
def set_network() -> Pipeline:
    """A network that sees everybody's state and all opponents at once; wants thousands of shots."""
    return make_pipeline(SetNetworkClassifier())


@PREDICTORS.register("best")
def best_predictor() -> VotingClassifier:
    """What predicts best from a few hundred shots, chosen by cross-validation on the real 542.

    To fit it on the author's training shots and predict others::

        train, test = read_shots("train.csv"), read_shots("test.csv")
        model = best_predictor().fit(shot_inputs(train), goals(train))
        p = model.predict_proba(shot_inputs(test))[:, 1]

    The mean of three that err in different ways: two follow closely what was
    recorded, the process and the race keep their sense outside it. It needs the
    opponent's position and velocity in the shot frame and the target's distance; any
    file that :func:`~robobt.shots.data.files.read_shots` reads does.
    """
    return VotingClassifier(
        [("quadratic", quadratic()), ("margin", quadratic_margin()), ("process", gaussian_process())],
        voting="soft",
    )


def calibrated(
    estimator: Any, method: Literal["temperature", "sigmoid", "isotonic"] = "temperature", folds: int = 5
) -> CalibratedClassifierCV:
    """An estimator whose probabilities are corrected by what cross-validation shows of it.

    The correction is learned from predictions for shots that the estimator had not
    seen; the estimator itself is then fitted on all.

    Args:
        method: ``temperature`` scales logits, ``sigmoid`` scales and shifts them
            (Platt), ``isotonic`` is any rising curve and wants a thousand shots.
    """
    return CalibratedClassifierCV(estimator, method=method, cv=folds, ensemble=False)


@PREDICTORS.register("best_calibrated")
def best_calibrated() -> CalibratedClassifierCV:
    """The best predictor with its temperature learned by cross-validation: for thousands of shots."""
    return calibrated(best_predictor())
