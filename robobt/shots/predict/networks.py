"""The small networks that judge shots, as PyTorch modules."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Literal, NamedTuple

import torch
from torch import Tensor, nn
from torch.nn.functional import silu

from robobt.shots.data.schema import ShotDataError

NORM_EPS = 1e-3
NORM_MOMENTUM = 0.01
"""Keras' defaults of batch normalisation, which the paper used, under PyTorch's names."""


class Layer(NamedTuple):
    """A dense layer, with or without batch normalisation of its inputs."""

    normalised: bool
    units: int
    activation: Literal["relu", "silu", "linear"]

    def activate(self, x: Tensor) -> Tensor:
        """Return the activation of ``x``, element by element."""
        if self.activation == "relu":
            return torch.relu(x)
        return silu(x) if self.activation == "silu" else x


TABLE_ONE = (Layer(True, 6, "relu"), Layer(True, 3, "silu"), Layer(False, 1, "linear"))
"""The paper's network (Table 1); the sigmoid that ends it is part of the loss."""


class ShotNetwork(nn.Module):
    """A network of :class:`Layer` that answers the logit of a goal.

    Kernels are Glorot-uniform and biases zero, as Keras draws them.
    :func:`~robobt.shots.predict.batched.train_networks` trains it.

    The last of ``layers`` has one unit; weights come from ``generator``, without one they are zeros, to be
    filled in.
    """

    def __init__(
        self, inputs: int, layers: tuple[Layer, ...] = TABLE_ONE, generator: torch.Generator | None = None
    ) -> None:
        super().__init__()
        self.layers = layers
        self.norms = nn.ModuleList()
        self.dense = nn.ModuleList()
        width = inputs
        for layer in layers:
            self.norms.append(nn.BatchNorm1d(width, NORM_EPS) if layer.normalised else nn.Identity())
            dense = nn.Linear(width, layer.units)
            nn.init.zeros_(dense.bias)
            nn.init.zeros_(dense.weight)
            if generator is not None:
                nn.init.xavier_uniform_(dense.weight, generator=generator)
            self.dense.append(dense)
            width = layer.units
        self.eval()

    def forward(self, x: Tensor) -> Tensor:
        """Return logits (batch, 1) of inputs (batch, inputs)."""
        for layer, norm, dense in zip(self.layers, self.norms, self.dense, strict=True):
            x = layer.activate(dense(norm(x)))
        return x

    def probabilities(self) -> nn.Module:
        """Return a module of probabilities (batch, 1), with plain arithmetic for the normalisations."""
        plain = copy.deepcopy(self)
        for i, (norm, dense) in enumerate(zip(plain.norms, plain.dense, strict=True)):
            if isinstance(norm, nn.BatchNorm1d) and isinstance(dense, nn.Linear):
                assert norm.running_mean is not None
                assert norm.running_var is not None
                with torch.no_grad():
                    scale = norm.weight / torch.sqrt(norm.running_var + norm.eps)
                    dense.bias.add_(dense.weight @ (norm.bias - norm.running_mean * scale))
                    dense.weight.mul_(scale)
                plain.norms[i] = nn.Identity()
        return nn.Sequential(plain, nn.Sigmoid())


def author_network(path: str | Path) -> ShotNetwork:
    """Load the predictor that the paper's author published (``author_predictor.json``).

    Its weights are stored as Keras names and shapes them, kernels as [input][output].

    Raises:
        ShotDataError: the file does not hold the weights of Table 1's network.
    """
    file = Path(path)
    network = ShotNetwork(5, TABLE_ONE)
    state = {}
    try:
        layers = json.loads(file.read_text(encoding="utf-8"))["layers"]
        for i, name in enumerate(("dense", "dense_1", "dense_2")):
            state[f"dense.{i}.weight"] = torch.tensor(layers[name]["kernel"]).T
            state[f"dense.{i}.bias"] = torch.tensor(layers[name]["bias"])
        for i, name in enumerate(("batch_normalization", "batch_normalization_1")):
            state[f"norms.{i}.weight"] = torch.tensor(layers[name]["gamma"])
            state[f"norms.{i}.bias"] = torch.tensor(layers[name]["beta"])
            state[f"norms.{i}.running_mean"] = torch.tensor(layers[name]["moving_mean"])
            state[f"norms.{i}.running_var"] = torch.tensor(layers[name]["moving_variance"])
            state[f"norms.{i}.num_batches_tracked"] = torch.tensor(0)
        network.load_state_dict(state)
    except (OSError, ValueError, KeyError, TypeError, RuntimeError) as error:
        reason = " ".join(str(error).split())
        raise ShotDataError(f"{file}: does not hold the author's network: {reason}") from error
    return network
