"""The small networks that judge shots, as PyTorch modules."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal, NamedTuple

import torch
from torch import Tensor, nn

Activation = Literal["relu", "swish", "linear"]

NORM_EPS = 1e-3
NORM_MOMENTUM = 0.01
"""Keras' batch normalisation in PyTorch's words; the paper used Keras' defaults."""


class Layer(NamedTuple):
    """A dense layer, with batch normalisation of its inputs or without."""

    normalised: bool
    units: int
    activation: Activation


TABLE_ONE = (Layer(True, 6, "relu"), Layer(True, 3, "swish"), Layer(False, 1, "linear"))
"""The paper's network (Table 1); the sigmoid that ends it is part of the loss."""

KIKS = (Layer(True, 8, "relu"), Layer(True, 8, "relu"), Layer(True, 1, "linear"))
"""Three dense layers with batch normalisation (Naito et al.); their sizes are not published."""


class KerasNorm(nn.BatchNorm1d):
    """Batch normalisation with Keras' moving variance: a batch's own, not an unbiased estimate.

    Of sixteen samples that is 6 % less, and what the network learns depends on it.
    """

    def forward(self, x: Tensor) -> Tensor:
        """Normalise (batch, features)."""
        if not self.training:
            return super().forward(x)
        assert self.running_mean is not None
        assert self.running_var is not None
        with torch.no_grad():
            variance, mean = torch.var_mean(x, 0, correction=0)
            self.running_mean.lerp_(mean, NORM_MOMENTUM)
            self.running_var.lerp_(variance, NORM_MOMENTUM)
        return nn.functional.batch_norm(x, None, None, self.weight, self.bias, training=True, eps=self.eps)


class ShotNetwork(nn.Module):
    """A network of :class:`Layer`; answers the logit of a goal.

    Kernels are Glorot-uniform and biases zero, as Keras draws them.

    Args:
        inputs: length of the input.
        layers: its layers; the last has one unit.
        generator: where the weights come from; None for zeros, to be filled in.
    """

    def __init__(
        self, inputs: int, layers: tuple[Layer, ...] = TABLE_ONE, generator: torch.Generator | None = None
    ) -> None:
        super().__init__()
        self.inputs = inputs
        self.layers = layers
        self.norms = nn.ModuleList()
        self.dense = nn.ModuleList()
        width = inputs
        for layer in layers:
            norm = KerasNorm(width, NORM_EPS, NORM_MOMENTUM) if layer.normalised else nn.Identity()
            self.norms.append(norm)
            dense = nn.Linear(width, layer.units)
            nn.init.zeros_(dense.bias)
            nn.init.zeros_(dense.weight)
            if generator is not None:
                nn.init.xavier_uniform_(dense.weight, generator=generator)
            self.dense.append(dense)
            width = layer.units

    def forward(self, x: Tensor) -> Tensor:
        """Logits (batch,) of inputs (batch, inputs)."""
        for layer, norm, dense in zip(self.layers, self.norms, self.dense, strict=True):
            x = dense(norm(x))
            if layer.activation == "relu":
                x = torch.relu(x)
            elif layer.activation == "swish":
                x = x * torch.sigmoid(x)
        return x.squeeze(-1)


def network_from_keras(layers: Mapping[str, Mapping[str, Any]]) -> ShotNetwork:
    """The network of Table 1 with weights as Keras stores them (kernels [in][out]).

    Args:
        layers: by Keras' names, ``batch_normalization``, ``dense``,
            ``batch_normalization_1``, ``dense_1``, ``dense_2``.

    Raises:
        ValueError: a layer is missing or has another shape.
    """

    def values(layer: str, name: str) -> Tensor:
        try:
            return torch.tensor(layers[layer][name], dtype=torch.float32)
        except (KeyError, TypeError, ValueError) as error:
            raise ValueError(f"no weights {name!r} of layer {layer!r}") from error

    state = {}
    for i, name in enumerate(("dense", "dense_1", "dense_2")):
        state[f"dense.{i}.weight"] = values(name, "kernel").T
        state[f"dense.{i}.bias"] = values(name, "bias")
    for i, name in enumerate(("batch_normalization", "batch_normalization_1")):
        state[f"norms.{i}.weight"] = values(name, "gamma")
        state[f"norms.{i}.bias"] = values(name, "beta")
        state[f"norms.{i}.running_mean"] = values(name, "moving_mean")
        state[f"norms.{i}.running_var"] = values(name, "moving_variance")
        state[f"norms.{i}.num_batches_tracked"] = torch.tensor(0)
    network = ShotNetwork(5, TABLE_ONE)
    try:
        network.load_state_dict(state)
    except RuntimeError as error:
        raise ValueError(" ".join(str(error).split())) from error
    return network.eval()
