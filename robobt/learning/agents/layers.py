"""Layers of networks, with weights from a given generator."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any, Literal

import torch
from torch import Tensor, nn

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
            layers.append(nn.ReLU() if activation == "relu" else Tanh())
    return nn.Sequential(*layers)


def linear(fan_in: int, fan_out: int, generator: torch.Generator | None) -> nn.Linear:
    """Build PyTorch's default layer with weights from our generator instead of the process's."""
    # Its own weights are dropped, and the process's generator is left alone. With nn.utils.skip_init, which
    # makes none, torch imports sympy, 0.3 s.
    with torch.random.fork_rng(devices=[]):
        layer = nn.Linear(fan_in, fan_out)
    bound = fan_in**-0.5
    with torch.no_grad():
        layer.weight.uniform_(-bound, bound, generator=generator)
        layer.bias.uniform_(-bound, bound, generator=generator)
    return layer


class Tanh(nn.Module):
    """tanh(x) as 2 sigmoid(2 x) - 1, within 2e-7 of it.

    torch's own tanh is that of Intel's library, which takes as long for a layer of 96 units as the layer's
    product on a processor of another maker; its sigmoid is quick on all.
    """

    def forward(self, x: Tensor) -> Tensor:
        """Return tanh of each entry."""
        exporting = torch.jit.is_tracing()  # type: ignore[attr-defined, no-untyped-call]
        if torch.is_grad_enabled() and x.requires_grad and not exporting:
            result: Tensor = _Tanh.apply(x)  # type: ignore[no-untyped-call]
            return result
        return torch.sigmoid(x + x) * 2.0 - 1.0


class _Tanh(torch.autograd.Function):
    """The same with its derivative, 1 - tanh(x)^2, from the result."""

    @staticmethod
    def forward(ctx: Any, x: Tensor) -> Tensor:
        result = (x + x).sigmoid_().mul_(2.0).sub_(1.0)
        ctx.save_for_backward(result)
        return result

    @staticmethod
    def backward(ctx: Any, gradient: Tensor) -> Tensor:
        (result,) = ctx.saved_tensors
        lost = gradient * result
        return torch.addcmul(gradient, lost, result, value=-1.0, out=lost)
