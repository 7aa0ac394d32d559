"""The paper's training recipe, and the plain loop that follows it for one network."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple

import torch
from torch import Tensor, nn

from robobt.shots.predict.networks import TABLE_ONE, Layer, ShotNetwork


@dataclass(frozen=True)
class Recipe:
    """How the shot networks are trained.

    Adam on the binary cross-entropy of shuffled batches. For ``warm_up`` epochs
    nothing stops it; then at most ``epochs`` more, until the loss on the held-out
    shots has not improved for ``patience`` epochs; the weights of the best of these
    epochs are kept. Meanwhile the learning rate is multiplied by ``plateau_factor``
    whenever that loss has not improved by 1e-4 for ``plateau_patience`` epochs, down
    to ``least_rate``. The warm-up counts epochs without improvement for itself.

    Source: the paper, section on training; what is not said there is Keras' default.
    """

    layers: tuple[Layer, ...] = field(default=TABLE_ONE)
    rate: float = 0.05
    batch: int = 16
    warm_up: int = 64
    epochs: int = 512
    patience: int = 50
    plateau_factor: float = 0.5
    plateau_patience: int = 75
    least_rate: float = 0.001


PLATEAU_GAIN = 1e-4
ADAM = (0.9, 0.999, 1e-7)
"""Keras' defaults: the gain that counts as an improvement, and Adam's beta 1, beta 2 and epsilon."""


class Task(NamedTuple):
    """What one network learns from: float32 inputs (n, F) and labels (n,), and the same held out."""

    inputs: Tensor
    labels: Tensor
    held_inputs: Tensor
    held_labels: Tensor
    seed: int


def batch_bounds(samples: int, batch: int) -> list[int]:
    """Where an epoch's batches begin and end; a single left-over sample joins the batch before it.

    A batch of one has no variance to normalise by.
    """
    bounds = [*range(0, samples, batch), samples]
    if len(bounds) > 2 and bounds[-1] - bounds[-2] == 1:
        del bounds[-2]
    return bounds


def train_plainly(task: Task, recipe: Recipe = Recipe()) -> ShotNetwork:
    """Train one network with modules, autograd and torch's Adam, the way anyone would write it.

    :func:`~robobt.shots.predict.batched.train_networks` does the same for many at
    once; this is what it is compared with.
    """
    generator = torch.Generator().manual_seed(task.seed)
    network = ShotNetwork(task.inputs.shape[1], recipe.layers, generator)
    loss_of = nn.BCEWithLogitsLoss()
    beta1, beta2, epsilon = ADAM
    adam = torch.optim.Adam(network.parameters(), recipe.rate, (beta1, beta2), epsilon)
    bounds = batch_bounds(len(task.inputs), recipe.batch)
    best = plateau_best = float("inf")
    state = network.state_dict()
    waited = plateau_waited = 0
    for epoch in range(recipe.warm_up + recipe.epochs):
        network.train()
        order = torch.randperm(len(task.inputs), generator=generator)
        for begin, end in pairwise(bounds):
            chosen = order[begin:end]
            adam.zero_grad()
            loss_of(network(task.inputs[chosen]), task.labels[chosen]).backward()
            adam.step()
        network.eval()
        with torch.no_grad():
            loss = float(loss_of(network(task.held_inputs), task.held_labels))
        if epoch == recipe.warm_up:
            plateau_best, plateau_waited = float("inf"), 0
        if loss < plateau_best - PLATEAU_GAIN:
            plateau_best, plateau_waited = loss, 0
        else:
            plateau_waited += 1
            if plateau_waited >= recipe.plateau_patience:
                for group in adam.param_groups:
                    group["lr"] = max(group["lr"] * recipe.plateau_factor, recipe.least_rate)
                plateau_waited = 0
        if epoch < recipe.warm_up:
            continue
        if loss < best:
            best, waited = loss, 0
            state = {name: value.clone() for name, value in network.state_dict().items()}
        else:
            waited += 1
            if waited >= recipe.patience:
                break
    network.load_state_dict(state)
    return network.eval()
