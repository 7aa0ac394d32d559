"""A stack of networks of one shape: their forward and backward passes over a leading axis."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Self

import torch
from torch import Tensor, nn

from robobt.shots.predict.networks import NORM_EPS, NORM_MOMENTUM, Activation, ShotNetwork


class Rows(NamedTuple):
    """Which rows of a batch count, as weights that average over them.

    ``across`` is (N, 1, B) and ``down`` (N, B, 1), the same numbers.
    """

    across: Tensor
    down: Tensor

    @classmethod
    def first(cls, counts: Tensor, width: int) -> Self:
        """The first rows of ``width``: (N,) counts."""
        counts = counts.clamp_max(width)
        weights = (torch.arange(width) < counts[:, None]) / counts[:, None]
        return cls(weights[:, None, :].contiguous(), weights[:, :, None].contiguous())

    def keep(self, members: Tensor) -> Self:
        """The rows of some of the networks."""
        return type(self)(*(part[members] for part in self))


class _Norm:
    """Batch normalisation of N networks at once."""

    def __init__(
        self, gamma: Tensor, beta: Tensor, gradients: tuple[Tensor, Tensor], moments: tuple[Tensor, Tensor]
    ) -> None:
        self.gamma, self.beta = gamma, beta
        self.gamma_gradient, self.beta_gradient = gradients
        self.mean, self.variance = moments

    def forward(self, x: Tensor, rows: Rows) -> Tensor:
        mean = torch.bmm(rows.across, x)
        centred = x - mean
        variance = torch.bmm(rows.across, centred * centred)
        self.mean.lerp_(mean, NORM_MOMENTUM)
        self.variance.lerp_(variance, NORM_MOMENTUM)
        self.inverse = (variance + NORM_EPS).rsqrt_()
        self.scaled = centred.mul_(self.inverse)
        return torch.addcmul(self.beta, self.scaled, self.gamma)

    def backward(self, change: Tensor, rows: Rows, wanted: bool) -> Tensor:
        torch.sum(change, 1, keepdim=True, out=self.beta_gradient)
        torch.sum(change * self.scaled, 1, keepdim=True, out=self.gamma_gradient)
        if not wanted:
            return change
        shared = torch.addcmul(self.beta_gradient, self.scaled, self.gamma_gradient)
        return torch.addcmul(change, shared, rows.down, value=-1.0).mul_(self.gamma * self.inverse)

    def settled(self, x: Tensor) -> Tensor:
        scale = (self.variance + NORM_EPS).rsqrt_().mul_(self.gamma)
        return torch.addcmul(self.beta - self.mean * scale, x, scale)


class _Dense:
    """A dense layer of N networks at once."""

    def __init__(
        self, kernel: Tensor, bias: Tensor, gradients: tuple[Tensor, Tensor], activation: Activation
    ) -> None:
        self.kernel, self.bias = kernel, bias
        self.kernel_gradient, self.bias_gradient = gradients
        self.activation = activation

    def forward(self, x: Tensor) -> Tensor:
        self.input = x
        self.sum = torch.baddbmm(self.bias, x, self.kernel)
        return self.activated(self.sum)

    def activated(self, value: Tensor) -> Tensor:
        if self.activation == "relu":
            return torch.relu(value)
        return nn.functional.silu(value) if self.activation == "swish" else value

    def backward(self, change: Tensor) -> Tensor:
        if self.activation == "relu":
            change = torch.ops.aten.threshold_backward(change, self.sum, 0)
        elif self.activation == "swish":
            change = torch.ops.aten.silu_backward(change, self.sum)
        torch.bmm(self.input.transpose(1, 2), change, out=self.kernel_gradient)
        torch.sum(change, 1, keepdim=True, out=self.bias_gradient)
        return change

    def passed_on(self, change: Tensor) -> Tensor:
        return torch.bmm(change, self.kernel.transpose(1, 2))

    def settled(self, x: Tensor) -> Tensor:
        return self.activated(torch.baddbmm(self.bias, x, self.kernel))


class NetworkStack:
    """N networks of one shape.

    Their weights are one tensor (N, P), so that an optimiser's step is a few
    operations; layers hold views of it. ``gradients`` is laid out alike, and
    ``moments`` (N, M) holds the running means and variances.
    """

    def __init__(self, networks: Sequence[ShotNetwork]) -> None:
        self.pattern = networks[0]
        self.weights = torch.stack([_flat(network.state_dict(), _WEIGHTS) for network in networks])
        self.moments = torch.stack([_flat(network.state_dict(), _MOMENTS) for network in networks])
        self._lay_out()

    def keep(self, members: Tensor) -> None:
        """Drop all networks but these."""
        self.weights, self.moments = self.weights[members], self.moments[members]
        self._lay_out()

    def find_gradients(self, inputs: Tensor, labels: Tensor, rows: Rows) -> None:
        """Gradients of the mean cross-entropy of a batch; running moments move on.

        Args:
            inputs, labels: (N, B, F) and (N, B, 1).
            rows: which of the B rows count.
        """
        x = inputs
        for norm, dense in self.blocks:
            x = dense.forward(norm.forward(x, rows) if norm is not None else x)
        change = torch.sigmoid(x).sub_(labels).mul_(rows.down)
        for place in range(len(self.blocks) - 1, -1, -1):
            norm, dense = self.blocks[place]
            change = dense.backward(change)
            if norm is not None:
                change = norm.backward(dense.passed_on(change), rows, wanted=place > 0)
            elif place > 0:
                change = dense.passed_on(change)

    def loss(self, inputs: Tensor, labels: Tensor, rows: Rows) -> Tensor:
        """Mean cross-entropy (N,) with the running moments; arguments as above."""
        x = inputs
        for norm, dense in self.blocks:
            x = dense.settled(norm.settled(x) if norm is not None else x)
        losses = nn.functional.softplus(x).addcmul_(x, labels, value=-1.0)
        return torch.bmm(rows.across, losses).flatten()

    def network(self, weights: Tensor, moments: Tensor) -> ShotNetwork:
        """A network by itself from its row of weights and moments."""
        # Tensors made in inference mode could never be trained on.
        with torch.inference_mode(False), torch.no_grad():
            network = ShotNetwork(self.pattern.inputs, self.pattern.layers)
            state = network.state_dict()
            for row, kinds in ((weights, _WEIGHTS), (moments, _MOMENTS)):
                begin = 0
                for name in _names(state, kinds):
                    value = _upright(state[name])
                    end = begin + value.numel()
                    value.copy_(row[begin:end].view(value.shape))
                    begin = end
        return network.eval()

    def _lay_out(self) -> None:
        self.gradients = torch.zeros_like(self.weights)
        state = self.pattern.state_dict()
        weights = _views(self.weights, state, _WEIGHTS)
        gradients = _views(self.gradients, state, _WEIGHTS)
        moments = _views(self.moments, state, _MOMENTS)
        self.blocks: list[tuple[_Norm | None, _Dense]] = []
        for i, layer in enumerate(self.pattern.layers):
            gamma, beta = f"norms.{i}.weight", f"norms.{i}.bias"
            kernel, bias = f"dense.{i}.weight", f"dense.{i}.bias"
            norm = None
            if layer.normalised:
                mean, variance = moments[f"norms.{i}.running_mean"], moments[f"norms.{i}.running_var"]
                changes = gradients[gamma], gradients[beta]
                norm = _Norm(weights[gamma], weights[beta], changes, (mean, variance))
            changes = gradients[kernel], gradients[bias]
            self.blocks.append((norm, _Dense(weights[kernel], weights[bias], changes, layer.activation)))


_WEIGHTS = (".weight", ".bias")
_MOMENTS = (".running_mean", ".running_var")


def _names(state: dict[str, Tensor], kinds: tuple[str, ...]) -> list[str]:
    return [name for name in state if name.endswith(kinds)]


def _upright(value: Tensor) -> Tensor:
    """A kernel as (inputs, outputs); vectors as they are."""
    return value.T if value.ndim == 2 else value


def _flat(state: dict[str, Tensor], kinds: tuple[str, ...]) -> Tensor:
    """Values of a network in a row; kernels transposed to (inputs, outputs)."""
    values = [_upright(state[name]).flatten() for name in _names(state, kinds)]
    return torch.cat([torch.zeros(0), *values])


def _views(rows: Tensor, state: dict[str, Tensor], kinds: tuple[str, ...]) -> dict[str, Tensor]:
    """Views (N, inputs, outputs) or (N, 1, width) of rows that are laid out as :func:`_flat` does."""
    views = {}
    begin = 0
    for name in _names(state, kinds):
        value = _upright(state[name])
        end = begin + value.numel()
        shape = tuple(value.shape) if value.ndim == 2 else (1, value.numel())
        views[name] = rows[:, begin:end].view(-1, *shape)
        begin = end
    return views
