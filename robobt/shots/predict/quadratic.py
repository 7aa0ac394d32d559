"""The quadratic logistic regression as a network that rates shots in play."""

from __future__ import annotations

import numpy as np
import torch
from sklearn.pipeline import Pipeline
from torch import Tensor, nn

from robobt.shots.predict.predictors import motion_features
from robobt.world.features import SCENE_HEAD, SCENE_OPPONENTS
from robobt.world.geometry import FloatArray

_BEYOND = 0.5
"""How far beyond the range of what it was fitted on it follows its curves, as a share of that range."""


class QuadraticShot(nn.Module):
    """Probability of a goal from :data:`~robobt.world.features.SHOT_SCENE`: the worst past any opponent.

    The answers are those of :func:`~robobt.shots.predict.predictors.best_predictor` for one
    opponent, but that a goalkeeper nearer to the line never makes a shot better, as a quadratic
    would have it where there were no shots to fit. Far from those it was fitted on its inputs
    count as at the edge.

    Args:
        fitted: the fitted pipeline.
        scenes: the scenes (n, 34) that it was fitted on.
    """

    centre: Tensor
    scale: Tensor
    linear: Tensor
    curve: Tensor
    bias: Tensor
    low: Tensor
    high: Tensor

    def __init__(self, fitted: Pipeline, scenes: FloatArray) -> None:
        super().__init__()
        scaler, regression = fitted.named_steps["standardscaler"], fitted.named_steps["logisticregression"]
        weights = regression.coef_[0]
        size = len(scaler.mean_)
        curve = np.zeros((size, size))
        # Products come in the order of PolynomialFeatures: 00, 01, ..., 11, 12, ...
        curve[np.triu_indices(size)] = weights[size:]
        features = motion_features(scenes)
        least, most = np.nanmin(features, axis=0), np.nanmax(features, axis=0)
        beyond = _BEYOND * (most - least)
        for name, value in (
            ("centre", scaler.mean_),
            ("scale", scaler.scale_),
            ("linear", weights[:size]),
            ("curve", curve),
            ("bias", regression.intercept_),
            ("low", least - beyond),
            ("high", most + beyond),
        ):
            self.register_buffer(name, torch.tensor(np.asarray(value), dtype=torch.float32))

    def forward(self, scenes: Tensor) -> Tensor:
        """Return the probabilities (n, 1) of scenes (n, 34)."""
        block = scenes[:, SCENE_HEAD:].reshape(-1, SCENE_OPPONENTS, 4)
        along, across = block[:, :, 0], block[:, :, 1]
        length = scenes[:, :1] + 0.0 * along
        towards = -torch.sign(across) * block[:, :, 3]
        features = torch.stack([across.abs(), along, length, towards], 2)
        x = (torch.minimum(torch.maximum(features, self.low), self.high) - self.centre) / self.scale
        # Where the parabola falls with the distance from the line, the chance is what it is where it turns.
        turn = -0.5 * (self.linear[0] + x[:, :, 1:] @ self.curve[0, 1:]) / self.curve[0, 0]
        b = x[:, :, 0]
        b = torch.where(self.curve[0, 0] > 0.0, torch.maximum(b, turn), torch.minimum(b, turn))
        x = torch.cat([b.unsqueeze(2), x[:, :, 1:]], 2)
        scores = x @ self.linear + ((x @ self.curve) * x).sum(2) + self.bias
        # A place that is empty lies far behind the shooter.
        scores = scores + torch.relu(-1.0 - along)
        return torch.sigmoid(scores.min(1)[0]).unsqueeze(1)
