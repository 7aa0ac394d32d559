"""Layers of networks, with weights from a given generator."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any, Literal

import torch
from torch import Tensor, nn

Activation = Literal["relu", "tanh"]

_MANY_ROWS = 512
"""From this number of rows on oneDNN is quicker than torch's own products."""

# What torch's compiler puts in place of a linear layer; a torch without oneDNN has none.
_onednn: Any = None
if torch.backends.mkldnn.is_available():  # type: ignore[no-untyped-call]
    _onednn = torch.ops.mkldnn._linear_pointwise.default


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
    return TanhPerceptron(*layers) if activation == "tanh" and not layer_norm else nn.Sequential(*layers)


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


class TanhPerceptron(nn.Sequential):
    """Linear layers with tanh between them, which take many rows in fewer and quicker calls."""

    def forward(self, rows: Tensor) -> Tensor:
        """Map (..., inputs) to (..., outputs)."""
        if _onednn is None or rows.ndim != 2 or len(rows) < _MANY_ROWS:
            output: Tensor = super().forward(rows)  # type: ignore[no-untyped-call]
        else:
            weights = [weight for layer in list(self)[::2] for weight in (layer.weight, layer.bias)]
            output = _TanhLayers.apply(rows, *weights)  # type: ignore[no-untyped-call]
        return output


class Tanh(nn.Module):
    """tanh(x) as 2 sigmoid(2 x) - 1, within 2e-7 of it.

    torch's own tanh is that of Intel's library, which takes as long for a layer of 96 units as the layer's
    product on a processor of another maker; its sigmoid is quick on all.
    """

    def forward(self, x: Tensor) -> Tensor:
        """Return tanh of each entry."""
        return torch.sigmoid(x + x) * 2.0 - 1.0


class _TanhLayers(torch.autograd.Function):
    """Linear layers with tanh between them, and their gradients, by oneDNN.

    Its products use all of a processor, where Intel's library, which torch takes otherwise, uses half of one
    of another maker.
    """

    @staticmethod
    def forward(ctx: Any, rows: Tensor, *weights: Tensor) -> Tensor:
        inputs = [rows]
        for weight, bias in zip(weights[:-2:2], weights[1:-2:2], strict=True):
            inputs.append(_product(inputs[-1], weight.t(), bias, "tanh"))
        ctx.save_for_backward(*inputs, *weights[::2])
        return torch.addmm(weights[-1], inputs[-1], weights[-2].t())

    @staticmethod
    def backward(ctx: Any, slope: Tensor) -> tuple[Tensor | None, ...]:
        saved, gradients = ctx.saved_tensors, []
        for layer in reversed(range(len(saved) // 2)):
            rows, weight = saved[layer], saved[layer - len(saved) // 2]
            # The first factor is copied if it is transposed, so the smaller one is. Adam needs whole rows.
            if rows.shape[1] < slope.shape[1]:
                gradients += [slope.sum(0), _product(rows.t(), slope).t().contiguous()]
            else:
                gradients += [slope.sum(0), _product(slope.t(), rows)]
            if layer > 0:
                slope = _product(slope, weight)
                torch.ops.aten.tanh_backward.grad_input(slope, rows, grad_input=slope)
        before = _product(slope, saved[len(saved) // 2]) if ctx.needs_input_grad[0] else None
        return before, *reversed(gradients)


def _product(first: Tensor, second: Tensor, bias: Tensor | None = None, then: str = "none") -> Tensor:
    """Return first @ second + bias, or tanh of this if it comes then."""
    result: Tensor = _onednn(first, second.t(), bias, then, [], "")
    return result
