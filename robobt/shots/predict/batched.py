"""The paper's training recipe, followed by many small networks at once.

A network of sixty weights keeps no processor busy; a hundred of them, with a
leading axis for the network, do. Every network sees its own data in its own order,
stops by its own held-out loss and then leaves the group.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple

import torch
from torch import Tensor
from torch.nn.functional import binary_cross_entropy_with_logits as cross_entropy
from torch.nn.utils import vector_to_parameters
from torch.nn.utils.rnn import pad_sequence

from robobt.shots.predict.networks import NORM_EPS, NORM_MOMENTUM, TABLE_ONE, Layer, ShotNetwork


@dataclass(frozen=True)
class Recipe:
    """How the shot networks are trained.

    The network has these ``layers``. It learns by Adam with the learning rate ``rate`` on the binary
    cross-entropy of shuffled batches of ``batch`` shots. For ``warm_up`` epochs nothing stops it; then at
    most ``epochs`` more, until the loss on the held-out shots has not improved for ``patience`` epochs; the
    weights of the best of these epochs are kept. Meanwhile the learning rate is multiplied by
    ``plateau_factor`` whenever that loss has not improved by :data:`PLATEAU_GAIN` for ``plateau_patience``
    epochs, down to ``least_rate``. The plateau count restarts after the warm-up.

    Source: the paper, section on training; the rest is Keras' default.
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


class TrainingSet(NamedTuple):
    """What one network learns from: float32 inputs (n, F) and labels (n,), and the same held out."""

    inputs: Tensor
    labels: Tensor
    held_inputs: Tensor
    held_labels: Tensor
    seed: int


def batch_bounds(samples: int, batch: int) -> list[int]:
    """Return where an epoch's batches begin and end.

    A single left-over sample joins the batch before it: one sample has no variance to normalise by.
    """
    bounds = [*range(0, samples, batch), samples]
    if len(bounds) > 2 and bounds[-1] - bounds[-2] == 1:
        del bounds[-2]
    return bounds


def train_networks(tasks: Sequence[TrainingSet], recipe: Recipe = Recipe()) -> list[ShotNetwork]:
    """Train a network for every task, all at once; they come back in the order of the tasks.

    Tasks whose epochs begin their batches at the same samples are trained
    together; how many samples the last batch has may differ.
    """
    groups: dict[tuple[int, ...], list[int]] = {}
    for i, task in enumerate(tasks):
        starts = batch_bounds(len(task.inputs), recipe.batch)[:-1]
        groups.setdefault((task.inputs.shape[1], *starts), []).append(i)
    networks: dict[int, ShotNetwork] = {}
    for members in groups.values():
        networks.update(zip(members, _Group([tasks[i] for i in members], recipe).train(), strict=True))
    return [networks[i] for i in range(len(tasks))]


