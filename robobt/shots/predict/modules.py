"""Fitted predictors as PyTorch modules, to be exported."""

from __future__ import annotations

from typing import Any

import numpy as np
import torch
from sklearn.linear_model import LogisticRegression
from sklearn.pipeline import Pipeline
from sklearn.preprocessing import PolynomialFeatures, StandardScaler
from torch import Tensor, nn

from robobt.shots.predict.features import FEATURES, ShotFeatures
from robobt.shots.predict.network_classifier import NetworkClassifier
from robobt.shots.predict.networks import ShotNetwork
from robobt.shots.predict.physics_margin import (
    MarginFeatures,
    PhysicsMargin,
    margin_features,
    margin_logits,
)
from robobt.shots.predict.set_network import SetNetworkClassifier
from robobt.world.features import SCENE_HEAD, SCENE_OPPONENTS


def as_module(fitted: Any) -> nn.Module:
    """A fitted predictor as a module from shots' scenes (batch, 34) to probabilities of a goal (batch, 1).

    A predictor of one opponent judges all of a scene; the worst of them counts, and
    one behind the shooter counts as none, as the paper has it. The module consists
    of nothing but the arithmetic that :func:`robobt.models.export.export_model`
    lets pass; for its card the observation is
    :data:`~robobt.world.features.SHOT_SCENE` and the kind ``shot_predictor``.

    Raises:
        TypeError: a predictor, or a step of one, that has no such form: those that
            remember their training shots (Gaussian processes, and blends with them).
    """
    steps = [step for _, step in fitted.steps] if isinstance(fitted, Pipeline) else [fitted]
    if len(steps) == 1 and isinstance(steps[0], SetNetworkClassifier):
        return _Whole(steps[0].network_)
    if not isinstance(steps[0], ShotFeatures):
        raise TypeError(f"{type(fitted).__name__} has no form as a module")
    return _Pairwise(steps[0].name, [_step(step) for step in steps[1:]])


class _Whole(nn.Module):
    def __init__(self, network: nn.Module) -> None:
        super().__init__()
        self.network = network

    def forward(self, scenes: Tensor) -> Tensor:
        return torch.sigmoid(self.network(scenes)).unsqueeze(-1)


class _Pairwise(nn.Module):
    """Each opponent judged by itself, the worst counts."""

    def __init__(self, features: str, steps: list[nn.Module]) -> None:
        super().__init__()
        self.features = features
        self.steps = nn.Sequential(*steps)

    def forward(self, scenes: Tensor) -> Tensor:
        head = scenes[:, :SCENE_HEAD].unsqueeze(1) + torch.zeros(SCENE_OPPONENTS, 1)
        block = scenes[:, SCENE_HEAD:].reshape(-1, SCENE_OPPONENTS, 4)
        inputs = FEATURES[self.features](torch, head, block)
        p = torch.sigmoid(self.steps(inputs).reshape(-1, SCENE_OPPONENTS))
        ahead = torch.clamp(torch.sign(block[:, :, 0]), 0.0, 1.0)
        return torch.min(1.0 - (1.0 - p) * ahead, 1, keepdim=True)[0]


class _Affine(nn.Module):
    """Entries scaled and shifted one by one."""

    scale: Tensor
    shift: Tensor

    def __init__(self, scale: Any, shift: Any) -> None:
        super().__init__()
        self.register_buffer("scale", torch.as_tensor(np.asarray(scale), dtype=torch.float32))
        self.register_buffer("shift", torch.as_tensor(np.asarray(shift), dtype=torch.float32))

    def forward(self, x: Tensor) -> Tensor:
        return x * self.scale + self.shift


class _Products(nn.Module):
    """Products of powers of entries, in scikit-learn's order; up to squares."""

    def __init__(self, powers: Any) -> None:
        super().__init__()
        self.factors = [[i for i, power in enumerate(row) for _ in range(int(power))] for row in powers]

    def forward(self, x: Tensor) -> Tensor:
        columns = []
        for factors in self.factors:
            product = x[..., factors[0]]
            for factor in factors[1:]:
                product = product * x[..., factor]
            columns.append(product)
        return torch.stack(columns, -1)


class _Function(nn.Module):
    def __init__(self, function: Any, constants: dict[str, float]) -> None:
        super().__init__()
        self.function, self.constants = function, constants

    def forward(self, x: Tensor) -> Tensor:
        answer: Tensor = self.function(torch, x, self.constants)
        return answer


def _step(step: Any) -> nn.Module:
    if isinstance(step, StandardScaler):
        return _Affine(1.0 / step.scale_, -step.mean_ / step.scale_)
    if isinstance(step, PolynomialFeatures) and not step.include_bias:
        return _Products(step.powers_)
    if isinstance(step, MarginFeatures):
        return _Function(margin_features, step.race_.constants_)
    if isinstance(step, PhysicsMargin):
        return _Function(margin_logits, step.constants_)
    if isinstance(step, NetworkClassifier):
        return _without_norms(step.network_)
    if isinstance(step, LogisticRegression):
        linear = nn.Linear(step.coef_.shape[1], 1)
        with torch.no_grad():
            linear.weight.copy_(torch.as_tensor(step.coef_))
            linear.bias.copy_(torch.as_tensor(np.broadcast_to(step.intercept_, (1,)).copy()))
        return linear
    raise TypeError(f"{type(step).__name__} has no form as a module")


def _without_norms(network: ShotNetwork) -> nn.Module:
    """The network with its settled normalisations as plain arithmetic."""
    plain = ShotNetwork(network.inputs, network.layers)
    plain.dense.load_state_dict(network.dense.state_dict())
    with torch.no_grad():
        for i, norm in enumerate(network.norms):
            if isinstance(norm, nn.BatchNorm1d):
                assert norm.running_mean is not None
                assert norm.running_var is not None
                scale = norm.weight / torch.sqrt(norm.running_var + norm.eps)
                plain.norms[i] = _Affine(scale, norm.bias - norm.running_mean * scale)
    return plain.eval()
