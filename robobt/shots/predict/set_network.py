"""A network that sees all opponents of a shot at once."""

from __future__ import annotations

from typing import Any

import numpy as np
import torch
from numpy.typing import ArrayLike, NDArray
from sklearn.base import BaseEstimator, ClassifierMixin
from sklearn.utils.validation import check_is_fitted, validate_data
from torch import Tensor, nn

from robobt.shots.predict.network_classifier import binary_labels, probabilities
from robobt.statistics import stratified_hold_out
from robobt.world.features import SCENE_HEAD, SCENE_OPPONENTS, SHOT_SCENE
from robobt.world.geometry import FloatArray

_FARTHEST = 10.0
"""Lengths beyond say nothing more [m]; it keeps empty places of a scene within the numbers of real ones."""

_ODD = (1, 3, 5, 7, 9)
"""Entries of a scene's head that change sign when the scene is mirrored at the line of the shot."""


class SetNetwork(nn.Module):
    """Logit of a goal from a shot's scene (batch, 34), whatever the order of its opponents.

    Each opponent is described together with the shot, as seen from the side of the
    line that it stands on, so that a mirrored scene is the same scene. Descriptions
    go through one network; their sum and their maximum, with what does not depend
    on an opponent, go through another. Opponents behind the shooter do not count.

    Args:
        hidden: width of the layers.
        generator: where the weights come from.
    """

    def __init__(self, hidden: int, generator: torch.Generator | None = None) -> None:
        super().__init__()
        pair, alone = SCENE_HEAD + 4, SCENE_HEAD
        self.register_buffer("pair_mean", torch.zeros(pair))
        self.register_buffer("pair_spread", torch.ones(pair))
        self.each = nn.Sequential(nn.Linear(pair, hidden), nn.ReLU(), nn.Linear(hidden, hidden), nn.ReLU())
        self.all = nn.Sequential(
            nn.Linear(2 * hidden + alone, hidden),
            nn.ReLU(),
            nn.Linear(hidden, hidden),
            nn.ReLU(),
            nn.Linear(hidden, 1),
        )
        odd = torch.zeros(SCENE_HEAD)
        odd[list(_ODD)] = 1.0
        self.register_buffer("odd", odd)
        for layer in [*self.each, *self.all]:
            if isinstance(layer, nn.Linear):
                nn.init.kaiming_uniform_(layer.weight, nonlinearity="relu", generator=generator)
                nn.init.zeros_(layer.bias)

    def describe(self, scenes: Tensor) -> tuple[Tensor, Tensor]:
        """Descriptions (batch, 6, 14) before they are scaled, and which count (batch, 6, 1)."""
        head = scenes[:, :SCENE_HEAD].unsqueeze(1)
        block = scenes[:, SCENE_HEAD:].reshape(-1, SCENE_OPPONENTS, 4)
        across = block[:, :, 1:2]
        side = torch.sign(across)
        odd: Tensor = self.odd  # type: ignore[assignment]
        mirrored = head * (1.0 - odd) + head * odd * side
        parts = [mirrored, block[:, :, 0:1], across * side, block[:, :, 2:3], -side * block[:, :, 3:4]]
        counts = torch.clamp(torch.sign(block[:, :, 0:1]), 0.0, 1.0)
        return torch.clamp(torch.cat(parts, -1), -_FARTHEST, _FARTHEST), counts

    def forward(self, scenes: Tensor) -> Tensor:
        """Logits (batch,)."""
        pairs, counts = self.describe(scenes)
        mean: Tensor = self.pair_mean  # type: ignore[assignment]
        spread: Tensor = self.pair_spread  # type: ignore[assignment]
        said = self.each((pairs - mean) / spread) * counts
        # What does not change when the scene is mirrored.
        odd: Tensor = self.odd  # type: ignore[assignment]
        head = scenes[:, :SCENE_HEAD]
        even = (head * (1.0 - odd) + torch.abs(head) * odd - mean[:SCENE_HEAD]) / spread[:SCENE_HEAD]
        together = torch.cat([said.sum(1), torch.max(said, 1)[0], even], -1)
        answer: Tensor = self.all(together)
        return answer.squeeze(-1)


