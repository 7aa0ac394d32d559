"""A network that treats robots of one kind as a set, so that neither their number nor their order matters.

Each robot is encoded by a small network that its whole kind shares, together with what the observing robot
knows of itself and the ball. Of the codes of a kind, the largest and the mean of each entry go on; empty
places count as nobody. So the weights are the same for any number of places.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import torch
from torch import Tensor, nn

from robobt.learning.agents.layers import linear, mlp
from robobt.world.observation import Group

ENCODER_WIDTH, CODE_SIZE = 32, 24
"""Units of an encoder's hidden layer, and entries of its code."""


class EntityNetwork(nn.Module):
    """A multilayer perceptron behind an encoder for each kind of robot.

    Args:
        scale: (observation,) typical size of each entry.
        groups: the kinds, in the order of the observation.
        hidden: sizes of the hidden layers behind the encoders, with tanh.
        outputs: size of the output.
        generator: draws the weights; None for the global one.

    Attributes:
        encoders: one for each kind.
        head: the layers behind them.
    """

    empty: Tensor

    def __init__(
        self,
        scale: Sequence[float],
        groups: Sequence[Group],
        hidden: Sequence[int],
        outputs: int,
        generator: torch.Generator | None,
    ) -> None:
        super().__init__()
        self._groups = [Group(*group) for group in groups]
        spans = [(group.first, group.first + group.places * len(group.empty)) for group in self._groups]
        self._rest = list(pairwise([0, *(edge for span in spans for edge in span), len(scale)]))[::2]
        own = sum(end - first for first, end in self._rest)
        self.encoders = nn.ModuleList([Encoder(own, len(group.empty), generator) for group in self._groups])
        self.head = mlp([own + 2 * CODE_SIZE * len(groups), *hidden, outputs], False, generator, "tanh")
        # What an empty place looks like once it is scaled, computed in the same way.
        raw = torch.zeros(len(scale))
        for group, (first, end) in zip(self._groups, spans, strict=True):
            raw[first:end] = torch.tensor(list(group.empty) * group.places)
        self.register_buffer("empty", raw * (1.0 / torch.tensor(list(scale))), persistent=False)

    def forward(self, scaled: Tensor) -> Tensor:
        """Map the scaled observation (..., observation) to (..., outputs)."""
        own = torch.cat([scaled[..., first:end] for first, end in self._rest], -1)
        parts = [own]
        for group, encoder in zip(self._groups, self.encoders, strict=True):
            first, size = group.first, len(group.empty)
            if group.places == 0:
                # Nobody, but the encoder stays in the graph, so that its weights have gradients: 0.
                nobody = torch.zeros_like(own[..., :1]).unsqueeze(-2)
                parts.append(encoder(own, nobody.expand(*own.shape[:-1], 1, size), nobody))
                continue
            end = first + group.places * size
            others = scaled[..., first:end].reshape(*scaled.shape[:-1], group.places, size)
            empty = self.empty[first : first + size]
            parts.append(encoder(own, others, (others != empty).to(scaled.dtype).amax(-1, keepdim=True)))
        output: Tensor = self.head(torch.cat(parts, -1))
        return output


class Encoder(nn.Module):
    """Encodes each robot of a kind and pools the codes.

    ``own`` is the number of entries on the observing robot, ``each`` that of every other robot; weights come
    from ``generator``.
    """

    def __init__(self, own: int, each: int, generator: torch.Generator | None) -> None:
        super().__init__()
        self.own = linear(own, ENCODER_WIDTH, generator)
        self.other = linear(each, ENCODER_WIDTH, generator)
        self.code = linear(ENCODER_WIDTH, CODE_SIZE, generator)

    def forward(self, own: Tensor, others: Tensor, there: Tensor) -> Tensor:
        """Pool the codes: (..., own), (..., count, each), and 1 where it is there, else 0 (..., count, 1)."""
        hidden = torch.relu(self.own(own).unsqueeze(-2) + self.other(others))
        # Codes are never negative, so the zeros of the absent do not change the largest.
        code = torch.relu(self.code(hidden)) * there
        mean = code.sum(-2) / there.sum(-2).clamp(min=1.0)
        return torch.cat([code.amax(-2), mean], -1)
