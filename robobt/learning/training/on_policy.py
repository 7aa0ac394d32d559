"""Learning from rollouts, each used up at once: PPO."""

from __future__ import annotations

import numpy as np

from robobt.learning.agents.ppo import PPO, Rollout
from robobt.learning.training.clock import RunClock
from robobt.learning.training.problems import Problem
from robobt.learning.training.progress import OnProgress
from robobt.learning.training.run import Run, TrainError
from robobt.learning.training.run_folder import RunFolder
from robobt.learning.training.settings import TrainSettings


class OnPolicyRun(Run):
    """A run of :class:`~robobt.learning.agents.ppo.PPO`; it advances by whole rollouts."""

    _agent: PPO

    def __init__(
        self,
        settings: TrainSettings,
        problem: Problem,
        folder: RunFolder,
        clock: RunClock,
        on_progress: OnProgress | None,
    ) -> None:
        super().__init__(settings, problem, folder, clock, on_progress)
        self._agent = PPO(
            settings.ppo, problem.scale, problem.smoothed, self._agent_seed, problem.state_scale
        )

    def _advance(self) -> None:
        rollout = self._roll_out()
        self._agent.set_rates(1.0 - self._steps / self._settings.steps)
        self._agent.update(rollout, self._rng)
        self._steps += rollout.reward.size

    def _roll_out(self) -> Rollout:
        """Let the policy play for a while."""
        ticks, n, agent = self._settings.ppo.rollout, self._task.n, self._agent
        sizes = self._task.observation_size, self._task.action_size
        rollout = Rollout.empty(ticks, n, *sizes)
        for t in range(ticks):
            action, log_probability, value = agent.act(self._observation, self._rng)
            if not np.isfinite(action).all():
                raise TrainError(
                    f"{self._folder.path}: the policy's action is not finite after {self._steps} steps"
                )
            step = self._task.step(action)
            rollout.observation[t], rollout.action[t] = self._observation, action
            rollout.log_probability[t], rollout.value[t] = log_probability, value
            rollout.reward[t], rollout.terminated[t] = step.reward, step.terminated
            rollout.ended[t] = step.terminated | step.truncated
            if step.truncated.any():
                rollout.next_value[t, step.truncated] = agent.worth(step.final_observation[step.truncated])
            self._observation = step.observation
        # What follows where no episode has ended is the next step's.
        following = np.concatenate((rollout.value[1:], agent.worth(self._observation)[None]))
        rollout.next_value[~rollout.ended] = following[~rollout.ended]
        return rollout
