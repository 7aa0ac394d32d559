"""Adam over a whole network, and the state of networks and optimisers for checkpoints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor


class Adam:
    """Adam (Kingma & Ba, 2015) over all weights of a network, in fused calls.

    Its steps are those of ``torch.optim.Adam(..., fused=True)`` bit for bit. The first object of that class
    imports torch's compiler, 0.7 s, of which there is no use here.

    Args:
        weights: the weights that it changes; it overwrites their gradients.
        learning_rate: step size.
        decay: L2 regularisation, added to the gradients.
        eps: added to the root of the second moment.

    Attributes:
        rate: the present learning rate.
    """

    def __init__(
        self, weights: list[torch.nn.Parameter], learning_rate: float, decay: float = 0.0, eps: float = 1e-8
    ) -> None:
        self.weights = weights
        self.learning_rate = self.rate = learning_rate
        self._decay, self._eps = decay, eps
        for weight in weights:
            weight.grad = torch.zeros_like(weight)
        self._gradients = [weight.grad for weight in weights if weight.grad is not None]
        self._moments = {
            "step": [torch.zeros(()) for _ in weights],
            "exp_avg": [torch.zeros_like(weight) for weight in weights],
            "exp_avg_sq": [torch.zeros_like(weight) for weight in weights],
        }

    def step(self, gradients: Sequence[Tensor]) -> None:
        """Take a step along gradients."""
        torch._foreach_copy_(self._gradients, list(gradients))
        self._step()

    def clipped_step(self, gradients: Sequence[Tensor], max_grad_norm: float) -> Tensor:
        """Take a step along gradients clipped to ``max_grad_norm``; return their norm before clipping."""
        torch._foreach_copy_(self._gradients, list(gradients))
        norm = torch.nn.utils.clip_grad_norm_(self.weights, max_grad_norm)
        self._step()
        return norm

    @torch.no_grad()
    def _step(self) -> None:
        first, second, steps = (self._moments[name] for name in ("exp_avg", "exp_avg_sq", "step"))
        torch._foreach_add_(steps, 1)
        torch._fused_adam_(
            [*self.weights],
            self._gradients,
            first,
            second,
            [],
            steps,
            lr=self.rate,
            beta1=0.9,
            beta2=0.999,
            weight_decay=self._decay,
            eps=self._eps,
            amsgrad=False,
            maximize=False,
        )

    def set_learning_rate(self, fraction: float) -> None:
        """Set the learning rate to ``fraction`` of the initial one."""
        self.rate = self.learning_rate * fraction

    @property
    def moments(self) -> dict[int, dict[str, Tensor]]:
        """The number of steps and the moments of each weight, by its place; empty before the first step."""
        if not any(self._moments["step"]):
            return {}
        return {
            place: {name: tensors[place] for name, tensors in self._moments.items()}
            for place in range(len(self.weights))
        }

    @torch.no_grad()
    def restore(self, moments: Mapping[int, Mapping[str, Tensor]]) -> None:
        """Go on from :attr:`moments` of another optimiser."""
        for name, tensors in self._moments.items():
            for place, tensor in enumerate(tensors):
                if place in moments:
                    tensor.copy_(moments[place][name])
                else:
                    tensor.zero_()


def state_of(
    modules: Sequence[tuple[str, torch.nn.Module]], optimisers: Sequence[tuple[str, Adam]]
) -> dict[str, NDArray[np.generic]]:
    """Return weights and moments as arrays by name."""
    state: dict[str, NDArray[np.generic]] = {}
    for name, module in modules:
        state |= {f"{name}.{key}": tensor.numpy() for key, tensor in module.state_dict().items()}
    for name, optimiser in optimisers:
        for index, moments in optimiser.moments.items():
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
        optimiser.restore(moments)
