"""A shot as a race: the ball against the goalkeeper, to the point where he crosses its line."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import minimize
from sklearn.base import BaseEstimator, ClassifierMixin, TransformerMixin
from sklearn.utils.validation import check_is_fitted, validate_data

from robobt.shots.predict.network_classifier import binary_labels, probabilities
from robobt.world.geometry import FloatArray


class Prior(NamedTuple):
    """What a constant is likely to be before any shot: a typical value and its spread."""

    value: float
    spread: float


PRIORS = {
    "log_ball_speed": Prior(np.log(6.5), 0.3),
    "log_top_speed": Prior(np.log(1.2), 0.3),
    "log_acceleration": Prior(np.log(5.0), 0.5),
    "delay": Prior(0.05, 0.1),
    "offset": Prior(-2.0, 5.0),
    "log_sharpness": Prior(np.log(15.0), 1.0),
    "per_target_distance": Prior(0.0, 3.0),
    "per_opponent_distance": Prior(0.0, 3.0),
}
"""Constants of the model and where their search begins; logarithms of m/s, m/s^2 and 1/m, seconds, 1/m.

A shot leaves at 6 to 7 m/s and slows down a little; RoboBulls' goalkeeper drives at
about 1.1 m/s and brakes and starts at several m/s^2.
"""


def reach(xp: Any, time: Any, speed: Any, top_speed: float, acceleration: float) -> Any:
    """How far a robot gets in a time when it accelerates to its top speed [m].

    Args:
        xp: numpy or torch.
        time: (...) from now, not negative [s].
        speed: (...) its speed now, in the direction asked for [m/s].
        top_speed, acceleration: [m/s], [m/s^2]; one that is faster keeps its speed.
    """
    speeding = xp.minimum(time, _positive(xp, (top_speed - speed) / acceleration))
    steady = speed + acceleration * speeding
    return speed * speeding + acceleration / 2.0 * speeding * speeding + steady * (time - speeding)


class PhysicsMargin(ClassifierMixin, BaseEstimator):  # type: ignore[misc]
    """The margin by which the goalkeeper misses the ball, through a logistic curve.

    The ball needs x / ball speed + delay to the point of its line nearest to the
    goalkeeper; in that time he gets as far as :func:`reach` says; what is left of b
    is the margin. The logit is linear in it, in L and in x. All constants are fitted
    at once by maximum posterior with :data:`PRIORS`, so that few shots suffice, and
    they keep their meaning where no shot was recorded.

    X is the feature vector ``motion``: b, x, L [m] and v [m/s].

    Args:
        trust: weight of the priors; 0 fits the data alone.

    Attributes:
        constants_: by the names of :data:`PRIORS`.
        classes_: the two labels.
    """

    def __init__(self, trust: float = 1.0) -> None:
        self.trust = trust

    def fit(self, X: ArrayLike, y: ArrayLike) -> PhysicsMargin:  # noqa: N803
        """Find the constants.

        Raises:
            ValueError: X has not four columns, or y not two labels.
        """
        inputs, given = validate_data(self, X, y, dtype=np.float64)
        labels = binary_labels(self, given)
        if inputs.shape[1] != 4:
            raise ValueError(f"X has {inputs.shape[1]} columns, not b, x, L and v")
        typical = np.array([prior.value for prior in PRIORS.values()])
        spread = np.array([prior.spread for prior in PRIORS.values()])

        def unlikelihood(values: FloatArray) -> float:
            logits = margin_logits(np, inputs, dict(zip(PRIORS, values, strict=True)))
            misfit = np.sum(np.logaddexp(0.0, logits) - labels * logits)
            return float(misfit + self.trust / 2.0 * np.sum(((values - typical) / spread) ** 2))

        found = minimize(unlikelihood, typical, method="L-BFGS-B")
        self.constants_ = dict(zip(PRIORS, found.x.tolist(), strict=True))
        return self

    def decision_function(self, X: ArrayLike) -> FloatArray:  # noqa: N803
        """Logits (n,) of the greater label."""
        check_is_fitted(self)
        inputs = validate_data(self, X, reset=False, dtype=np.float64)
        return np.asarray(margin_logits(np, inputs, self.constants_))

    def predict_proba(self, X: ArrayLike) -> FloatArray:  # noqa: N803
        """Probabilities (n, 2) of the labels in the order of ``classes_``."""
        return probabilities(self.decision_function(X))

    def predict(self, X: ArrayLike) -> NDArray[Any]:  # noqa: N803
        """The likelier label of each shot, (n,)."""
        likelier = (self.decision_function(X) >= 0.0).astype(int)
        return np.asarray(self.classes_[likelier])

    def __sklearn_tags__(self) -> Any:
        tags = super().__sklearn_tags__()
        tags.classifier_tags.multi_class = False
        return tags


class MarginFeatures(TransformerMixin, BaseEstimator):  # type: ignore[misc]
    """The margin of :class:`PhysicsMargin`, x and L [m], for whatever classifier comes next.

    X is the feature vector ``motion``. The constants of the race are fitted to y.
    """

    def fit(self, X: ArrayLike, y: ArrayLike) -> MarginFeatures:  # noqa: N803
        """Find the constants; errors as for :class:`PhysicsMargin`."""
        self.race_ = PhysicsMargin().fit(X, y)
        return self

    def transform(self, X: ArrayLike) -> FloatArray:  # noqa: N803
        """(n, 4) to (n, 3)."""
        check_is_fitted(self)
        inputs = np.asarray(X, dtype=np.float64)
        return np.asarray(margin_features(np, inputs, self.race_.constants_))


def margin_features(xp: Any, inputs: Any, constants: dict[str, float]) -> Any:
    """Margin, x and L (..., 3) of inputs (..., 4): b, x, L, v."""
    return xp.stack([_margin(xp, inputs, constants), inputs[..., 1], inputs[..., 2]], -1)


def margin_logits(xp: Any, inputs: Any, constants: dict[str, float]) -> Any:
    """The model's logits (...) of inputs (..., 4): b, x, L, v."""
    return (
        constants["offset"]
        + float(np.exp(constants["log_sharpness"])) * _margin(xp, inputs, constants)
        + constants["per_target_distance"] * (inputs[..., 2] - _TYPICAL_LENGTH)
        + constants["per_opponent_distance"] * (inputs[..., 1] - _TYPICAL_X)
    )


def _margin(xp: Any, inputs: Any, constants: dict[str, float]) -> Any:
    ball_speed, top_speed, acceleration = (
        float(np.exp(constants[f"log_{name}"])) for name in ("ball_speed", "top_speed", "acceleration")
    )
    time = _positive(xp, inputs[..., 1] / ball_speed + constants["delay"])
    return inputs[..., 0] - reach(xp, time, inputs[..., 3], top_speed, acceleration)


def _positive(xp: Any, value: Any) -> Any:
    """The value, or 0 where it is negative; of what numpy, torch and exported models have in common."""
    return xp.maximum(value, value * 0.0)


_TYPICAL_LENGTH = 3.2
_TYPICAL_X = 2.8