class _Group:
    """Networks of one shape in training.

    Every tensor of ``each`` has a row for each network that is still in training: its
    weights, what Adam and the stopping rules remember, and its data, padded to the longest.
    """

    def __init__(self, tasks: list[TrainingSet], recipe: Recipe) -> None:
        self.recipe = recipe
        self.generators = [torch.Generator().manual_seed(task.seed) for task in tasks]
        width = tasks[0].inputs.shape[1]
        self.networks = [ShotNetwork(width, recipe.layers, generator) for generator in self.generators]
        weights = torch.stack([_flat(network.parameters()) for network in self.networks])
        moments = torch.stack([_flat(_moments(network)) for network in self.networks])
        count = len(tasks)
        self.each = {
            "member": torch.arange(count),
            "weights": weights,
            "moments": moments,
            "first": torch.zeros_like(weights),
            "second": torch.zeros_like(weights),
            "rate": torch.full((count, 1), recipe.rate),
            "best": torch.full((count,), torch.inf),
            "best_weights": weights.clone(),
            "best_moments": moments.clone(),
            "waited": torch.zeros(count, dtype=torch.long),
            "plateau": torch.full((count,), torch.inf),
            "stuck": torch.zeros(count, dtype=torch.long),
            "size": torch.tensor([len(task.labels) for task in tasks]),
            "inputs": pad_sequence([task.inputs for task in tasks], batch_first=True),
            "labels": pad_sequence([task.labels for task in tasks], batch_first=True),
            "held_size": torch.tensor([len(task.held_labels) for task in tasks]),
            "held_inputs": pad_sequence([task.held_inputs for task in tasks], batch_first=True),
            "held_labels": pad_sequence([task.held_labels for task in tasks], batch_first=True),
        }
        self.bounds = batch_bounds(int(self.each["size"].max()), recipe.batch)
        self.steps = 0

    def train(self) -> list[ShotNetwork]:
        """Follow the recipe to its end."""
        for epoch in range(self.recipe.warm_up + self.recipe.epochs):
            self._run_epoch()
            if epoch == self.recipe.warm_up:
                self.each["plateau"].fill_(torch.inf)
                self.each["stuck"].zero_()
            loss = self._held_out_loss()
            self._lower_rates(loss)
            if epoch >= self.recipe.warm_up:
                self._keep_best(loss)
                self._release(self.each["waited"] >= self.recipe.patience)
            if not len(self.each["member"]):
                break
        self._release(torch.ones_like(self.each["member"], dtype=torch.bool))
        return self.networks

    def _run_epoch(self) -> None:
        """Pass over every network's samples once, in an order of its own."""
        longest = self.each["inputs"].shape[1]
        orders = []
        for member, size in zip(self.each["member"].tolist(), self.each["size"].tolist(), strict=True):
            order = torch.randperm(size, generator=self.generators[member])
            orders.append(torch.cat([order, torch.arange(size, longest)]))
        order = torch.stack(orders)
        inputs = torch.take_along_dim(self.each["inputs"], order.unsqueeze(-1), 1)
        labels = torch.take_along_dim(self.each["labels"], order, 1)
        for begin, end in pairwise(self.bounds):
            shares = _shares(self.each["size"] - begin, end - begin)
            weights = self.each["weights"].requires_grad_()
            logits = self._logits(inputs[:, begin:end], shares)
            loss = cross_entropy(logits, labels[:, begin:end], shares[:, 0], reduction="sum")
            (gradient,) = torch.autograd.grad(loss, weights)
            self._step(weights.detach_(), gradient)

    def _step(self, weights: Tensor, gradient: Tensor) -> None:
        beta1, beta2, epsilon = ADAM
        self.steps += 1
        self.each["first"].lerp_(gradient, 1.0 - beta1)
        self.each["second"].mul_(beta2).addcmul_(gradient, gradient, value=1.0 - beta2)
        spread = self.each["second"].sqrt().mul_((1.0 - beta2**self.steps) ** -0.5).add_(epsilon)
        move = self.each["first"] * self.each["rate"]
        weights.addcdiv_(move, spread, value=-1.0 / (1.0 - beta1**self.steps))

    def _logits(self, x: Tensor, shares: Tensor | None = None) -> Tensor:
        """Return logits (N, B) of inputs (N, B, F).

        Args:
            x: the inputs.
            shares: how much each row of the batch counts in its mean and variance, which then
                normalise it and move the running ones; None normalises by those.
        """
        pattern = self.networks[0]
        weights = _views(self.each["weights"], list(pattern.parameters()))
        moments = _views(self.each["moments"], _moments(pattern))
        gammas_and_betas = iter(weights[: len(moments)])
        kernels_and_biases = iter(weights[len(moments) :])
        running = iter(moments)
        for layer in pattern.layers:
            if layer.normalised:
                mean, variance = next(running), next(running)
                if shares is None:
                    centred = x - mean
                else:
                    batch_mean = torch.bmm(shares, x)
                    centred = x - batch_mean
                    batch_variance = torch.bmm(shares, centred * centred)
                    mean.lerp_(batch_mean.detach(), NORM_MOMENTUM)
                    variance.lerp_(batch_variance.detach(), NORM_MOMENTUM)
                    variance = batch_variance
                scale = next(gammas_and_betas) * torch.rsqrt(variance + NORM_EPS)
                x = torch.addcmul(next(gammas_and_betas), centred, scale)
            kernel = next(kernels_and_biases)
            x = layer.activate(torch.baddbmm(next(kernels_and_biases), x, kernel.transpose(1, 2)))
        return x.squeeze(-1)

    @torch.no_grad()
    def _held_out_loss(self) -> Tensor:
        """Return every network's loss on its held-out samples, (N,)."""
        logits = self._logits(self.each["held_inputs"])
        shares = _shares(self.each["held_size"], logits.shape[1])[:, 0]
        return cross_entropy(logits, self.each["held_labels"], shares, reduction="none").sum(1)

    def _lower_rates(self, loss: Tensor) -> None:
        """Lower the learning rate of networks that have not improved for long."""
        recipe, each = self.recipe, self.each
        better = loss < each["plateau"] - PLATEAU_GAIN
        each["plateau"] = torch.where(better, loss, each["plateau"])
        each["stuck"] = torch.where(better, 0, each["stuck"] + 1)
        stuck = each["stuck"] >= recipe.plateau_patience
        lowered = (each["rate"] * recipe.plateau_factor).clamp_min(recipe.least_rate)
        each["rate"] = torch.where(stuck.unsqueeze(1), lowered, each["rate"])
        each["stuck"] = torch.where(stuck, 0, each["stuck"])

    def _keep_best(self, loss: Tensor) -> None:
        """Remember the weights of networks that are better than ever."""
        each = self.each
        better = loss < each["best"]
        each["best"] = torch.where(better, loss, each["best"])
        each["waited"] = torch.where(better, 0, each["waited"] + 1)
        for name in ("weights", "moments"):
            each[f"best_{name}"] = torch.where(better.unsqueeze(1), each[name], each[f"best_{name}"])

    def _release(self, done: Tensor) -> None:
        """Take networks that are done out of training, with the best weights they had."""
        for i in torch.nonzero(done).flatten().tolist():
            network = self.networks[int(self.each["member"][i])]
            vector_to_parameters(self.each["best_weights"][i].clone(), network.parameters())
            vector_to_parameters(self.each["best_moments"][i].clone(), _moments(network))
        if bool(done.any()):
            self.each = {name: rows[~done] for name, rows in self.each.items()}


def _moments(network: ShotNetwork) -> list[Tensor]:
    """Return the running means and variances of a network's normalisations."""
    return [moment for moment in network.buffers() if moment.is_floating_point()]


def _flat(values: Iterable[Tensor]) -> Tensor:
    return torch.cat([torch.zeros(0), *(value.detach().flatten() for value in values)])


def _views(rows: Tensor, pattern: Sequence[Tensor]) -> list[Tensor]:
    """Split rows of flat values (N, P) into one view for each of a network's tensors.

    A matrix becomes (N, outputs, inputs), a vector (N, 1, width).
    """
    parts = torch.split(rows, [value.numel() for value in pattern], 1)
    shapes = [value.shape if value.ndim == 2 else (1, value.numel()) for value in pattern]
    return [part.view(-1, *shape) for part, shape in zip(parts, shapes, strict=True)]


def _shares(sizes: Tensor, width: int) -> Tensor:
    """Return the share of each of ``width`` rows in the mean over the first ``sizes``, (N, 1, width)."""
    counts = sizes.clamp_max(width)[:, None]
    return ((torch.arange(width) < counts) / counts).unsqueeze(1)
