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

from collections.abc import Callable, Sequence
from typing import Literal

import numpy as np
import torch
from torch import Tensor, nn
from torch.nn.functional import softplus

from robobt.learning.agents.learner import Adam, Learner
from robobt.learning.agents.mixed_actions import MixedActions, Numbers
from robobt.learning.agents.networks import Actor, body_of
from robobt.learning.agents.rollout import Floats, Rollout, advantages
from robobt.learning.agents.settings import PPOSettings
from robobt.world.observation import Group

PolicyUpdate = Literal["improve", "keep", "imitate"]
"""What an update does to the policy."""


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
        self._actions = MixedActions(continuous)
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
    def act(self, observation: Floats, rng: np.random.Generator) -> Floats:
        """Draw actions: (n, observation and state) -> (n, action)."""
        output = self._policy_output(torch.from_numpy(observation.astype(np.float32)))
        return self._actions.draw(_rows(output), self._spread, rng).T.astype(np.float64)

    @torch.no_grad()
    def log_probabilities(self, observation: Floats, action: Floats) -> Floats:
        """Return the log-probability (n,) of actions (n, action) at (n, observation and state)."""
        output = self._in_parts(self._policy_output, observation)
        taken = action.T.astype(np.float32, order="C")
        return self._actions.log_probability(_rows(output), taken, self._spread).astype(np.float64)

    @torch.no_grad()
    def values(self, observation: Floats) -> Floats:
        """Return V of (n, observation and state), (n,)."""
        return np.asarray(self._in_parts(self._values, observation).numpy(), dtype=np.float64)

    def _in_parts(self, network: Callable[[Tensor], Tensor], observation: Floats) -> Tensor:
        """Call a network on rows in parts of a minibatch, whose layers fit in the processor's cache."""
        rows = torch.from_numpy(observation.astype(np.float32))
        return torch.cat([network(part) for part in torch.split(rows, self.settings.minibatch_size)])

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
        seen = torch.from_numpy(rollout.observation.reshape(target.size, -1).astype(np.float32))
        columns = [rollout.action, rollout.log_probability, advantage, target]
        if imitation > 0.0 and rollout.shown is not None:
            columns.append(rollout.shown)
        flat = [array.reshape(target.size, -1).T for array in columns]
        decisions = np.concatenate(flat, dtype=np.float32)
        edges, size = np.cumsum([len(part) for part in flat])[:-1], settings.minibatch_size
        for epoch in range(settings.num_epochs):
            last = epoch == settings.num_epochs - 1
            order = rng.permutation(target.size)
            minibatches = torch.split(seen[torch.from_numpy(order)], size)
            parts = np.split(decisions[:, order], range(size, target.size, size), axis=1)
            for observation, part in zip(minibatches, parts, strict=True):
                action, (old,), (gain,), (aim,), *shown = np.split(part, edges)
                if policy == "improve":
                    lesson = (shown[0], imitation) if shown else None
                    self._update_policy(observation, action, old, gain, last, lesson)
                elif policy == "imitate":
                    self._imitate(observation, action, last)
                self._update_value(observation, aim, last)
                self.updates += 1
        spread = target.var()
        if spread > 0.0:
            explained = 1.0 - (target - rollout.value).var() / spread
            self.diagnostics.add(explained_variance=torch.tensor(explained))

    @np.errstate(over="ignore", invalid="ignore")
    def _update_policy(
        self,
        seen: Tensor,
        action: Numbers,
        old: Numbers,
        advantage: Numbers,
        report: bool = False,
        lesson: tuple[Numbers, float] | None = None,
    ) -> None:
        """Take a step of (3), with a bonus for entropy; with ``report`` add to the diagnostics.

        Actions are (action, m). ``lesson`` is what a teacher shows, and the weight of imitating it.
        """
        settings, clip = self.settings, self.settings.clip_coef
        policy = self._policy_output(seen)
        output, spread = _rows(policy.detach()), self._spread
        advantage = advantage - advantage.mean()
        advantage /= np.sqrt(np.vdot(advantage, advantage) / max(len(advantage) - 1, 1)) + 1e-8
        log_ratio = self._actions.log_probability(output, action, spread) - old
        ratio = np.exp(log_ratio)
        # (3) is flat where rho has left its range on the side to which A drives it.
        free = np.where(advantage > 0.0, ratio < 1.0 + clip, ratio > 1.0 - clip)
        weight = np.where(free, ratio * advantage / -len(ratio), 0.0)
        slope, widening = self._actions.slopes(output, action, spread, weight, -settings.ent_coef)
        losses, slopes = [policy], [torch.from_numpy(slope).t()]
        if lesson is not None:
            missed, off = self._missed(policy, lesson[0])
            losses, slopes = [policy, missed], [*slopes, torch.tensor(lesson[1])]
            if report:
                self._report_imitation(missed, off)
        gradients = [*torch.autograd.grad(losses, list(self.actor.parameters()), slopes)]
        gradients.append(torch.from_numpy(widening))
        norm = self._actor_adam.clipped_step(gradients, settings.max_grad_norm)
        if report:
            gain = np.minimum(ratio * advantage, ratio.clip(1.0 - clip, 1.0 + clip) * advantage)
            self.diagnostics.add(
                policy_loss=torch.tensor(-gain.mean()),
                entropy=torch.tensor(self._actions.entropy(output, spread).mean()),
                approx_kl=torch.tensor((ratio - 1.0 - log_ratio).mean()),
                clip_fraction=torch.tensor((abs(ratio - 1.0) > clip).mean(dtype=np.float32)),
                policy_grad_norm=norm,
            )

    def _imitate(self, seen: Tensor, shown: Numbers, report: bool = False) -> None:
        """Take a step towards the actions shown: of squared errors, and of cross entropy for thresholds."""
        loss, off = self._missed(self._policy_output(seen), shown)
        # The spread is not part of this loss.
        weights = list(self.actor.parameters())
        gradients = [*torch.autograd.grad(loss, weights), torch.zeros_like(self._log_std)]
        self._actor_adam.clipped_step(gradients, self.settings.max_grad_norm)
        if report:
            self._report_imitation(loss, off)

    def _missed(self, policy: Tensor, shown: Numbers) -> tuple[Tensor, Tensor]:
        """Return the loss of imitation, and its part of squared errors (m,), of outputs (m, action)."""
        output, wanted = policy.t(), torch.from_numpy(shown)
        off = (output - wanted)[self._actions.normal].square().sum(0)
        thresholds = self._actions.thresholds
        missed = softplus(-output[thresholds] * wanted[thresholds].sign()).sum(0)
        return (off + missed).mean(), off

    def _report_imitation(self, loss: Tensor, off: Tensor) -> None:
        self.diagnostics.add(imitation_loss=loss.detach(), imitation_error=off.detach().mean().sqrt())

    def _update_value(self, seen: Tensor, target: Numbers, report: bool = False) -> None:
        """Take a step of (4); with ``report`` add to the diagnostics."""
        value = self._values(seen)
        error = value.detach() - torch.from_numpy(target)
        gradients = torch.autograd.grad(value, self._critic_adam.weights, error / len(error))
        norm = self._critic_adam.clipped_step(gradients, self.settings.max_grad_norm)
        if report:
            loss, mean = error.square().mean(), value.detach().mean()
            self.diagnostics.add(value_loss=loss, value_mean=mean, value_grad_norm=norm)

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

    @property
    def _spread(self) -> Numbers:
        return self._log_std.detach().numpy()[:, None].copy()

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


def _rows(output: Tensor) -> Numbers:
    """Return outputs (m, action) as (action, m)."""
    return np.ascontiguousarray(output.numpy().T)
