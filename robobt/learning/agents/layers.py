"""Layers of networks, with weights from a given generator."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Literal

import torch
from torch import nn

Activation = Literal["relu", "tanh"]


def mlp(
    sizes: Sequence[int],
    layer_norm: bool,
    generator: torch.Generator | None,
    activation: Activation = "relu",
) -> nn.Sequential:
    """Build linear layers with ReLU or tanh between them, initialised as PyTorch does.

    ``sizes`` are those of the input, the hidden layers and the output; ``layer_norm`` normalises each hidden
    layer before its activation. Weights come from ``generator``, None for the global one.
    """
    layers: list[nn.Module] = []
    for i, (fan_in, fan_out) in enumerate(pairwise(sizes)):
        layers.append(linear(fan_in, fan_out, generator))
        if i < len(sizes) - 2:
            if layer_norm:
                layers.append(nn.LayerNorm(fan_out))
            layers.append(nn.ReLU() if activation == "relu" else nn.Tanh())
    return nn.Sequential(*layers)


def linear(fan_in: int, fan_out: int, generator: torch.Generator | None) -> nn.Linear:
    """Build PyTorch's default layer with weights from our generator instead of the process's."""
    layer: nn.Linear = nn.utils.skip_init(nn.Linear, fan_in, fan_out)  # type: ignore[no-untyped-call]
    bound = fan_in**-0.5
    with torch.no_grad():
        layer.weight.uniform_(-bound, bound, generator=generator)
        layer.bias.uniform_(-bound, bound, generator=generator)
    return layer
