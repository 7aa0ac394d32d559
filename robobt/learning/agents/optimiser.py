"""Adam over a whole network, and the state of networks and optimisers for checkpoints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor
from torch.optim.adam import adam


class Adam:
    """Adam over all weights of a network, by torch's own function of one step, in fused calls.

    torch's class of that name takes the same steps, bit for bit, but the first object of it imports torch's
    compiler, a second of processor time, and each step looks for options that are never set here.

    Args:
        weights: the weights that it changes.
        learning_rate: step size at first.
        decay: L2 regularisation, added to the gradients.
        eps: added to the root of the second moment.

    Attributes:
        weights: as given.
        learning_rate: as given.
        rate: the present step size.
        moments: of each weight the number of steps and both moments, by the names that torch uses.
    """

    def __init__(
        self, weights: list[torch.nn.Parameter], learning_rate: float, decay: float = 0.0, eps: float = 1e-8
    ) -> None:
        self.weights = weights
        self.learning_rate = self.rate = learning_rate
        self.moments = {
            "step": [torch.zeros(()) for _ in weights],
            "exp_avg": [torch.zeros_like(weight, requires_grad=False) for weight in weights],
            "exp_avg_sq": [torch.zeros_like(weight, requires_grad=False) for weight in weights],
        }
        self._decay, self._eps = decay, eps

    @torch.no_grad()
    def step(self, gradients: Sequence[Tensor]) -> None:
        """Take a step along gradients."""
        adam(
            [*self.weights],
            list(gradients),
            self.moments["exp_avg"],
            self.moments["exp_avg_sq"],
            [],
            self.moments["step"],
            fused=True,
            amsgrad=False,
            beta1=0.9,
            beta2=0.999,
            lr=self.rate,
            weight_decay=self._decay,
            eps=self._eps,
            maximize=False,
        )

    def clipped_step(self, gradients: Sequence[Tensor], max_grad_norm: float) -> Tensor:
        """Take a step along gradients clipped to ``max_grad_norm``; return their norm before clipping."""
        gradients = list(gradients)
        norm: Tensor = torch.linalg.vector_norm(torch.stack(torch._foreach_norm(gradients)))
        share = (max_grad_norm / (norm + 1e-6)).clamp(max=1.0)
        self.step(torch._foreach_mul(gradients, share))
        return norm

    def set_learning_rate(self, fraction: float) -> None:
        """Set the learning rate to ``fraction`` of the initial one."""
        self.rate = self.learning_rate * fraction


def state_of(
    modules: Sequence[tuple[str, torch.nn.Module]], optimisers: Sequence[tuple[str, Adam]]
) -> dict[str, NDArray[np.generic]]:
    """Return weights and moments as arrays by name."""
    state: dict[str, NDArray[np.generic]] = {}
    for name, module in modules:
        state |= {f"{name}.{key}": tensor.numpy() for key, tensor in module.state_dict().items()}
    for name, optimiser in optimisers:
        for index in range(len(optimiser.weights)):
            for key, tensors in optimiser.moments.items():
                state[f"{name}.{index}.{key}"] = tensors[index].numpy()
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
        for key, tensors in optimiser.moments.items():
            for index, tensor in enumerate(tensors):
                # One that had taken no step yet was written without moments.
                given = state.get(f"{name}.{index}.{key}")
                tensor.copy_(torch.zeros_like(tensor) if given is None else torch.from_numpy(given))
