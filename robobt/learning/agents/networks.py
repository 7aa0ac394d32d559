"""Actor and critic: small networks that take raw observations in SI units."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from itertools import pairwise
from typing import Literal, NotRequired, TypedDict

import numpy as np
import torch
from numpy.typing import NDArray
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
        layers.append(_linear(fan_in, fan_out, generator))
        if i < len(sizes) - 2:
            if layer_norm:
                layers.append(nn.LayerNorm(fan_out))
            layers.append(nn.ReLU() if activation == "relu" else nn.Tanh())
    return nn.Sequential(*layers)


class ActorBuild(TypedDict):
    """The arguments of an :class:`Actor`, as its file holds them."""

    scale: list[float]
    actions: int
    hidden: list[int]
    layer_norm: bool
    activation: NotRequired[Activation]
    vectors: NotRequired[list[int]]


class Actor(nn.Module):
    """The deterministic policy: observation -> action in [-1, 1].

    The observation is scaled inside, so that the exported module takes what
    :mod:`robobt.world.features` makes, unchanged.

    ``scale`` (observation,) is the typical size of each entry in its SI unit, ``hidden`` the sizes of the
    hidden layers; ``layer_norm``, ``generator`` and ``activation`` are as for :func:`mlp`.

    ``vectors`` are the entries at which vectors (x, y) in the robot's frame begin. If there are any, the
    network works in the frame in which the first vector points ahead: its inputs are turned into that frame,
    and the velocity at the beginning of its action is turned back, so it acts the same in every heading. The
    velocity is then clipped to length 1 in any direction.

    Attributes:
        build: the arguments that make an actor of the same shape.
    """

    inverse_scale: Tensor

    def __init__(
        self,
        scale: Sequence[float],
        actions: int,
        hidden: Sequence[int],
        layer_norm: bool = False,
        generator: torch.Generator | None = None,
        activation: Activation = "relu",
        vectors: Sequence[int] = (),
    ) -> None:
        super().__init__()
        self.build: ActorBuild = {
            "scale": [float(size) for size in scale],
            "actions": actions,
            "hidden": list(hidden),
            "layer_norm": layer_norm,
            "activation": activation,
        }
        if vectors:
            self.build["vectors"] = list(vectors)
        self._vectors = list(vectors)
        self.register_buffer("inverse_scale", 1.0 / torch.tensor(list(scale), dtype=torch.float32))
        self.body = mlp([len(scale), *hidden, actions], layer_norm, generator, activation)

    def forward(self, observation: Tensor) -> Tensor:
        """Map (..., observation) in SI units to (..., action) in [-1, 1]."""
        output = self.body(self.turned(observation) * self.inverse_scale)
        return self.turned_back(observation, torch.tanh(output))

    def turned(self, observation: Tensor) -> Tensor:
        """Return the observation (..., observation) with its vectors turned, before scaling."""
        if not self._vectors:
            return observation
        c, s = self._ahead(observation)
        parts, done = [], 0
        for k in self._vectors:
            x, y = observation[..., k], observation[..., k + 1]
            parts += [observation[..., done:k], torch.stack([c * x + s * y, c * y - s * x], -1)]
            done = k + 2
        return torch.cat([*parts, observation[..., done:]], -1)

    def turned_back(self, observation: Tensor, action: Tensor) -> Tensor:
        """Return the action (..., action) with its velocity turned back into the robot's frame."""
        if not self._vectors:
            return action
        c, s = self._ahead(observation)
        x, y = action[..., 0], action[..., 1]
        shortened = 1.0 / torch.sqrt((x * x + y * y).clamp(min=1.0))
        turned = torch.stack([(c * x - s * y) * shortened, (s * x + c * y) * shortened], -1)
        return torch.cat([turned, action[..., 2:]], -1)

    def _ahead(self, observation: Tensor) -> tuple[Tensor, Tensor]:
        x, y = observation[..., self._vectors[0]], observation[..., self._vectors[0] + 1]
        length = torch.sqrt((x * x + y * y).clamp(min=1e-12))
        return x / length, y / length


class Critic(nn.Module):
    """One or several independent estimates of the return of (observation, action).

    Each is one value, or the logits of a distribution over ``outputs`` atoms; ``heads`` is the number of
    estimates, two for TD3. The other arguments are as for :class:`Actor`.
    """

    inverse_scale: Tensor

    def __init__(
        self,
        scale: Sequence[float],
        actions: int,
        hidden: Sequence[int],
        outputs: int = 1,
        heads: int = 1,
        layer_norm: bool = False,
        generator: torch.Generator | None = None,
    ) -> None:
        super().__init__()
        self.register_buffer("inverse_scale", 1.0 / torch.tensor(list(scale), dtype=torch.float32))
        sizes = [len(scale) + actions, *hidden, outputs]
        self.heads = nn.ModuleList([mlp(sizes, layer_norm, generator) for _ in range(heads)])

    def forward(self, observation: Tensor, action: Tensor) -> Tensor:
        """Map (batch, observation) and (batch, action) to (heads, batch, outputs)."""
        both = torch.cat([observation * self.inverse_scale, action], -1)
        return torch.stack([head(both) for head in self.heads])

    def first(self, observation: Tensor, action: Tensor) -> Tensor:
        """Map to the first estimate alone, (batch, outputs), which the actor maximises."""
        output: Tensor = self.heads[0](torch.cat([observation * self.inverse_scale, action], -1))
        return output


@contextmanager
def one_thread() -> Iterator[None]:
    """Let torch use one thread in the block: with networks this small more threads only wait."""
    before = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(before)


def policy_of(actor: nn.Module) -> Callable[[NDArray[np.float64]], NDArray[np.float64]]:
    """Return an actor as a function of numpy arrays: (n, observation) -> (n, action)."""

    def decide(observation: NDArray[np.float64]) -> NDArray[np.float64]:
        with torch.no_grad():
            action: Tensor = actor(torch.from_numpy(observation.astype(np.float32)))
        return np.asarray(action.numpy(), dtype=np.float64)

    return decide


def _linear(fan_in: int, fan_out: int, generator: torch.Generator | None) -> nn.Linear:
    """Build PyTorch's default layer with weights from our generator instead of the process's."""
    layer: nn.Linear = nn.utils.skip_init(nn.Linear, fan_in, fan_out)  # type: ignore[no-untyped-call]
    bound = fan_in**-0.5
    with torch.no_grad():
        layer.weight.uniform_(-bound, bound, generator=generator)
        layer.bias.uniform_(-bound, bound, generator=generator)
    return layer
