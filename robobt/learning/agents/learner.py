"""What all learners share: Adam over whole networks, means for the log, and a state to save and restore."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn
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


_COUNT = ".count"


class Diagnostics:
    """Sums and counts by name, from which :meth:`means` are computed for the log."""

    def __init__(self) -> None:
        self._sums: dict[str, Tensor] = {}
        self._counts: dict[str, int] = {}

    def add(self, **values: Tensor) -> None:
        """Add one value of each name; the tensors are scalars without a gradient."""
        for name, value in values.items():
            if name in self._sums:
                self._sums[name] += value
                self._counts[name] += 1
            else:
                self._sums[name], self._counts[name] = value.clone(), 1

    def means(self) -> dict[str, float]:
        """Return the mean of each name since :meth:`clear`."""
        return {name: float(total) / self._counts[name] for name, total in self._sums.items()}

    def clear(self) -> None:
        """Forget all values."""
        self._sums.clear()
        self._counts.clear()

    def state(self) -> dict[str, NDArray[np.generic]]:
        """Return the state for a resumed run, as arrays by name."""
        counts = {f"{name}{_COUNT}": np.array(count) for name, count in self._counts.items()}
        return {**{name: total.numpy().copy() for name, total in self._sums.items()}, **counts}

    def restore(self, state: Mapping[str, NDArray[np.generic]]) -> None:
        """Take over the :meth:`state` of another one."""
        self._sums = {
            name: torch.from_numpy(np.array(value))
            for name, value in state.items()
            if not name.endswith(_COUNT)
        }
        self._counts = {name: int(state[f"{name}{_COUNT}"].item()) for name in self._sums}


class Learner(ABC):
    """An actor and a critic with their optimisers.

    Attributes:
        updates: number of updates so far.
        diagnostics: losses, gradient norms and so on of the updates since they were last logged.
    """

    _actor_adam: Adam
    _critic_adam: Adam

    def __init__(self) -> None:
        self.updates = 0
        self.diagnostics = Diagnostics()

    @abstractmethod
    def _modules(self) -> tuple[tuple[str, nn.Module], ...]:
        """Return all networks by the names under which they are saved."""

    def set_learning_rates(self, fraction: float) -> None:
        """Set both learning rates to ``fraction`` of those in the settings."""
        for optimiser in (self._actor_adam, self._critic_adam):
            optimiser.set_learning_rate(fraction)

    def state(self) -> dict[str, NDArray[np.generic]]:
        """Return weights, optimisers and the number of updates as arrays by name."""
        return {"updates": np.array([self.updates]), **state_of(self._modules(), self._optimisers())}

    def restore(self, state: Mapping[str, NDArray[np.generic]]) -> None:
        """Restore the :meth:`state` of another learner.

        Raises:
            KeyError: it belongs to a learner with other settings.
            RuntimeError: a network has other shapes.
        """
        self.updates = int(state["updates"].tolist()[0])
        restore_state(state, self._modules(), self._optimisers())

    def _optimisers(self) -> tuple[tuple[str, Adam], ...]:
        return (("actor_adam", self._actor_adam), ("critic_adam", self._critic_adam))