class SetNetworkClassifier(ClassifierMixin, BaseEstimator):  # type: ignore[misc]
    """:class:`SetNetwork` under scikit-learn's contract.

    Trained with Adam on the cross-entropy, its rate falling along a cosine; the
    weights of the epoch with the least loss on held-out shots are kept. X is the
    scene of each shot, (n, 34); an entry of its head that is not known
    (not-a-number) counts as its mean over the training data.

    Args:
        hidden: width of the layers.
        epochs: passes over the data.
        batch: shots a step.
        rate: learning rate of the first step.
        weight_decay: of Adam (decoupled).
        hold_out: share of the data to hold out.
        random_state: what the hold-out, the weights and the order of shots follow from.

    Attributes:
        network_: the trained :class:`SetNetwork`.
        classes_: the two labels.
    """

    def __init__(
        self,
        hidden: int = 32,
        epochs: int = 40,
        batch: int = 512,
        rate: float = 3e-3,
        weight_decay: float = 1e-3,
        hold_out: float = 0.1,
        random_state: int = 0,
    ) -> None:
        self.hidden = hidden
        self.epochs = epochs
        self.batch = batch
        self.rate = rate
        self.weight_decay = weight_decay
        self.hold_out = hold_out
        self.random_state = random_state

    def fit(self, X: ArrayLike, y: ArrayLike) -> SetNetworkClassifier:  # noqa: N803
        """Train it.

        Raises:
            ValueError: X is not (n, 34), lacks the state of opponents, or y has not two labels.
        """
        scenes, given = validate_data(self, X, y, dtype=np.float32, ensure_all_finite="allow-nan")
        if scenes.shape[1] != SHOT_SCENE.size:
            raise ValueError(f"X has {scenes.shape[1]} columns, a shot's scene has {SHOT_SCENE.size}")
        labels = binary_labels(self, given)
        known = np.isfinite(scenes)
        self.typical_ = np.where(known, scenes, 0.0).sum(0) / np.maximum(known.sum(0), 1)
        x = self._filled(scenes)
        fold = stratified_hold_out(labels, self.hold_out, np.random.default_rng([self.random_state, 1]))
        generator = torch.Generator().manual_seed(self.random_state)
        network = SetNetwork(self.hidden, generator)
        targets = torch.tensor(labels, dtype=torch.float32)
        train, held = torch.from_numpy(fold.train), torch.from_numpy(fold.test)
        with torch.no_grad():
            pairs, counts = network.describe(x[train])
            seen = pairs[counts[..., 0] > 0] if bool(counts.any()) else pairs.flatten(0, 1)
            network.pair_mean.copy_(seen.mean(0))  # type: ignore[operator]
            network.pair_spread.copy_(seen.std(0, correction=0).clamp_min(1e-3))  # type: ignore[operator]
        self._descend(network, (x[train], targets[train]), (x[held], targets[held]), generator)
        self.network_ = network.eval()
        return self

    def _descend(
        self,
        network: SetNetwork,
        train: tuple[Tensor, Tensor],
        held: tuple[Tensor, Tensor],
        generator: torch.Generator,
    ) -> None:
        inputs, labels = train
        loss_of = nn.BCEWithLogitsLoss()
        adam = torch.optim.AdamW(network.parameters(), self.rate, weight_decay=self.weight_decay)
        steps = self.epochs * -(-len(inputs) // self.batch)
        schedule = torch.optim.lr_scheduler.CosineAnnealingLR(adam, steps)
        best, state = float("inf"), network.state_dict()
        for _ in range(self.epochs):
            for chosen in torch.split(torch.randperm(len(inputs), generator=generator), self.batch):
                adam.zero_grad(set_to_none=True)
                loss_of(network(inputs[chosen]), labels[chosen]).backward()
                adam.step()
                schedule.step()
            with torch.no_grad():
                loss = float(loss_of(network(held[0]), held[1]))
            if loss < best:
                best = loss
                state = {name: value.clone() for name, value in network.state_dict().items()}
        network.load_state_dict(state)

    def decision_function(self, X: ArrayLike) -> FloatArray:  # noqa: N803
        """Logits (n,) of the greater label.

        Raises:
            ValueError: X lacks the state of opponents.
        """
        check_is_fitted(self)
        scenes = validate_data(self, X, reset=False, dtype=np.float32, ensure_all_finite="allow-nan")
        with torch.inference_mode():
            return np.asarray(self.network_(self._filled(scenes)).numpy(), dtype=np.float64)

    def predict_proba(self, X: ArrayLike) -> FloatArray:  # noqa: N803
        """Probabilities (n, 2) of the labels in the order of ``classes_``."""
        return probabilities(self.decision_function(X))

    def predict(self, X: ArrayLike) -> NDArray[Any]:  # noqa: N803
        """The likelier label of each shot, (n,)."""
        likelier = (self.decision_function(X) >= 0.0).astype(int)
        return np.asarray(self.classes_[likelier])

    def _filled(self, scenes: NDArray[np.float32]) -> Tensor:
        if np.isnan(scenes[:, SCENE_HEAD:]).any():
            raise ValueError("X lacks the state of opponents")
        return torch.from_numpy(np.where(np.isnan(scenes), self.typical_, scenes).astype(np.float32))

    def __sklearn_tags__(self) -> Any:
        tags = super().__sklearn_tags__()
        tags.classifier_tags.multi_class = False
        tags.input_tags.allow_nan = True
        return tags
