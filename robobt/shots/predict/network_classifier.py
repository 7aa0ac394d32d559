"""The shot networks under scikit-learn's contract."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import torch
from numpy.typing import ArrayLike, NDArray
from sklearn.base import BaseEstimator, ClassifierMixin, clone
from sklearn.utils.multiclass import check_classification_targets
from sklearn.utils.validation import check_is_fitted, validate_data

from robobt.shots.predict.batched import train_networks
from robobt.shots.predict.networks import TABLE_ONE, Layer
from robobt.shots.predict.recipe import Recipe, Task
from robobt.statistics import stratified_hold_out
from robobt.world.geometry import FloatArray


class NetworkClassifier(ClassifierMixin, BaseEstimator):  # type: ignore[misc]
    """A small network with batch normalisation, trained with the paper's recipe.

    Part of the training data is held out, in equal shares of both classes, to tell
    when to stop.

    Args:
        layers: its layers.
        hold_out: share of the data to hold out.
        warm_up: epochs before it may stop.
        epochs: at most how many follow.
        patience: for how many of them the held-out loss need not improve.
        random_state: what the hold-out, the weights and the order of samples follow from.

    Attributes:
        network_: the trained :class:`~robobt.shots.predict.networks.ShotNetwork`.
        classes_: the two labels.
    """

    def __init__(
        self,
        layers: tuple[Layer, ...] = TABLE_ONE,
        hold_out: float = 0.33,
        warm_up: int = 64,
        epochs: int = 512,
        patience: int = 50,
        random_state: int = 0,
    ) -> None:
        self.layers = layers
        self.hold_out = hold_out
        self.warm_up = warm_up
        self.epochs = epochs
        self.patience = patience
        self.random_state = random_state

    def fit(self, X: ArrayLike, y: ArrayLike, held_out: ArrayLike | None = None) -> NetworkClassifier:  # noqa: N803
        """Train it.

        Args:
            X: (n, F).
            y: (n,) two labels; the greater one is the one predicted.
            held_out: (n,) which samples to hold out instead of random ones.
        """
        task = self._task(X, y, held_out)
        self.network_ = train_networks([task], self._recipe())[0]
        return self

    def fit_many(
        self, sets: Sequence[tuple[ArrayLike, ArrayLike]], held_out: ArrayLike | None = None
    ) -> list[NetworkClassifier]:
        """Clones of it, each trained on a set of its own, all at once.

        The i-th draws from ``random_state + i``. ``held_out`` is as for :meth:`fit`,
        one for all sets.
        """
        clones: list[NetworkClassifier] = []
        for i, _ in enumerate(sets):
            clones.append(clone(self).set_params(random_state=self.random_state + i))
        tasks = [one._task(X, y, held_out) for one, (X, y) in zip(clones, sets, strict=True)]
        for one, network in zip(clones, train_networks(tasks, self._recipe()), strict=True):
            one.network_ = network
        return clones

    def decision_function(self, X: ArrayLike) -> FloatArray:  # noqa: N803
        """Logits (n,) of the greater label."""
        check_is_fitted(self)
        inputs = validate_data(self, X, reset=False, dtype=np.float32)
        with torch.inference_mode():
            return np.asarray(self.network_(torch.from_numpy(inputs)).numpy(), dtype=np.float64)

    def predict_proba(self, X: ArrayLike) -> FloatArray:  # noqa: N803
        """Probabilities (n, 2) of the labels in the order of ``classes_``."""
        return probabilities(self.decision_function(X))

    def predict(self, X: ArrayLike) -> NDArray[Any]:  # noqa: N803
        """The likelier label of each sample, (n,)."""
        likelier = (self.decision_function(X) >= 0.0).astype(int)
        return np.asarray(self.classes_[likelier])

    def _task(self, X: ArrayLike, y: ArrayLike, held_out: ArrayLike | None) -> Task:  # noqa: N803
        inputs, given = validate_data(self, X, y, dtype=np.float32)
        labels = binary_labels(self, given)
        # An own stream: what is held out has nothing to do with weights and order.
        rng = np.random.default_rng([self.random_state, 1])
        if held_out is None:
            fold = stratified_hold_out(labels, self.hold_out, rng)
            held = np.zeros(len(labels), dtype=bool)
            held[fold.test] = True
        else:
            held = np.asarray(held_out, dtype=bool)
            if held.shape != labels.shape or held.all() or not held.any():
                raise ValueError("held_out must name some of the samples, and not all")
        x, t = torch.tensor(inputs), torch.tensor(labels, dtype=torch.float32)
        return Task(x[~held], t[~held], x[held], t[held], self.random_state)

    def _recipe(self) -> Recipe:
        return Recipe(tuple(self.layers), warm_up=self.warm_up, epochs=self.epochs, patience=self.patience)

    def __sklearn_tags__(self) -> Any:
        tags = super().__sklearn_tags__()
        tags.classifier_tags.multi_class = False
        return tags


def binary_labels(estimator: Any, y: NDArray[Any]) -> NDArray[np.int64]:
    """Labels as 0 and 1; sets the estimator's ``classes_``.

    Raises:
        ValueError: not two labels.
    """
    check_classification_targets(y)
    classes, labels = np.unique(y, return_inverse=True)
    if len(classes) > 2:
        raise ValueError(
            f"Only binary classification is supported. The type of the target is {len(classes)} classes."
        )
    if len(classes) < 2:
        raise ValueError(f"{type(estimator).__name__} needs samples of 2 classes, not of one class only")
    estimator.classes_ = classes
    return np.asarray(labels, dtype=np.int64)


def probabilities(logits: FloatArray) -> FloatArray:
    """Logits (n,) as probabilities (n, 2)."""
    from scipy.special import expit

    return np.stack([expit(-logits), expit(logits)], axis=-1)
