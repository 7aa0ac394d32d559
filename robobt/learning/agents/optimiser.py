"""Adam over a whole network, and the state of networks and optimisers for checkpoints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor


class Adam:
    """Adam over all weights of a network, in fused calls."""

    def __init__(
        self, weights: list[torch.nn.Parameter], learning_rate: float, decay: float = 0.0, eps: float = 1e-8
    ) -> None:
        self.weights = weights
        self.learning_rate = learning_rate
        self.adam = torch.optim.Adam(weights, lr=learning_rate, weight_decay=decay, eps=eps, fused=True)
        for weight in weights:
            weight.grad = torch.zeros_like(weight)
        self._gradients = [weight.grad for weight in weights if weight.grad is not None]

    def step(self, gradients: Sequence[Tensor]) -> None:
        """Take a step along gradients."""
        torch._foreach_copy_(self._gradients, list(gradients))
        self.adam.step()

    def clipped_step(self, gradients: Sequence[Tensor], max_grad_norm: float) -> Tensor:
        """Take a step along gradients clipped to ``max_grad_norm``; return their norm before clipping."""
        torch._foreach_copy_(self._gradients, list(gradients))
        norm = torch.nn.utils.clip_grad_norm_(self.weights, max_grad_norm)
        self.adam.step()
        return norm

    def set_learning_rate(self, fraction: float) -> None:
        """Set the learning rate to ``fraction`` of the initial one."""
        for group in self.adam.param_groups:
            group["lr"] = self.learning_rate * fraction


def state_of(
    modules: Sequence[tuple[str, torch.nn.Module]], optimisers: Sequence[tuple[str, Adam]]
) -> dict[str, NDArray[np.generic]]:
    """Return weights and moments as arrays by name."""
    state: dict[str, NDArray[np.generic]] = {}
    for name, module in modules:
        state |= {f"{name}.{key}": tensor.numpy() for key, tensor in module.state_dict().items()}
    for name, optimiser in optimisers:
        for index, moments in optimiser.adam.state_dict()["state"].items():
            state |= {f"{name}.{index}.{key}": tensor.numpy() for key, tensor in moments.items()}
    return {key: array.copy() for key, array in state.items()}


def restore_state(
    state: Mapping[str, NDArray[np.generic]],
    modules: Sequence[tuple[str, torch.nn.Module]],
    optimisers: Sequence[tuple[str, Adam]],
) -> None:
    """Restore what :func:`state_of` returned.

    Raises:
        KeyError: it belongs to other networks.
        RuntimeError: a network has other shapes.
    """
    for name, module in modules:
        module.load_state_dict(
            {key: torch.from_numpy(state[f"{name}.{key}"].copy()) for key in module.state_dict()}
        )
    for name, optimiser in optimisers:
        moments: dict[int, dict[str, Tensor]] = {}
        for key, array in state.items():
            if key.startswith(f"{name}."):
                _, index, entry = key.split(".")
                moments.setdefault(int(index), {})[entry] = torch.from_numpy(array.copy())
        groups = optimiser.adam.state_dict()["param_groups"]
        optimiser.adam.load_state_dict({"state": moments, "param_groups": groups})
