"""A limit on how many samples an estimator learns from."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from sklearn.base import BaseEstimator, ClassifierMixin, clone
from sklearn.utils import get_tags
from sklearn.utils.validation import check_is_fitted, validate_data

from robobt.shots.predict.network_classifier import binary_labels
from robobt.statistics import stratified_hold_out
from robobt.world.geometry import FloatArray


class Subsampled(ClassifierMixin, BaseEstimator):  # type: ignore[misc]
    """Fits a classifier to so many samples at most, drawn at random in equal shares of both classes.

    For models whose time grows steeply with the data, or that gain nothing from more of it.

    Args:
        estimator: the classifier.
        most: samples at most; all are used where there are no more.
        random_state: what the draw follows from.

    Attributes:
        estimator_: the fitted clone.
        classes_: the two labels.
    """

    def __init__(self, estimator: Any, most: int = 2000, random_state: int = 0) -> None:
        self.estimator = estimator
        self.most = most
        self.random_state = random_state

    def fit(self, X: ArrayLike, y: ArrayLike) -> Subsampled:  # noqa: N803
        """Draw and fit; whether X may lack values is the classifier's to say."""
        inputs, given = validate_data(self, X, y, dtype=np.float64, ensure_all_finite="allow-nan")
        labels = binary_labels(self, given)
        if len(labels) > self.most:
            rng = np.random.default_rng(self.random_state)
            drawn = stratified_hold_out(labels, self.most / len(labels), rng).test
            inputs, given = inputs[drawn], given[drawn]
        self.estimator_ = clone(self.estimator).fit(inputs, given)
        return self

    def predict_proba(self, X: ArrayLike) -> FloatArray:  # noqa: N803
        """Probabilities (n, 2) of the labels in the order of ``classes_``."""
        check_is_fitted(self)
        return np.asarray(self.estimator_.predict_proba(X), dtype=np.float64)

    def predict(self, X: ArrayLike) -> NDArray[Any]:  # noqa: N803
        """The likelier label of each sample, (n,)."""
        check_is_fitted(self)
        return np.asarray(self.estimator_.predict(X))

    def __sklearn_tags__(self) -> Any:
        tags = super().__sklearn_tags__()
        tags.classifier_tags.multi_class = False
        tags.input_tags.allow_nan = get_tags(self.estimator).input_tags.allow_nan
        return tags
