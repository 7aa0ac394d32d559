"""Training from a replay buffer: DDPG and its descendants."""

from __future__ import annotations

import numpy as np

from robobt.learning.agents.ddpg import DDPG
from robobt.learning.agents.networks import Actor, policy_of
from robobt.learning.agents.nstep import NStep
from robobt.learning.agents.replay import PrioritisedReplay, ReplayBuffer
from robobt.learning.training.checkpoint import Arrays, RunState
from robobt.learning.training.demonstrations import demonstrations_for
from robobt.learning.training.run import TrainError, TrainingRun, part


class OffPolicyRun(TrainingRun):
    """A run of :class:`~robobt.learning.agents.ddpg.DDPG`."""

    _agent: DDPG
    _returns: NStep

    def _set_up(self) -> None:
        settings, problem = self._settings, self._problem
        collection = settings.collection
        scale = problem.scale if settings.agent.scale_observations else (1.0,) * len(problem.scale)
        self._agent = DDPG(settings.agent, scale, problem.smoothed, self._agent_seed)
        self._act = policy_of(self._agent.actor)
        self._horizons: tuple[int, ...] = (settings.agent.n_step,)
        if settings.agent.one_step_weight > 0.0 and settings.agent.n_step > 1:
            self._horizons += (1,)
        self._replay = self._make_replay()
        first, last = collection.exploration_noise, collection.exploration_noise_last_env
        self._noise = np.linspace(first, first if last is None else last, collection.num_envs)[:, None]

    @property
    def _evaluated(self) -> Actor:
        return self._agent.target_actor if self._settings.evaluation.target_actor else self._agent.actor

    def _advance(self) -> None:
        """Step every environment once, and make the updates that are due."""
        collection, n = self._settings.collection, self._task.n
        share = self._share
        if self._steps < collection.random_steps:
            action = self._rng.uniform(-1.0, 1.0, (n, self._task.action_size))
        else:
            noise = self._noise * self._rng.standard_normal((n, self._task.action_size))
            action = np.clip(self._act(self._observation) + noise, -1.0, 1.0)
            if not np.isfinite(action).all():
                raise TrainError(
                    f"{self._folder.path}: the actor's action is not finite after {self._steps} steps"
                )
        step = self._task.step(action)
        done = self._returns.add(
            self._observation, action, step.reward, step.final_observation, step.terminated, step.truncated
        )
        for transitions in done:
            self._replay.add(*transitions)
        self._observation = step.observation
        before = self._steps
        self._steps += n
        rounds = self._steps // collection.train_freq - before // collection.train_freq
        if self._steps > collection.learning_starts and rounds and len(self._replay):
            final = self._settings.agent.final_learning_rate_fraction
            if final < 1.0:
                self._agent.set_learning_rates(1.0 - share * (1.0 - final))
            for _ in range(rounds * collection.gradient_steps):
                self._learn()

    def _learn(self) -> None:
        batch = self._replay.sample(self._settings.replay.batch_size, self._rng)
        errors, gradients = self._agent.update(batch, self._rng)
        if isinstance(self._replay, PrioritisedReplay):
            weight = self._settings.replay.priority.dqda_weight
            self._replay.update_priorities(batch.rows, (errors + weight * gradients).double().numpy())

    def _begin(self) -> None:
        """Fill the replay with demonstrations, and pretrain on them."""
        settings = self._settings.replay.demonstrations
        if not settings.episodes:
            return
        environment = self._settings.environment
        shown = demonstrations_for(environment, settings.episodes, settings.file, self._settings.seed)
        for transitions in shown.transitions(self._horizons, self._settings.agent.gamma):
            self._replay.add(*transitions)
        if settings.keep:
            self._replay.keep()
        for _ in range(settings.pretrain_gradient_steps):
            self._learn()

    def _rebuild(self) -> None:
        super()._rebuild()
        sizes = self._task.observation_size, self._task.action_size
        self._returns = NStep(self._horizons, self._settings.agent.gamma, self._task.n, *sizes)

    def _settle(self) -> None:
        for transitions in self._returns.flush(self._observation):
            self._replay.add(*transitions)

    def _kept(self) -> Arrays:
        return {f"replay/{key}": array for key, array in self._replay.state().items()}

    def _restore(self, arrays: Arrays, state: RunState) -> None:
        super()._restore(arrays, state)
        self._replay.restore(part(arrays, "replay/"))

    def _make_replay(self) -> ReplayBuffer:
        settings = self._settings.replay
        sizes = len(self._problem.scale), len(self._problem.smoothed), len(self._horizons)
        if not settings.priority.enabled:
            return ReplayBuffer(settings.buffer_size, *sizes)
        return PrioritisedReplay(
            settings.buffer_size,
            *sizes,
            alpha=settings.priority.alpha,
            beta=settings.priority.beta,
            epsilon=settings.priority.epsilon,
            bonus=settings.demonstrations.bonus,
        )
