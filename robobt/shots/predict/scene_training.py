"""Trains a :class:`~robobt.shots.predict.scene_network.SceneNetwork` on scenes and goals."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import torch
from numpy.typing import NDArray
from torch import nn

from robobt.shots.predict.scene_network import SceneNetwork
from robobt.world.features import SCENE_HEAD
from robobt.world.geometry import FloatArray


def train_scene_network(
    scenes: FloatArray,
    goals: NDArray[np.int64],
    *,
    width: int = 48,
    epochs: int = 40,
    batch: int = 256,
    rate: float = 3e-3,
    weight_decay: float = 1e-4,
    seed: int = 0,
    on_epoch: Callable[[int], None] | None = None,
) -> SceneNetwork:
    """Minimise the cross-entropy with AdamW, the learning rate falling along a cosine.

    Nothing is held out: with as many shots as a simulator gives, the rate's fall is
    what ends the training.

    Args:
        scenes: (n, 34) of :data:`~robobt.world.features.SHOT_SCENE`.
        goals: (n,) of 1 and 0.
        width: of the network.
        epochs: passes over the data.
        batch: shots a step.
        rate: learning rate of the first step.
        weight_decay: of AdamW.
        seed: what the weights and the order of shots follow from.
        on_epoch: called with the number of each epoch that is over.
    """
    generator = torch.Generator().manual_seed(seed)
    state = torch.random.get_rng_state()
    torch.manual_seed(seed)
    network = SceneNetwork(width)
    torch.random.set_rng_state(state)
    x = torch.from_numpy(scenes.astype(np.float32))
    y = torch.from_numpy(goals.astype(np.float32))
    with torch.no_grad():
        inputs = network.inputs(x)
        there = inputs[x[:, SCENE_HEAD::4] > -1.0]
        network.mean.copy_(there.mean(0))
        network.scale.copy_(there.std(0).clamp_min(1e-3))
    adam = torch.optim.AdamW(network.parameters(), rate, weight_decay=weight_decay)
    steps = epochs * -(-len(x) // batch)
    schedule = torch.optim.lr_scheduler.CosineAnnealingLR(adam, steps)
    loss_of = nn.BCEWithLogitsLoss()
    for epoch in range(epochs):
        for chosen in torch.split(torch.randperm(len(x), generator=generator), batch):
            adam.zero_grad(set_to_none=True)
            loss_of(network.log_odds(x[chosen]), y[chosen]).backward()
            adam.step()
            schedule.step()
        if on_epoch is not None:
            on_epoch(epoch)
    return network.eval()
