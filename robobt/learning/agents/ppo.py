"""Proximal policy optimisation, after Schulman et al. (2017), for driving and kicking at once.

With V the value and A the advantages of a rollout by generalised advantage estimation,

    (1)  delta_t = r_t + gamma V(s_t+1) - V(s_t)         V is 0 where the episode has terminated
    (2)  A_t     = delta_t + gamma lambda A_t+1          which ends where an episode does

an update makes, over a few epochs of minibatches,

    (3)  the mean of min(rho A, clip(rho, 1 - eps, 1 + eps) A) large, rho = pi(a | s) / pi_old(a | s)
    (4)  the mean of (V(s) - (A + V_old(s)))^2 small

The policy's entries are independent: each is normal about tanh of the network's output, with a learned
standard deviation, except thresholds such as that of a kick: these are Bernoulli, with the output as
log-odds. Without noise the policy takes the mean of the normal entries, and kicks where the probability is
over one half; so the actor alone is the network that is evaluated and exported, like DDPG's.

V may have more inputs than the policy, since it is only needed in training. Where several robots learn one
policy a *central* V has the true state of all of them (Yu et al., "The surprising effectiveness of PPO in
cooperative multi-agent games", 2022): then s above is the robot's observation followed by the state, and the
policy takes only the first part.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
import torch
from torch import Tensor, nn
from torch.nn.functional import softplus

from robobt.learning.agents.learner import Learner
from robobt.learning.agents.networks import Actor, body_of
from robobt.learning.agents.optimiser import Adam
from robobt.learning.agents.rollout import Floats, Rollout, advantages
from robobt.learning.agents.settings import PPOSettings
from robobt.world.observation import Group

PolicyUpdate = Literal["improve", "keep", "imitate"]
"""What an update does to the policy."""

_LOG_ROOT = 0.5 * float(np.log(2.0 * np.pi))


class Value(nn.Module):
    """V, the value of a state; arguments as for :class:`Actor`."""

    inverse_scale: Tensor

    def __init__(
        self,
        scale: Sequence[float],
        hidden: Sequence[int],
        generator: torch.Generator,
        groups: Sequence[Group] = (),
    ) -> None:
        super().__init__()
        self.register_buffer("inverse_scale", 1.0 / torch.tensor(list(scale), dtype=torch.float32))
        self.body = body_of(scale, hidden, 1, False, generator, "tanh", groups)
        orthogonal(self.body, 1.0, generator)

    def forward(self, observation: Tensor) -> Tensor:
        """Map (..., observation) to (...)."""
        value: Tensor = self.body(observation * self.inverse_scale)
        return value.squeeze(-1)


class PPO(Learner):
    """Policy, value and their optimisers.

    Args:
        settings: of the learner.
        scale: (observation,) typical size of each entry of the observation.
        continuous: (action,) which entries are normal; the others are thresholds at 0.
        seed: of the initial weights.
        state_scale: (state,) typical sizes of the value's additional inputs.
        vectors: entries of the observation that are turned into the ball's frame; see :class:`Actor`.
        groups: entries of the observation on robots of one kind, for networks that treat them as sets.
    """

    def __init__(
        self,
        settings: PPOSettings,
        scale: Sequence[float],
        continuous: Sequence[bool],
        seed: int,
        state_scale: Sequence[float] = (),
        vectors: Sequence[int] = (),
        groups: Sequence[Group] = (),
    ) -> None:
        super().__init__()
        self.settings = settings
        generator = torch.Generator().manual_seed(seed)
        hidden = settings.hidden_sizes
        self.actor = Actor(scale, len(continuous), hidden, False, generator, "tanh", vectors, groups)
        self.critic = Value([*scale, *state_scale], hidden, generator, groups)
        self._observed, self._in_ball_frame = len(scale), bool(vectors)
        self._continuous = torch.tensor(list(continuous))
        self._normal, self._thresholds = _columns(continuous), _columns([not each for each in continuous])
        self._gamma = settings.gamma
        self._log_std = nn.Parameter(torch.full((sum(continuous),), float(np.log(settings.init_std))))
        # The initial policy prefers no direction and rarely kicks.
        last = orthogonal(self.actor.body, 0.01, generator)
        with torch.no_grad():
            last.bias.copy_(torch.where(self._continuous, 0.0, settings.threshold_bias))
        weights = [*self.actor.parameters(), self._log_std]
        self._actor_adam = Adam(weights, settings.learning_rate, eps=1e-5)
        self._critic_adam = Adam(list(self.critic.parameters()), settings.learning_rate, eps=1e-5)

    @torch.no_grad()
    def act(self, observation: Floats, rng: np.random.Generator) -> tuple[Floats, Floats, Floats]:
        """Draw actions: (n, observation and state) -> (n, action), log-probabilities (n,), values (n,)."""
        seen = torch.from_numpy(observation.astype(np.float32))
        output = self._policy_output(seen)
        noise = torch.from_numpy(rng.standard_normal((len(seen), len(self._log_std)), np.float32))
        uniform = torch.from_numpy(rng.random((len(seen), int((~self._continuous).sum())), np.float32))
        action = torch.empty_like(output)
        action[:, self._normal] = output[:, self._normal] + self._log_std.exp() * noise
        kicks = uniform < torch.sigmoid(output[:, self._thresholds])
        action[:, self._thresholds] = torch.where(kicks, 1.0, -1.0)
        log_probability, _ = self._evaluate_actions(output, action)
        return (_to_numpy(action), _to_numpy(log_probability), _to_numpy(self._values(seen)))

    @torch.no_grad()
    def values(self, observation: Floats) -> Floats:
        """Return V of (n, observation and state), (n,)."""
        return _to_numpy(self._values(torch.from_numpy(observation.astype(np.float32))))

    def anneal_gamma(self, share: float) -> None:
        """Set the discount for when ``share`` of the run's steps is over: the horizon grows linearly."""
        first, last = self.settings.gamma, self.settings.final_gamma
        if last is not None:
            self._gamma = 1.0 - 1.0 / ((1.0 - share) / (1.0 - first) + share / (1.0 - last))

    def update(
        self,
        rollout: Rollout,
        rng: np.random.Generator,
        policy: PolicyUpdate = "improve",
        imitation: float = 0.0,
    ) -> None:
        """Learn from a rollout: the value by (4), and the policy by (3), or by imitation, or not at all.

        A policy that imitates learns to act as the rollout's actions say, whoever acted. One that improves
        may also stay close to what the rollout's teacher shows (kickstarting, Schmitt et al., 2018): then
        ``imitation`` is the weight of this loss beside that of (3).

        Diagnostics are those of the last epoch, in which the policy is farthest from the one that acted.
        """
        settings = self.settings
        advantage = advantages(rollout, self._gamma, settings.gae_lambda)
        target = advantage + rollout.value
        columns = [rollout.observation, rollout.action, rollout.log_probability, advantage, target]
        if imitation > 0.0 and rollout.shown is not None:
            columns.append(rollout.shown)
        flat = [array.reshape(advantage.size, -1) for array in columns]
        # In one table, so that a shuffle is one gather.
        decisions = torch.from_numpy(np.concatenate(flat, axis=1, dtype=np.float32))
        for epoch in range(settings.num_epochs):
            last = epoch == settings.num_epochs - 1
            shuffled = decisions.index_select(0, torch.from_numpy(rng.permutation(len(decisions))))
            for rows in torch.split(shuffled, settings.minibatch_size):
                observation, action, *rest = torch.split(rows, [array.shape[1] for array in flat], 1)
                old, gain, aim = (column[:, 0] for column in rest[:3])
                if policy == "improve":
                    lesson = (rest[3], imitation) if len(rest) > 3 else None
                    self._update_policy(observation, action, old, gain, last, lesson)
                elif policy == "imitate":
                    self._imitate(observation, action, last)
                self._update_value(observation, aim, last)
                self.updates += 1
        spread = target.var()
        if spread > 0.0:
            explained = 1.0 - (target - rollout.value).var() / spread
            self.diagnostics.add(explained_variance=torch.tensor(explained))

    def _update_policy(
        self,
        seen: Tensor,
        action: Tensor,
        old: Tensor,
        advantage: Tensor,
        report: bool = False,
        lesson: tuple[Tensor, float] | None = None,
    ) -> None:
        """Take a step of (3), with a bonus for entropy; with ``report`` add to the diagnostics.

        ``lesson`` is what a teacher shows, and the weight of imitating it.
        """
        settings = self.settings
        output = self._policy_output(seen)
        log_probability, entropy = self._evaluate_actions(output, action)
        advantage = (advantage - advantage.mean()) / (advantage.std() + 1e-8)
        log_ratio = log_probability - old
        ratio = log_ratio.exp()
        clipped = ratio.clamp(1.0 - settings.clip_coef, 1.0 + settings.clip_coef)
        gain = torch.minimum(ratio * advantage, clipped * advantage).mean()
        mean_entropy = entropy.mean()
        loss = -gain - settings.ent_coef * mean_entropy
        if lesson is not None:
            shown, weight = lesson
            missed, off = self._missed(output, shown)
            loss = loss + weight * missed
            if report:
                self._report_imitation(missed, off)
        weights = self._actor_adam.weights
        norm = self._actor_adam.clipped_step(torch.autograd.grad(loss, weights), settings.max_grad_norm)
        if not report:
            return
        with torch.no_grad():
            change = ratio - 1.0
            self.diagnostics.add(
                policy_loss=-gain.detach(),
                entropy=mean_entropy.detach(),
                approx_kl=(change - log_ratio).mean(),
                clip_fraction=(change.abs() > settings.clip_coef).float().mean(),
                policy_grad_norm=norm,
            )

    def _imitate(self, seen: Tensor, shown: Tensor, report: bool = False) -> None:
        """Take a step towards the actions shown: of squared errors, and of cross entropy for thresholds."""
        loss, off = self._missed(self._policy_output(seen), shown)
        # The spread is not part of this loss.
        weights = list(self.actor.parameters())
        gradients = [*torch.autograd.grad(loss, weights), torch.zeros_like(self._log_std)]
        self._actor_adam.clipped_step(gradients, self.settings.max_grad_norm)
        if report:
            self._report_imitation(loss, off)

    def _missed(self, output: Tensor, shown: Tensor) -> tuple[Tensor, Tensor]:
        """Return the loss of imitation, and its part of squared errors (m,), of outputs (m, action)."""
        off = (output - shown)[:, self._normal].square().sum(-1)
        odds = output[:, self._thresholds]
        missed = softplus(-odds * shown[:, self._thresholds].sign()).sum(-1)
        return (off + missed).mean(), off

    def _report_imitation(self, loss: Tensor, off: Tensor) -> None:
        self.diagnostics.add(imitation_loss=loss.detach(), imitation_error=off.detach().mean().sqrt())

    def _update_value(self, seen: Tensor, target: Tensor, report: bool = False) -> None:
        """Take a step of (4); with ``report`` add to the diagnostics."""
        value = self._values(seen)
        loss = (value - target).square().mean()
        weights = self._critic_adam.weights
        gradients = torch.autograd.grad(0.5 * loss, weights)
        norm = self._critic_adam.clipped_step(gradients, self.settings.max_grad_norm)
        if report:
            mean = value.detach().mean()
            self.diagnostics.add(value_loss=loss.detach(), value_mean=mean, value_grad_norm=norm)

    def _policy_output(self, seen: Tensor) -> Tensor:
        """Return the means of the normal entries and the log-odds of the others, (m, action)."""
        own = seen[:, : self._observed]
        output: Tensor = self.actor.body(self.actor.turned(own) * self.actor.inverse_scale)
        return torch.where(self._continuous, self.actor.turned_back(own, torch.tanh(output)), output)

    def _values(self, seen: Tensor) -> Tensor:
        """Return V (m,) of (m, observation and state)."""
        if self._in_ball_frame:
            own = self.actor.turned(seen[:, : self._observed])
            seen = torch.cat([own, seen[:, self._observed :]], -1)
        value: Tensor = self.critic(seen)
        return value

    def _evaluate_actions(self, output: Tensor, action: Tensor) -> tuple[Tensor, Tensor]:
        """Return log-probability and entropy, both (m,), of actions (m, action) under the policy's output."""
        log_std = self._log_std
        off = (action[:, self._normal] - output[:, self._normal]) * (-log_std).exp()
        normal = -0.5 * off.square() - log_std - _LOG_ROOT
        odds, kicks = output[:, self._thresholds], action[:, self._thresholds]
        # log sigmoid(x) = -softplus(-x), and 1 - sigmoid(x) = sigmoid(-x).
        thresholds = -softplus(-odds * kicks)
        threshold_entropy = softplus(odds) - odds * torch.sigmoid(odds)
        entropy = (log_std + 0.5 + _LOG_ROOT).sum() + threshold_entropy.sum(-1)
        return normal.sum(-1) + thresholds.sum(-1), entropy

    def _modules(self) -> tuple[tuple[str, nn.Module], ...]:
        return (
            ("actor", self.actor),
            ("critic", self.critic),
            ("spread", nn.ParameterDict({"log": self._log_std})),
        )


def orthogonal(body: nn.Module, last_gain: float, generator: torch.Generator) -> nn.Linear:
    """Make a network's weights orthogonal and its biases 0; return its last layer.

    Hidden layers have the gain sqrt(2) with which signals neither fade nor grow.
    """
    layers = [layer for layer in body.modules() if isinstance(layer, nn.Linear)]
    for layer in layers:
        gain = last_gain if layer is layers[-1] else 2.0**0.5
        nn.init.orthogonal_(layer.weight, gain, generator=generator)
        nn.init.zeros_(layer.bias)
    return layers[-1]


def _columns(which: Sequence[bool]) -> slice | Tensor:
    """Return where ``which`` is true, as a slice if that is one block, which costs no copy."""
    places = [place for place, true in enumerate(which) if true]
    first, end = (places[0], places[-1] + 1) if places else (0, 0)
    return slice(first, end) if end - first == len(places) else torch.tensor(places)


def _to_numpy(tensor: Tensor) -> Floats:
    return np.asarray(tensor.numpy(), dtype=np.float64)
