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

V may be told more than the policy is, for it is needed in training alone. Of several robots that learn one
policy a *central* V sees all of them (Yu et al., "The surprising effectiveness of PPO in cooperative
multi-agent games", 2022): then s above is what the robot sees followed by the state, and the policy takes
the first part alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor, nn
from torch.nn.functional import softplus

from robobt.learning.agents.learner import Learner
from robobt.learning.agents.networks import Actor, mlp
from robobt.learning.agents.optimiser import Adam
from robobt.learning.agents.settings import PPOSettings

Floats = NDArray[np.float64]

_LOG_ROOT = 0.5 * float(np.log(2.0 * np.pi))


@dataclass(slots=True)
class Rollout:
    """Steps of ``n`` arenas, T of each.

    Attributes:
        observation: (T, n, O) what was seen, by the policy first and then by the value alone.
        action: (T, n, A) what was done, as drawn.
        log_probability: (T, n) of it.
        value: (T, n) V of what was seen.
        next_value: (T, n) V of what the step led to; whatever where the episode has terminated.
        reward: (T, n).
        terminated: (T, n) the episode ended in a state from which nothing follows.
        ended: (T, n) the episode ended, whatever the reason.
    """

    observation: Floats
    action: Floats
    log_probability: Floats
    value: Floats
    next_value: Floats
    reward: Floats
    terminated: NDArray[np.bool_]
    ended: NDArray[np.bool_]

    @classmethod
    def empty(cls, ticks: int, n: int, observations: int, actions: int) -> Rollout:
        """Return one to be filled."""

        def numbers() -> Floats:
            return np.zeros((ticks, n))

        def flags() -> NDArray[np.bool_]:
            return np.zeros((ticks, n), dtype=np.bool_)

        seen, done = np.zeros((ticks, n, observations)), np.zeros((ticks, n, actions))
        return cls(seen, done, numbers(), numbers(), numbers(), numbers(), flags(), flags())


class Value(nn.Module):
    """V: what a state is worth; arguments as for :class:`Actor`."""

    inverse_scale: Tensor

    def __init__(self, scale: Sequence[float], hidden: Sequence[int], generator: torch.Generator) -> None:
        super().__init__()
        self.register_buffer("inverse_scale", 1.0 / torch.tensor(list(scale), dtype=torch.float32))
        self.body = mlp([len(scale), *hidden, 1], False, generator, "tanh")
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
        smooth: (action,) which entries are normal; the others are thresholds at 0.
        seed: of the initial weights.
        state_scale: (state,) typical sizes of what follows the observation for the value alone.
        vectors: of the observation, where the policy is asked in another frame; see :class:`Actor`.
    """

    def __init__(
        self,
        settings: PPOSettings,
        scale: Sequence[float],
        smooth: Sequence[bool],
        seed: int,
        state_scale: Sequence[float] = (),
        vectors: Sequence[int] = (),
    ) -> None:
        super().__init__()
        self.settings = settings
        generator = torch.Generator().manual_seed(seed)
        self.actor = Actor(scale, len(smooth), settings.hidden_sizes, False, generator, "tanh", vectors)
        self.critic = Value([*scale, *state_scale], settings.hidden_sizes, generator)
        self._own, self._turns = len(scale), bool(vectors)
        self._smooth = torch.tensor(list(smooth))
        self._gamma = settings.gamma
        self._spread = nn.ParameterDict(
            {"log": nn.Parameter(torch.full((sum(smooth),), float(np.log(settings.init_std))))}
        )
        # So that all directions are alike at first, and kicks rare.
        last = orthogonal(self.actor.body, 0.01, generator)
        with torch.no_grad():
            last.bias.copy_(torch.where(self._smooth, 0.0, settings.threshold_bias))
        weights = [*self.actor.parameters(), *self._spread.parameters()]
        self._actor_adam = Adam(weights, settings.learning_rate, eps=1e-5)
        self._critic_adam = Adam(list(self.critic.parameters()), settings.learning_rate, eps=1e-5)

    @torch.no_grad()
    def act(self, observation: Floats, rng: np.random.Generator) -> tuple[Floats, Floats, Floats]:
        """Draw actions: (n, observation and state) -> (n, action), log-probabilities (n,), values (n,)."""
        seen = torch.from_numpy(observation.astype(np.float32))
        output = self._decided(seen)
        noise = torch.from_numpy(rng.standard_normal((len(seen), len(self._spread["log"])), np.float32))
        toss = torch.from_numpy(rng.random((len(seen), int((~self._smooth).sum())), np.float32))
        action = torch.empty_like(output)
        action[:, self._smooth] = output[:, self._smooth] + self._spread["log"].exp() * noise
        kicks = toss < torch.sigmoid(output[:, ~self._smooth])
        action[:, ~self._smooth] = torch.where(kicks, 1.0, -1.0)
        log_probability, _ = self._weigh(output, action)
        return (_doubles(action), _doubles(log_probability), _doubles(self._valued(seen)))

    @torch.no_grad()
    def worth(self, observation: Floats) -> Floats:
        """Return V of (n, observation and state), (n,)."""
        return _doubles(self._valued(torch.from_numpy(observation.astype(np.float32))))

    def look_ahead(self, share: float) -> None:
        """Discount as after a ``share`` of the steps: patience is learned after what pays at once."""
        first, last = self.settings.gamma, self.settings.final_gamma
        if last is not None:
            self._gamma = 1.0 - 1.0 / ((1.0 - share) / (1.0 - first) + share / (1.0 - last))

    def update(self, rollout: Rollout, rng: np.random.Generator, value_alone: bool = False) -> None:
        """Learn from a rollout by (3) and (4), or with ``value_alone`` by (4) only.

        Diagnostics are those of the last epoch, in which the policy is farthest from the one that acted.
        """
        settings = self.settings
        advantage = advantages(rollout, self._gamma, settings.gae_lambda)
        target = advantage + rollout.value
        observation, action, log_probability, advantage_, target_ = (
            torch.from_numpy(array.reshape(-1, *array.shape[2:]).astype(np.float32))
            for array in (rollout.observation, rollout.action, rollout.log_probability, advantage, target)
        )
        for epoch in range(settings.num_epochs):
            last = epoch == settings.num_epochs - 1
            order = torch.from_numpy(rng.permutation(len(action)))
            for rows in torch.split(order, settings.minibatch_size):
                if not value_alone:
                    old, gain = log_probability[rows], advantage_[rows]
                    self._update_policy(observation[rows], action[rows], old, gain, last)
                self._update_value(observation[rows], target_[rows], last)
                self.updates += 1
        spread = target.var()
        if spread > 0.0:
            explained = 1.0 - (target - rollout.value).var() / spread
            self.diagnostics.add(explained_variance=torch.tensor(explained))

    def _update_policy(
        self, seen: Tensor, action: Tensor, old: Tensor, advantage: Tensor, report: bool = False
    ) -> None:
        """Take a step of (3), with a bonus for entropy; with ``report`` add to the diagnostics."""
        settings = self.settings
        output = self._decided(seen)
        log_probability, entropy = self._weigh(output, action)
        advantage = (advantage - advantage.mean()) / (advantage.std() + 1e-8)
        log_ratio = log_probability - old
        ratio = log_ratio.exp()
        clipped = ratio.clamp(1.0 - settings.clip_coef, 1.0 + settings.clip_coef)
        gain = torch.minimum(ratio * advantage, clipped * advantage).mean()
        mean_entropy = entropy.mean()
        loss = -gain - settings.ent_coef * mean_entropy
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

    def _update_value(self, seen: Tensor, target: Tensor, report: bool = False) -> None:
        """Take a step of (4); with ``report`` add to the diagnostics."""
        value = self._valued(seen)
        loss = (value - target).square().mean()
        weights = self._critic_adam.weights
        gradients = torch.autograd.grad(0.5 * loss, weights)
        norm = self._critic_adam.clipped_step(gradients, self.settings.max_grad_norm)
        if report:
            mean = value.detach().mean()
            self.diagnostics.add(value_loss=loss.detach(), value_mean=mean, value_grad_norm=norm)

    def _decided(self, seen: Tensor) -> Tensor:
        """Return the means of normal entries and log-odds of the others, (m, action)."""
        own = seen[:, : self._own]
        output: Tensor = self.actor.body(self.actor.turned(own) * self.actor.inverse_scale)
        return torch.where(self._smooth, self.actor.turned_back(own, torch.tanh(output)), output)

    def _valued(self, seen: Tensor) -> Tensor:
        """Return V (m,) of (m, observation and state)."""
        if self._turns:
            own = self.actor.turned(seen[:, : self._own])
            seen = torch.cat([own, seen[:, self._own :]], -1)
        value: Tensor = self.critic(seen)
        return value

    def _weigh(self, output: Tensor, action: Tensor) -> tuple[Tensor, Tensor]:
        """Return log-probability and entropy, both (m,), of actions (m, action), given what was decided."""
        log_spread = self._spread["log"]
        off = (action[:, self._smooth] - output[:, self._smooth]) * (-log_spread).exp()
        normal = -0.5 * off.square() - log_spread - _LOG_ROOT
        odds, kicks = output[:, ~self._smooth], action[:, ~self._smooth]
        # log sigmoid(x) = -softplus(-x), and 1 - sigmoid(x) = sigmoid(-x).
        coins = -softplus(-odds * kicks)
        tossed = softplus(odds) - odds * torch.sigmoid(odds)
        entropy = (log_spread + 0.5 + _LOG_ROOT).sum() + tossed.sum(-1)
        return normal.sum(-1) + coins.sum(-1), entropy

    def _modules(self) -> tuple[tuple[str, nn.Module], ...]:
        return (("actor", self.actor), ("critic", self.critic), ("spread", self._spread))


def orthogonal(body: nn.Sequential, last_gain: float, generator: torch.Generator) -> nn.Linear:
    """Make a network's weights orthogonal and its biases 0; return its last layer.

    Hidden layers have the gain sqrt(2) with which signals neither fade nor grow.
    """
    layers = [layer for layer in body if isinstance(layer, nn.Linear)]
    for layer in layers:
        gain = last_gain if layer is layers[-1] else 2.0**0.5
        nn.init.orthogonal_(layer.weight, gain, generator=generator)
        nn.init.zeros_(layer.bias)
    return layers[-1]


def advantages(rollout: Rollout, gamma: float, gae_lambda: float) -> Floats:
    """Compute (1) and (2), (T, n)."""
    delta = rollout.reward + gamma * rollout.next_value * ~rollout.terminated - rollout.value
    result = np.zeros_like(delta)
    later = np.zeros(delta.shape[1])
    for t in reversed(range(len(delta))):
        later = delta[t] + gamma * gae_lambda * later * ~rollout.ended[t]
        result[t] = later
    return result


def _doubles(tensor: Tensor) -> Floats:
    return np.asarray(tensor.numpy(), dtype=np.float64)
