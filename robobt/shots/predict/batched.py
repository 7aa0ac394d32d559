"""Many small networks trained in one: each operation works on all of them.

A network of sixty weights keeps no processor busy; a hundred of them, with a
leading axis for the network, do. Forward and backward passes are written out,
because recording them costs more than the arithmetic. Every network sees its own
data in its own order, stops by its own held-out loss and then leaves the stack.
The result for each is that of :func:`~robobt.shots.predict.recipe.train_plainly`
up to rounding.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import torch
from torch import Tensor

from robobt.shots.predict.networks import ShotNetwork
from robobt.shots.predict.recipe import ADAM, PLATEAU_GAIN, Recipe, Task, batch_bounds
from robobt.shots.predict.stack import NetworkStack, Rows


def train_networks(tasks: Sequence[Task], recipe: Recipe = Recipe()) -> list[ShotNetwork]:  # noqa: B008
    """Train a network for every task, all at once; they come back in the order of the tasks.

    Tasks whose epochs begin their batches at the same samples are trained
    together; how many samples the last batch has may differ.
    """
    groups: dict[tuple[int, ...], list[int]] = {}
    for i, task in enumerate(tasks):
        starts = batch_bounds(len(task.inputs), recipe.batch)[:-1]
        groups.setdefault((task.inputs.shape[1], *starts), []).append(i)
    networks: dict[int, ShotNetwork] = {}
    with torch.inference_mode():
        for members in groups.values():
            _train_group([tasks[i] for i in members], recipe, members, networks)
    return [networks[i] for i in range(len(tasks))]


def _train_group(
    tasks: list[Task], recipe: Recipe, members: list[int], networks: dict[int, ShotNetwork]
) -> None:
    generators = [torch.Generator().manual_seed(task.seed) for task in tasks]
    drawn = [
        ShotNetwork(task.inputs.shape[1], recipe.layers, generator)
        for task, generator in zip(tasks, generators, strict=True)
    ]
    fit = _Fit(NetworkStack(drawn), tasks, generators, recipe, members)
    for epoch in range(recipe.warm_up + recipe.epochs):
        fit.run_epoch()
        if epoch == recipe.warm_up:
            fit.forget_plateau()
        loss = fit.held_out_loss()
        fit.lower_rates(loss)
        if epoch >= recipe.warm_up:
            fit.keep_best(loss)
            fit.release(fit.waited >= recipe.patience, networks)
            if not fit.members:
                return
    fit.release(torch.ones_like(fit.waited, dtype=torch.bool), networks)


class _Fit:
    """The networks still in training, with their data and the optimiser's state."""

    def __init__(
        self,
        stack: NetworkStack,
        tasks: list[Task],
        generators: list[torch.Generator],
        recipe: Recipe,
        members: list[int],
    ) -> None:
        self.stack, self.generators, self.recipe, self.members = stack, generators, recipe, members
        count = len(tasks)
        self.inputs, self.labels, self.samples = _padded([(t.inputs, t.labels) for t in tasks])
        self.held_inputs, self.held_labels, held = _padded([(t.held_inputs, t.held_labels) for t in tasks])
        self.held_rows = Rows.first(held, self.held_inputs.shape[1])
        self.bounds = batch_bounds(int(self.samples.max()), recipe.batch)
        self.first, self.second = torch.zeros_like(stack.weights), torch.zeros_like(stack.weights)
        self.rates = torch.full((count, 1), recipe.rate)
        self.steps = 0
        self.best = torch.full((count,), float("inf"))
        self.best_weights, self.best_moments = stack.weights.clone(), stack.moments.clone()
        self.waited = torch.zeros(count, dtype=torch.long)
        self.forget_plateau()
        self._find_rows()

    def run_epoch(self) -> None:
        """One pass over every network's samples in an order of its own."""
        longest = self.inputs.shape[1]
        orders = []
        for generator, samples in zip(self.generators, self.samples.tolist(), strict=True):
            order = torch.randperm(samples, generator=generator)
            orders.append(torch.cat([order, torch.arange(samples, longest)]) if samples < longest else order)
        chosen = torch.stack(orders).unsqueeze(-1)
        inputs = torch.take_along_dim(self.inputs, chosen, 1)
        labels = torch.take_along_dim(self.labels, chosen, 1)
        for i, rows in enumerate(self.rows):
            begin, end = self.bounds[i], self.bounds[i + 1]
            self.stack.find_gradients(inputs[:, begin:end], labels[:, begin:end], rows)
            self._step()

    def _step(self) -> None:
        beta1, beta2, epsilon = ADAM
        self.steps += 1
        gradients = self.stack.gradients
        self.first.lerp_(gradients, 1.0 - beta1)
        self.second.mul_(beta2).addcmul_(gradients, gradients, value=1.0 - beta2)
        spread = self.second.sqrt().mul_((1.0 - beta2**self.steps) ** -0.5).add_(epsilon)
        move = self.first * self.rates
        self.stack.weights.addcdiv_(move, spread, value=-1.0 / (1.0 - beta1**self.steps))

    def held_out_loss(self) -> Tensor:
        """Every network's loss on its held-out samples, (N,)."""
        return self.stack.loss(self.held_inputs, self.held_labels, self.held_rows)

    def forget_plateau(self) -> None:
        """Begin to watch for plateaus anew."""
        self.plateau_best = torch.full_like(self.best, float("inf"))
        self.plateau_waited = torch.zeros_like(self.waited)

    def lower_rates(self, loss: Tensor) -> None:
        """Lower the learning rate of networks that have not improved for long."""
        recipe = self.recipe
        better = loss < self.plateau_best - PLATEAU_GAIN
        self.plateau_best = torch.where(better, loss, self.plateau_best)
        self.plateau_waited = torch.where(better, 0, self.plateau_waited + 1)
        stuck = self.plateau_waited >= recipe.plateau_patience
        lowered = (self.rates * recipe.plateau_factor).clamp_min(recipe.least_rate)
        self.rates = torch.where(stuck.unsqueeze(1), lowered, self.rates)
        self.plateau_waited = torch.where(stuck, 0, self.plateau_waited)

    def keep_best(self, loss: Tensor) -> None:
        """Remember the weights of networks that are better than ever."""
        better = loss < self.best
        self.best = torch.where(better, loss, self.best)
        self.waited = torch.where(better, 0, self.waited + 1)
        chosen = better.unsqueeze(1)
        self.best_weights = torch.where(chosen, self.stack.weights, self.best_weights)
        self.best_moments = torch.where(chosen, self.stack.moments, self.best_moments)

    def release(self, done: Tensor, networks: dict[int, ShotNetwork]) -> None:
        """Take networks that are done out of the stack, with the best weights they had."""
        if not bool(done.any()):
            return
        for i in torch.nonzero(done).flatten().tolist():
            networks[self.members[i]] = self.stack.network(self.best_weights[i], self.best_moments[i])
        left = torch.nonzero(~done).flatten()
        self.members = [self.members[i] for i in left.tolist()]
        self.generators = [self.generators[i] for i in left.tolist()]
        self.stack.keep(left)
        for name in (
            *("inputs", "labels", "samples", "held_inputs", "held_labels", "first", "second", "rates"),
            *("best", "best_weights", "best_moments", "waited", "plateau_best", "plateau_waited"),
        ):
            setattr(self, name, getattr(self, name)[left])
        self.held_rows = self.held_rows.keep(left)
        self._find_rows()

    def _find_rows(self) -> None:
        self.rows = [Rows.first(self.samples - begin, end - begin) for begin, end in pairwise(self.bounds)]


def _padded(sets: list[tuple[Tensor, Tensor]]) -> tuple[Tensor, Tensor, Tensor]:
    """Sample sets of different sizes in one: (N, most, F), (N, most, 1) and their sizes (N,)."""
    samples = torch.tensor([len(labels) for _, labels in sets])
    inputs = torch.nn.utils.rnn.pad_sequence([inputs for inputs, _ in sets], batch_first=True)
    labels = torch.nn.utils.rnn.pad_sequence([labels for _, labels in sets], batch_first=True)
    return inputs, labels.unsqueeze(-1), samples
