"""The paper's recipe for a single network, with modules and torch's Adam, as anyone would write it."""

from itertools import pairwise

import torch
from torch import Tensor, nn

from robobt.shots.predict.batched import ADAM, PLATEAU_GAIN, Recipe, TrainingSet, batch_bounds
from robobt.shots.predict.networks import NORM_EPS, NORM_MOMENTUM, ShotNetwork


class KerasNorm(nn.BatchNorm1d):
    """Batch normalisation with Keras' moving variance: a batch's own, not an unbiased estimate."""

    def forward(self, x: Tensor) -> Tensor:
        if not self.training:
            return super().forward(x)
        with torch.no_grad():
            variance, mean = torch.var_mean(x, 0, correction=0)
            self.running_mean.lerp_(mean, NORM_MOMENTUM)
            self.running_var.lerp_(variance, NORM_MOMENTUM)
        return nn.functional.batch_norm(x, None, None, self.weight, self.bias, training=True, eps=self.eps)


def train_plainly(task: TrainingSet, recipe: Recipe) -> ShotNetwork:
    generator = torch.Generator().manual_seed(task.seed)
    network = ShotNetwork(task.inputs.shape[1], recipe.layers, generator)
    for i, norm in enumerate(network.norms):
        if isinstance(norm, nn.BatchNorm1d):
            network.norms[i] = KerasNorm(norm.num_features, NORM_EPS)
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
            loss_of(network(task.inputs[chosen])[:, 0], task.labels[chosen]).backward()
            adam.step()
        network.eval()
        with torch.no_grad():
            loss = float(loss_of(network(task.held_inputs)[:, 0], task.held_labels))
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
