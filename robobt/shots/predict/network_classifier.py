"""The shot networks under scikit-learn's contract."""

from __future__ import annotations

import copy
from collections.abc import Sequence

import numpy as np
import torch
from numpy.typing import ArrayLike, NDArray
from scipy.special import expit
from sklearn.base import BaseEstimator, ClassifierMixin, clone
from sklearn.model_selection import train_test_split
from sklearn.utils import Tags
from sklearn.utils.multiclass import check_classification_targets
from sklearn.utils.validation import check_is_fitted, validate_data

from robobt.shots.predict.batched import Recipe, TrainingSet, train_networks
from robobt.world.geometry import FloatArray


class NetworkClassifier(ClassifierMixin, BaseEstimator):  # type: ignore[misc]
    """A small network with batch normalisation, trained with the paper's recipe.

    Part of the training data is held out, in equal shares of both classes, to decide
    when to stop.

    No ``recipe`` is the paper's; ``hold_out`` is a share of the data, which, the weights and the order of
    samples follow from ``random_state``.

    Attributes:
        network_: the trained :class:`~robobt.shots.predict.networks.ShotNetwork`.
        classes_: the two labels.
    """

    def __init__(self, recipe: Recipe | None = None, hold_out: float = 0.33, random_state: int = 0) -> None:
        self.recipe = recipe
        self.hold_out = hold_out
        self.random_state = random_state

    def fit(self, X: ArrayLike, y: ArrayLike) -> NetworkClassifier:  # noqa: N803
        """Train it on X (n, F) and two labels y (n,), the greater of which is predicted; return itself."""
        self.network_ = train_networks([self._task(X, y, None)], self.recipe or Recipe())[0]
        return self

    def fit_many(
        self, sets: Sequence[tuple[ArrayLike, ArrayLike]], held_out: ArrayLike | None = None
    ) -> list[NetworkClassifier]:
        """Return clones, each trained on a set of its own, all at once.

        Args:
            sets: X (n, F) and y (n,) for each; the i-th clone draws from ``random_state + i``.
            held_out: (n,) which samples of every set to hold out instead of random ones.
        """
        clones: list[NetworkClassifier] = [
            clone(self).set_params(random_state=self.random_state + i) for i in range(len(sets))
        ]
        tasks = [one._task(X, y, held_out) for one, (X, y) in zip(clones, sets, strict=True)]
        for one, network in zip(clones, train_networks(tasks, self.recipe or Recipe()), strict=True):
            one.network_ = network
        return clones

    def decision_function(self, X: ArrayLike) -> FloatArray:  # noqa: N803
        """Return logits (n,) of the greater label for X (n, F)."""
        check_is_fitted(self)
        inputs = validate_data(self, X, reset=False, dtype=np.float64)
        # In single precision an answer would depend a little on the others in the batch.
        network = copy.deepcopy(self.network_).double()
        with torch.inference_mode():
            return np.asarray(network(torch.from_numpy(inputs))[:, 0].numpy())

    def predict_proba(self, X: ArrayLike) -> FloatArray:  # noqa: N803
        """Return probabilities (n, 2) of the labels for X (n, F), in the order of ``classes_``."""
        logits = self.decision_function(X)
        return np.stack([expit(-logits), expit(logits)], axis=-1)

    def predict(self, X: ArrayLike) -> NDArray[np.generic]:  # noqa: N803
        """Return the likelier label (n,) of each sample of X (n, F)."""
        likelier = (self.decision_function(X) >= 0.0).astype(int)
        return np.asarray(self.classes_[likelier])

    def _task(self, X: ArrayLike, y: ArrayLike, held_out: ArrayLike | None) -> TrainingSet:  # noqa: N803
        inputs, given = validate_data(self, X, y, dtype=np.float32)
        check_classification_targets(given)
        self.classes_, labels = np.unique(given, return_inverse=True)
        if len(self.classes_) != 2:
            raise ValueError(
                "Only binary classification is supported. The type of the target is "
                f"{len(self.classes_)} classes."
                if len(self.classes_) > 2
                else "NetworkClassifier needs samples of 2 classes, not of one class only"
            )
        if held_out is None:
            held = np.zeros(len(labels), dtype=bool)
            draw = {"test_size": self.hold_out, "random_state": self.random_state, "stratify": labels}
            held[train_test_split(np.arange(len(labels)), **draw)[1]] = True
        else:
            held = np.asarray(held_out, dtype=bool)
            if held.shape != labels.shape or held.all() or not held.any():
                raise ValueError("held_out must name some of the samples, and not all")
        x, t = torch.tensor(inputs), torch.tensor(labels, dtype=torch.float32)
        return TrainingSet(x[~held], t[~held], x[held], t[held], self.random_state)

    def __sklearn_tags__(self) -> Tags:
        tags = super().__sklearn_tags__()
        tags.classifier_tags.multi_class = False
        return tags
