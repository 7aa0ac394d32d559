"""Tasks small enough to know the answer of, with the interface of the real ones."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import torch

from robobt.learning.agents.ddpg import DDPG
from robobt.learning.agents.nstep import Transitions
from robobt.learning.agents.replay import ReplayBuffer
from robobt.learning.agents.settings import AgentSettings
from robobt.learning.envs import StepResult
from robobt.learning.training.problems import Problem, split_seed
from robobt.learning.training.progress import TrainingProgress
from robobt.learning.training.results import Evaluation, TrainResult
from robobt.learning.training.settings import TrainSettings, settings_of
from robobt.learning.training.train import train

torch.set_num_threads(1)

PERIOD = 0.1
REACH = 0.1
LIMIT = 25


class Slide:
    """A point on a line that is to be brought to the middle: velocity command, 1 m/s at most.

    The observation is its place [m] and its velocity before [m/s].
    """

    observation_size, action_size = 2, 1

    def __init__(self, n: int) -> None:
        self.n = n
        self._rng = np.random.default_rng(0)

    def reset(self, seed: int | None = None) -> np.ndarray:
        if seed is not None:
            self._rng = np.random.default_rng(seed)
        self._state = np.zeros((self.n, 2))
        self._ticks = np.zeros(self.n, dtype=np.int64)
        self._begin(np.ones(self.n, dtype=np.bool_))
        return self._state.copy()

    def step(self, actions: np.ndarray) -> StepResult:
        self._state[:, 1] = np.clip(actions[:, 0], -1.0, 1.0)
        self._state[:, 0] += PERIOD * self._state[:, 1]
        self._ticks += 1
        success = np.abs(self._state[:, 0]) < REACH
        truncated = ~success & (self._ticks >= LIMIT)
        final = self._state.copy()
        reward = np.where(success, 1.0, -0.3 * np.abs(final[:, 0]))
        self._begin(success | truncated)
        return StepResult(self._state.copy(), reward, success, truncated, final, success)

    def _begin(self, which: np.ndarray) -> None:
        count = int(which.sum())
        self._state[which, 0] = self._rng.uniform(0.3, 1.5, count) * self._rng.choice((-1.0, 1.0), count)
        self._state[which, 1] = 0.0
        self._ticks[which] = 0


def _evaluate(policy, split, starts) -> Evaluation:
    task = Slide(starts)
    observation = task.reset(split_seed(split))
    optimum = (np.abs(observation[:, 0]) - REACH) / 1.0
    times, done = np.full(starts, np.nan), np.zeros(starts, dtype=np.bool_)
    for tick in range(1, LIMIT + 1):
        step = task.step(policy(observation))
        times[step.success & ~done & np.isnan(times)] = tick * PERIOD
        done |= step.success | step.truncated
        observation = step.observation
    return Evaluation(np.isfinite(times), times, optimum, np.zeros(starts))


SLIDE = Problem(Slide, _evaluate, (1.0, 1.0), (True,))


def slide_settings(**changes) -> TrainSettings:
    """A run of a second or less."""
    data = {
        "task": "go_to_ball",  # runs need the name of a task; what is learned is given as a problem
        "steps": 1920,
        "agent": {
            "hidden_sizes": (32,),
            "gamma": 0.9,
            "tau": 0.1,
            "n_step": 3,
            "critic_learning_rate": 5e-3,
            "actor_learning_rate": 1e-3,
        },
        "replay": {"batch_size": 32, "buffer_size": 1000},
        "collection": {
            "num_envs": 8,
            "random_steps": 320,
            "learning_starts": 160,
            "train_freq": 16,
            "gradient_steps": 1,
        },
        "evaluation": {"every": 480, "starts": 20, "held_out": 30},
        "rebuild_every": 320,
        "checkpoint_seconds": 0.0,
        "tensorboard": False,
    }
    for name, value in changes.items():
        group, _, key = name.rpartition("__")
        (data[group] if group else data)[key] = value
    return settings_of(data, "tiny")


class BrokenOffError(Exception):
    """Breaks a run off."""


def broken_off_and_resumed(settings: TrainSettings, folder: Path, steps: int) -> TrainResult:
    """Break a run off after some steps; return what it comes to when it is resumed."""

    def stop(progress: TrainingProgress) -> None:
        if progress.steps >= steps:
            raise BrokenOffError

    with pytest.raises(BrokenOffError):
        train(settings, folder, on_progress=stop)
    return train(settings, folder, resume=True)


def draw_no_curves(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave out the picture of a run, which takes longer than a tiny training."""
    for module in ("run_folder", "train"):
        monkeypatch.setattr(f"robobt.learning.training.{module}.draw_curves", lambda *_: None)


def small_agent(observation: int, actions: int, seed: int = 0, **settings) -> DDPG:
    """An agent with small hidden layers that learns quickly."""
    fast = {
        "hidden_sizes": (32, 32),
        "actor_learning_rate": 2e-3,
        "critic_learning_rate": 5e-3,
        "tau": 0.1,
        "gamma": 0.9,
    }
    return DDPG(AgentSettings(**(fast | settings)), (1.0,) * observation, (True,) * actions, seed)


def learn(
    agent: DDPG, transitions: Transitions, updates: int, batch: int = 64, seed: int = 0, decay: bool = False
) -> None:
    """Updates on batches of given transitions, with rates that fall to nothing if asked to."""
    sizes = transitions.observation.shape[1], transitions.action.shape[1]
    replay = ReplayBuffer(len(transitions.reward), *sizes)
    replay.add(transitions)
    rng = np.random.default_rng(seed)
    for done in range(updates):
        if decay:
            agent.set_learning_rates(1.0 - done / updates)
        agent.update(replay.sample(batch, rng), rng)
