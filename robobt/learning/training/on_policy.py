"""Training from rollouts: PPO."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from robobt.learning.agents.networks import resized
from robobt.learning.agents.past_selves import PastSelves
from robobt.learning.agents.ppo import PPO, PolicyUpdate
from robobt.learning.agents.rollout import Rollout
from robobt.learning.envs import make_task
from robobt.learning.training.checkpoint import Arrays, RunState
from robobt.learning.training.imitation import Lesson
from robobt.learning.training.run import TrainError, TrainingRun, part
from robobt.learning.training.run_folder import ACTOR, load_actor, read_settings
from robobt.learning.training.settings import TrainSettings


class OnPolicyRun(TrainingRun):
    """A run of :class:`~robobt.learning.agents.ppo.PPO`, which advances by whole rollouts."""

    _agent: PPO

    def _set_up(self) -> None:
        settings, problem = self._settings, self._problem
        self._agent = PPO(
            settings.ppo,
            problem.scale,
            problem.smoothed,
            self._agent_seed,
            problem.state_scale,
            problem.vectors if settings.ppo.frame == "ball" else (),
            problem.groups if settings.ppo.network == "entities" else (),
        )

        self._past = PastSelves(settings.pool.size)
        self._lesson: Lesson | None = None

    def _begin(self) -> None:
        init = self._settings.init
        if init is not None:
            self._take_over(Path(init))
        self._remember()

    def _settle(self) -> None:
        every = self._settings.pool.every
        if self._past.taken and self._steps // every > self._past.taken[-1] // every:
            self._remember()

    def _rebuild(self) -> None:
        if self._problem.later is not None:
            self._task = self._problem.later(self._steps, self._past.decide)
        super()._rebuild()
        self._lesson = None
        if self._imitates or self._settings.imitation.weight > 0.0:
            self._lesson = Lesson(self._task, self._settings.imitation)

    @property
    def _imitates(self) -> bool:
        return self._steps < self._settings.imitation.steps

    def _kept(self) -> Arrays:
        return {f"past/{key}": array for key, array in self._past.state().items()}

    def _restore(self, arrays: Arrays, state: RunState) -> None:
        super()._restore(arrays, state)
        self._past.restore(part(arrays, "past/"), self._agent.actor.build)

    def _remember(self) -> None:
        """Add the present policy to the past selves and to the folder, where a run has any."""
        if self._problem.later is not None:
            self._folder.keep(self._past.add(self._agent.actor, self._steps), self._steps)

    def _take_over(self, folder: Path) -> None:
        """Begin with the best policy of a finished run; entries it did not observe get weights of 0."""
        if not (folder / ACTOR).is_file():
            raise TrainError(f"init: {folder} is not the folder of a finished run")
        given, own = load_actor(folder / ACTOR), self._agent.actor
        if given.build.get("vectors") != own.build.get("vectors"):
            raise TrainError(f"init: the policy of {folder} was trained in another frame, see ppo.frame")
        if own.groups:
            try:
                given = resized(given, own.build["scale"], own.groups)
            except ValueError as error:
                raise TrainError(f"init: the policy of {folder}: {error}") from error
            if given.build != own.build:
                raise TrainError(f"init: the policy of {folder} has other layers: {given.build['hidden']}")
            own.load_state_dict(given.state_dict())
            return
        seen, sees = _seen(read_settings(folder)), _seen(self._settings)
        known = [k for k, name in enumerate(sees) if name in seen]
        scale = [own.build["scale"][k] for k in known]
        if [sees[k] for k in known] != seen or given.build != {**own.build, "scale": scale}:
            raise TrainError(
                f"init: the policy of {folder} observes {len(seen)} entries with layers of "
                f"{given.build['hidden']}, this run's {len(sees)} with {own.build['hidden']}, "
                "or entries of other names or scales"
            )
        weights = given.state_dict()
        for name in ("inverse_scale", "body.0.weight"):
            whole = own.state_dict()[name].clone()
            if whole.ndim == 2:
                whole[:] = 0.0
            whole[..., known] = weights[name]
            weights[name] = whole
        own.load_state_dict(weights)

    def _advance(self) -> None:
        weight = self._settings.imitation.weight
        if not self._imitates and weight == 0.0:
            self._lesson = None
        rollout = self._roll_out()
        share = self._share
        self._agent.set_learning_rates(1.0 - share)
        self._agent.anneal_gamma(share)
        policy: PolicyUpdate = "improve"
        if self._imitates:
            policy = "imitate"
        elif self._steps < self._settings.ppo.critic_warmup_steps:
            policy = "keep"
        self._agent.update(rollout, self._rng, policy, (1.0 - share) * weight)
        self._steps += rollout.reward.size

    def _roll_out(self) -> Rollout:
        """Collect a rollout."""
        ticks, n, agent = self._settings.ppo.num_steps, self._task.n, self._agent
        sizes = self._task.observation_size, self._task.action_size
        rollout = Rollout.empty(ticks, n, *sizes)
        lesson = self._lesson
        if lesson is not None:
            lesson.share_out(self._steps, self._rng)
            rollout.shown = np.zeros_like(rollout.action)
        truncated, last = np.zeros((ticks, n), dtype=np.bool_), []
        for t in range(ticks):
            action = agent.act(self._observation, self._rng)
            if not np.isfinite(action).all():
                raise TrainError(
                    f"{self._folder.path}: the policy's action is not finite after {self._steps} steps"
                )
            done = action
            if lesson is not None and rollout.shown is not None:
                rollout.shown[t], done = lesson.next(action)
                if self._imitates:
                    action = rollout.shown[t]
            step = self._task.step(done)
            if lesson is not None:
                lesson.begin(step)
            rollout.observation[t], rollout.action[t] = self._observation, action
            rollout.reward[t], rollout.terminated[t] = step.reward, step.terminated
            rollout.ended[t] = step.terminated | step.truncated
            truncated[t] = step.truncated
            last.append(step.final_observation[step.truncated])
            self._observation = step.observation
        # Weighing all steps at once is quicker than each.
        seen, done = (steps.reshape(ticks * n, -1) for steps in (rollout.observation, rollout.action))
        rollout.log_probability[:] = agent.log_probabilities(seen, done).reshape(ticks, n)
        values = agent.values(np.concatenate([seen, self._observation, *last]))
        following = values[n : ticks * n + n].reshape(ticks, n)
        rollout.value[:], rollout.next_value[:] = values[: ticks * n].reshape(ticks, n), following
        # Where no episode has ended the next value is that of the next step.
        rollout.next_value[truncated] = values[ticks * n + n :]
        return rollout


def _seen(settings: TrainSettings) -> list[str]:
    """Return the names of the observation's entries in such a run."""
    return [entry.name for entry in make_task(settings.environment, 1).observation.entries]
