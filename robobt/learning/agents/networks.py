"""Actor and critic: small networks that take raw observations in SI units."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import NotRequired, TypedDict

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from robobt.learning.agents.entities import EntityNetwork
from robobt.learning.agents.layers import Activation, mlp
from robobt.world.observation import Group


class ActorBuild(TypedDict):
    """The arguments of an :class:`Actor`, as its file holds them."""

    scale: list[float]
    actions: int
    hidden: list[int]
    layer_norm: bool
    activation: NotRequired[Activation]
    vectors: NotRequired[list[int]]
    groups: NotRequired[list[tuple[int, int, tuple[float, ...]]]]


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

    ``groups`` are the entries on robots of one kind, which an
    :class:`~robobt.learning.agents.entities.EntityNetwork` treats as sets; without any all entries are
    inputs of one multilayer perceptron.

    Attributes:
        build: the arguments that make an actor of the same shape.
        groups: the entries that are treated as sets.
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
        groups: Sequence[tuple[int, int, tuple[float, ...]]] = (),
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
        self.groups = tuple([Group(*group) for group in groups])
        if groups:
            self.build["groups"] = [(*group,) for group in self.groups]
        self._vectors = list(vectors)
        self.register_buffer("inverse_scale", 1.0 / torch.tensor(list(scale), dtype=torch.float32))
        self.body = body_of(scale, hidden, actions, layer_norm, generator, activation, self.groups)

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


def body_of(
    scale: Sequence[float],
    hidden: Sequence[int],
    outputs: int,
    layer_norm: bool = False,
    generator: torch.Generator | None = None,
    activation: Activation = "relu",
    groups: Sequence[Group] = (),
) -> nn.Sequential | EntityNetwork:
    """Build the layers from scaled observations to ``outputs``; the rest as for :class:`Actor`."""
    if groups:
        return EntityNetwork(scale, groups, hidden, outputs, generator)
    return mlp([len(scale), *hidden, outputs], layer_norm, generator, activation)


def resized(actor: Actor, scale: Sequence[float], groups: Sequence[Group]) -> Actor:
    """Return an actor with the same weights for other numbers of places.

    Args:
        actor: an actor that treats robots as sets.
        scale: (observation,) typical size of each entry of the other observation.
        groups: the other observation's places.

    Raises:
        ValueError: it treats nothing as a set, or the observations differ in more than these numbers.
    """
    if not actor.groups:
        raise ValueError("its network is not that of entities, so it serves one number of robots only")
    ours, others = (_sizes(*pair) for pair in ((actor.build["scale"], actor.groups), (list(scale), groups)))
    if any(mine != its for mine, its in zip(ours, others, strict=True) if mine and its):
        raise ValueError("it observes entries of other kinds or scales")
    build: ActorBuild = {**actor.build, "scale": list(scale), "groups": [(*group,) for group in groups]}
    made = Actor(**build)
    made.load_state_dict({**actor.state_dict(), "inverse_scale": made.inverse_scale})
    return made


def _sizes(scale: list[float], groups: Sequence[Group]) -> list[list[float]]:
    """Return the scales of the entries outside the groups, and of a place of each group, if there are any."""
    places = [scale[at : at + len(empty)] if count else [] for at, count, empty in groups]
    rest = list(scale)
    for at, count, empty in reversed(groups):
        del rest[at : at + count * len(empty)]
    return [rest, *places]


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
