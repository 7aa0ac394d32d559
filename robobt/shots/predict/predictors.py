"""Shot predictors by name: unfitted scikit-learn estimators over a shot's scene.

All take X = :func:`~robobt.shots.data.inputs.shot_inputs` (n, 34) and y =
:func:`~robobt.shots.data.inputs.goals`, and answer ``predict_proba`` with the
probability of a goal in the second column.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from sklearn.impute import SimpleImputer
from sklearn.linear_model import LogisticRegression
from sklearn.pipeline import Pipeline, make_pipeline
from sklearn.preprocessing import FunctionTransformer, PolynomialFeatures, StandardScaler

from robobt.shots.predict.batched import Recipe
from robobt.shots.predict.features import kiks_features, motion_features, paper_features
from robobt.shots.predict.network_classifier import NetworkClassifier
from robobt.shots.predict.networks import KIKS


def table_one() -> Pipeline:
    """Return the paper's network (Table 1) on its five inputs, in millimetres as the author fed it."""
    return make_pipeline(FunctionTransformer(paper_features), NetworkClassifier())


def kiks() -> Pipeline:
    """Return Naito et al.'s network on speed of the shot, opponent's distance and angle."""
    return make_pipeline(FunctionTransformer(kiks_features), NetworkClassifier(Recipe(KIKS)))


def logistic() -> Pipeline:
    """Return the paper's linear logistic regression: liblinear on the raw millimetres and radians."""
    return make_pipeline(FunctionTransformer(paper_features), LogisticRegression(solver="liblinear"))


def logistic_standardised() -> Pipeline:
    """Return the same on standardised inputs, which is all it lacked against the network."""
    return make_pipeline(FunctionTransformer(paper_features), StandardScaler(), LogisticRegression())


def best_predictor() -> Pipeline:
    """Return what predicts best from a few hundred shots: quadratic logistic regression on b, x, L, v.

    To fit it on the author's training shots and predict others::

        train, test = read_shots("train.csv"), read_shots("test.csv")
        model = best_predictor().fit(shot_inputs(train), goals(train))
        p = model.predict_proba(shot_inputs(test))[:, 1]

    Chosen by 10 x 10 cross-validation on the real 542 training shots among logistic
    models of degree 1 to 3, a network, a Gaussian process, a physical race of ball and
    goalkeeper, and blends of them: none had a log-loss that was lower by more than its
    spread over the repeats. An opponent's speed that was not recorded counts as the median.
    """
    return make_pipeline(
        FunctionTransformer(motion_features),
        SimpleImputer(strategy="median", keep_empty_features=True),
        StandardScaler(),
        PolynomialFeatures(2, include_bias=False),
        LogisticRegression(C=3.0, max_iter=1000),
    )


PREDICTORS: Mapping[str, Callable[[], Pipeline]] = {
    "table_one": table_one,
    "kiks": kiks,
    "logistic": logistic,
    "logistic_standardised": logistic_standardised,
    "best": best_predictor,
}
"""Functions without arguments that return an unfitted estimator, by name."""
