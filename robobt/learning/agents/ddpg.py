"""Deep deterministic policy gradient, and the changes of later papers, each a switch.

The plain agent learns as Spinning Up defines DDPG. With Q the critic, mu the
actor and Q', mu' their targets:

    (1)  y  = r + gamma (1 - d) Q'(s', mu'(s'))              the target of Q(s, a)
    (2)  critic: minimise the mean of (Q(s, a) - y)^2 over a batch
    (3)  actor:  maximise the mean of Q(s, mu(s)) over a batch

and after each update both targets move a fraction tau towards the online networks
(Spinning Up's polyak is 1 - tau). The replay returns gamma (1 - d) as one
number, ``discount``, so that n-step returns need no other equation.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import deepcopy

import numpy as np
import torch
from torch import Tensor

from robobt.learning.agents.learner import Adam, Learner
from robobt.learning.agents.networks import Actor, Critic
from robobt.learning.agents.replay import Batch, Bootstrap
from robobt.learning.agents.settings import AgentSettings


class Atoms:
    """At least 2 evenly spaced returns from ``low`` to ``high``; returns beyond are clipped to them."""

    def __init__(self, low: float, high: float, count: int) -> None:
        if count < 2 or not low < high:
            raise ValueError(f"needs at least 2 atoms on a rising range, not {count} from {low} to {high}")
        self.low, self.high, self.count = low, high, count
        self.values = torch.linspace(low, high, count)

    def mean(self, logits: Tensor) -> Tensor:
        """Compute the expected return of (..., atoms) logits: (...)."""
        return torch.softmax(logits, -1) @ self.values

    def project(self, probabilities: Tensor, reward: Tensor, discount: Tensor) -> Tensor:
        """Project the distribution of reward + discount * Z on the atoms.

        ``reward`` and ``discount`` are (batch,), ``probabilities``, Z's, and the answer (batch, atoms), each
        row of which has mass 1.
        """
        width = (self.high - self.low) / (self.count - 1)
        moved = reward[:, None] + discount[:, None] * self.values
        place = (moved.clamp(self.low, self.high) - self.low) / width
        # Rounding can push the last place past the last atom.
        lower = place.floor().clamp_(0, self.count - 1)
        # On an atom both neighbours are that atom: all of the mass stays with the lower.
        upper_share = place - lower
        upper = (lower + 1).clamp_(max=self.count - 1)
        projected = torch.zeros_like(probabilities)
        projected.scatter_add_(1, lower.long(), probabilities * (1 - upper_share))
        projected.scatter_add_(1, upper.long(), probabilities * upper_share)
        return projected


_NORM_EVERY = 16
"""Gradient norms are logged once per this many updates, because they cost as much as a layer."""


class DDPG(Learner):
    """Actor, critic, their target networks and their optimisers.

    Args:
        settings: settings of the learner.
        scale: (observation,) typical size of each entry of the observation.
        smoothed: (action,) entries to which target policy smoothing adds noise: all but thresholds, such as
            that of a kick.
        seed: seed of the initial weights.
    """

    def __init__(
        self, settings: AgentSettings, scale: Sequence[float], smoothed: Sequence[bool], seed: int
    ) -> None:
        super().__init__()
        self.settings = settings
        generator = torch.Generator().manual_seed(seed)
        actions, norm = len(smoothed), settings.layer_norm
        self.actor = Actor(scale, actions, settings.hidden_sizes, norm, generator)
        self.critic = Critic(
            scale,
            actions,
            settings.hidden_sizes,
            settings.num_atoms or 1,
            2 if settings.twin_critics else 1,
            norm,
            generator,
        )
        self.target_actor, self.target_critic = deepcopy(self.actor), deepcopy(self.critic)
        for frozen in (self.target_actor, self.target_critic):
            frozen.requires_grad_(False)
        decay = settings.weight_decay
        self._actor_adam = Adam(list(self.actor.parameters()), settings.actor_learning_rate, decay)
        self._critic_adam = Adam(list(self.critic.parameters()), settings.critic_learning_rate, decay)
        self._online: list[Tensor] = [*self.actor.parameters(), *self.critic.parameters()]
        self._targets: list[Tensor] = [*self.target_actor.parameters(), *self.target_critic.parameters()]
        atoms = settings.num_atoms
        self._atoms = Atoms(settings.v_min, settings.v_max, atoms) if atoms else None
        self._smoothed = torch.tensor(list(smoothed), dtype=torch.float32)
        self._loss_weights = (1.0, settings.one_step_weight)

    def update(self, batch: Batch, rng: np.random.Generator) -> tuple[Tensor, Tensor]:
        """Learn from a batch.

        Returns:
            (batch,) squared TD errors and (batch,) squared norms of dQ/da at the actor's action,
            which make the priorities of a replay; zeros for a batch that was sampled uniformly.
        """
        self.updates += 1
        errors = self._update_critic(batch, rng)
        gradients = torch.zeros_like(errors)
        if self.updates % self.settings.policy_delay == 0:
            gradients = self._update_actor(batch.observation)
        if self.updates % self.settings.target_update_interval == 0:
            self._move_targets()
        return errors, gradients

    @torch.no_grad()
    def _move_targets(self) -> None:
        """Move both targets: target <- (1 - tau) target + tau online."""
        torch._foreach_lerp_(self._targets, self._online, self.settings.tau)

    def _update_critic(self, batch: Batch, rng: np.random.Generator) -> Tensor:
        """Take a step of (2), its losses summed over the batch's horizons; return squared TD errors."""
        estimate = self.critic(batch.observation, batch.action)
        loss, errors = torch.zeros(()), torch.zeros(len(batch.action))
        for bootstrap, weight in zip(batch.bootstraps, self._loss_weights, strict=False):
            target = self._target(bootstrap, rng)
            rows = self._loss(estimate, target)
            if batch.weights is not None:
                rows = rows * batch.weights
                errors += weight * self._squared_error(estimate, target)
            loss = loss + weight * rows.mean()
        gradients = torch.autograd.grad(loss, self._critic_adam.weights)
        self._critic_adam.step(gradients)
        self.diagnostics.add(critic_loss=loss.detach())
        if self.updates % _NORM_EVERY == 0:
            self.diagnostics.add(critic_grad_norm=torch.nn.utils.get_total_norm(gradients))
        return errors

    @torch.no_grad()
    def _target(self, bootstrap: Bootstrap, rng: np.random.Generator) -> Tensor:
        """Compute (1), y = r + gamma (1 - d) Q'(s', mu'(s')): (batch, 1), of a distribution (batch, atoms).

        With TD3's two critics Q' is the smaller.
        """
        action = self._smooth(self.target_actor(bootstrap.next_observation), rng)
        output: Tensor = self.target_critic(bootstrap.next_observation, action)
        if self._atoms is None:
            return bootstrap.reward[:, None] + bootstrap.discount[:, None] * output.amin(0)
        if len(output) > 1:
            smaller = self._atoms.mean(output).argmin(0)
            output = output[smaller, torch.arange(len(smaller))]
        probabilities = torch.softmax(output.reshape(-1, self._atoms.count), -1)
        return self._atoms.project(probabilities, bootstrap.reward, bootstrap.discount)

    def _loss(self, estimate: Tensor, target: Tensor) -> Tensor:
        """Compute (Q - y)^2, (batch,), summed over the critics; for C51 the cross-entropy."""
        if self._atoms is None:
            return (estimate - target).square().sum((0, 2))
        return -(target * torch.log_softmax(estimate, -1)).sum((0, 2))

    @torch.no_grad()
    def _squared_error(self, estimate: Tensor, target: Tensor) -> Tensor:
        """Compute (Q - y)^2, (batch,), of the first critic's mean."""
        if self._atoms is None:
            return (estimate[0] - target)[:, 0].square()
        return (self._atoms.mean(estimate[0]) - target @ self._atoms.values).square()

    def _smooth(self, action: Tensor, rng: np.random.Generator) -> Tensor:
        """Add clipped noise to the target actor's action, as TD3 does."""
        std, clip = self.settings.target_policy_noise, self.settings.target_noise_clip
        if std == 0.0:
            return action
        noise = torch.from_numpy(rng.standard_normal(tuple(action.shape), dtype=np.float32))
        return (action + (std * noise).clamp(-clip, clip) * self._smoothed).clamp(-1.0, 1.0)

    def _update_actor(self, observation: Tensor) -> Tensor:
        """Take a step of (3), by dQ/dtheta = dQ/da dmu/dtheta; return the squared norms of dQ/da."""
        action = self.actor(observation)
        taken = action.detach().requires_grad_()
        output = self.critic.first(observation, taken)
        value = output[:, 0] if self._atoms is None else self._atoms.mean(output)
        # For dQ/da alone, so that the critic gets no gradient from the actor's step.
        (gradient,) = torch.autograd.grad(value.sum(), taken)
        squared: Tensor = gradient.square().sum(-1)
        if self.settings.dqda_clipping is not None:
            gradient = gradient * (self.settings.dqda_clipping / squared.sqrt()).clamp(max=1.0)[:, None]
        # Adam minimises; the value is to be maximised.
        weights = self._actor_adam.weights
        # As a sum, because torch imports sympy, 0.3 s, where gradients are given for an output.
        gradients = torch.autograd.grad((action * (-gradient / len(gradient))).sum(), weights)
        self._actor_adam.step(gradients)
        self.diagnostics.add(q_mean=value.detach().mean())
        if self.updates % _NORM_EVERY == 0:
            self.diagnostics.add(actor_grad_norm=torch.nn.utils.get_total_norm(gradients))
        return squared

    def _modules(self) -> tuple[tuple[str, torch.nn.Module], ...]:
        return (
            ("actor", self.actor),
            ("critic", self.critic),
            ("target_actor", self.target_actor),
            ("target_critic", self.target_critic),
        )
