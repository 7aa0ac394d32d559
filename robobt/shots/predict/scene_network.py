"""A network that sees every opponent of a shot's scene, and a shot as good as the worst of them leaves it.

It answers for every kind of goalkeeper that it has met: the better a goalkeeper, the less the same scene is
worth.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn

from robobt.world.features import SCENE_HEAD, SCENE_OPPONENTS
from robobt.world.geometry import FloatArray

_INPUTS = 14
_LAYER_WIDTH = 96
_BATCH_SIZE, _FIRST_LEARNING_RATE, _WEIGHT_DECAY = 256, 3e-3, 0.1
"""Of the training: shots a step, learning rate of the first step, AdamW's decay."""

_LARGEST_LOG_ODDS = 4.6
"""Log-odds at most, 99 %: even an open goal is missed now and then."""


class SceneNetwork(nn.Module):
    """Probability of a goal from :data:`~robobt.world.features.SHOT_SCENE`, past each kind of goalkeeper.

    The same small network scores the shot past each opponent; the least score is
    the scene's. So the order of opponents does not matter, one more never makes a
    shot better, and an empty place changes nothing. Seen in a mirror along the line
    of the shot every opponent stands to its left, so that a scene and its mirror
    image get the same answer.

    What the shooter's heading still lacks and where exactly it holds the ball are not
    looked at: simulated shooters hold it in one place, and what is asked about is a
    kick that goes out along the line.

    Args:
        kinds: number of kinds of goalkeepers, K.

    Attributes:
        easier: what is added to the log-odds past each kind, (K,): how much weaker than in training it is.
    """

    mean: Tensor
    scale: Tensor
    easier: Tensor

    def __init__(self, kinds: int = 1) -> None:
        super().__init__()
        self.register_buffer("mean", torch.zeros(_INPUTS))
        self.register_buffer("scale", torch.ones(_INPUTS))
        self.register_buffer("easier", torch.zeros(kinds))
        self.layers = nn.Sequential(
            nn.Linear(_INPUTS, _LAYER_WIDTH),
            nn.SiLU(),
            nn.Linear(_LAYER_WIDTH, _LAYER_WIDTH),
            nn.SiLU(),
            nn.Linear(_LAYER_WIDTH, kinds),
        )

    def inputs(self, scenes: Tensor) -> Tensor:
        """Return what is known about the shot and each opponent, (n, 6, 15), before it is scaled."""
        head = scenes[:, :SCENE_HEAD].unsqueeze(1)
        block = scenes[:, SCENE_HEAD:].reshape(-1, SCENE_OPPONENTS, 4)
        along, across = block[:, :, 0].clamp(-1.0, 9.0), block[:, :, 1].clamp(-4.0, 4.0)
        side = torch.sign(across + 1e-9)
        b = across.abs()
        speed, towards = block[:, :, 2], -side * block[:, :, 3]
        length = head[:, :, 0] + 0.0 * b
        # Lag of the ball: the way at its first speed.
        flight = along.clamp(min=0.0) / 6.5
        parts = [
            length,
            torch.cos(head[:, :, 1]) + 0.0 * b,
            side * torch.sin(head[:, :, 1]),
            head[:, :, 4] + 0.0 * b,
            side * head[:, :, 5],
            along,
            b,
            length - along,
            speed,
            towards,
            b / along.clamp(min=0.1),
            b - towards * flight,
            b - towards * flight - 2.0 * flight * flight,
            torch.sqrt(along * along + b * b),
        ]
        return torch.stack(parts, 2)

    def log_odds(self, scenes: Tensor) -> Tensor:
        """Return the log-odds (n, K) of scenes (n, 34)."""
        scores: Tensor = self.layers((self.inputs(scenes) - self.mean) / self.scale) + self.easier
        # A place that is empty lies far behind the shooter.
        behind = torch.relu(-1.0 - scenes[:, SCENE_HEAD::4]).unsqueeze(2)
        least: Tensor = (scores + behind).clamp(max=_LARGEST_LOG_ODDS).min(1)[0]
        return least

    def forward(self, scenes: Tensor) -> Tensor:
        """Return the probabilities (n, K) of scenes (n, 34)."""
        return torch.sigmoid(self.log_odds(scenes))


def train_scene_network(
    scenes: FloatArray,
    goals: NDArray[np.int64],
    *,
    epochs: int,
    seed: int,
    faced: NDArray[np.int64] | None = None,
    on_epoch: Callable[[int], None] | None = None,
) -> SceneNetwork:
    """Minimise the cross-entropy with AdamW, the learning rate falling along a cosine.

    Nothing is held out: with as many shots as a simulator gives, the rate's fall is
    what ends the training.

    ``scenes`` (n, 34) are of :data:`~robobt.world.features.SHOT_SCENE`, ``goals`` (n,) 1 or 0; weights and
    the order of shots follow from ``seed``; ``faced`` (n,) says which kind of goalkeeper each shot met, from
    0, all the same without; ``on_epoch`` is called with the number of each epoch that is over.
    """
    generator = torch.Generator().manual_seed(seed)
    state = torch.random.get_rng_state()
    torch.manual_seed(seed)
    met = np.zeros(len(goals), dtype=np.int64) if faced is None else faced
    network = SceneNetwork(int(met.max()) + 1)
    torch.random.set_rng_state(state)
    x = torch.from_numpy(scenes.astype(np.float32))
    y, kind = torch.from_numpy(goals.astype(np.float32)), torch.from_numpy(met).unsqueeze(1)
    with torch.no_grad():
        inputs = network.inputs(x)
        there = inputs[x[:, SCENE_HEAD::4] > -1.0]
        network.mean.copy_(there.mean(0))
        network.scale.copy_(there.std(0).clamp_min(1e-3))
    adam = torch.optim.AdamW(network.parameters(), _FIRST_LEARNING_RATE, weight_decay=_WEIGHT_DECAY)
    steps = epochs * -(-len(x) // _BATCH_SIZE)
    schedule = torch.optim.lr_scheduler.CosineAnnealingLR(adam, steps)
    loss_of = nn.BCEWithLogitsLoss()
    for epoch in range(epochs):
        for chosen in torch.split(torch.randperm(len(x), generator=generator), _BATCH_SIZE):
            adam.zero_grad(set_to_none=True)
            log_odds = network.log_odds(x[chosen]).gather(1, kind[chosen]).squeeze(1)
            loss_of(log_odds, y[chosen]).backward()
            adam.step()
            schedule.step()
        if on_epoch is not None:
            on_epoch(epoch)
    return network.eval()
