"""Stable-Baselines3's DDPG, TD3, SAC and PPO on robobt's environments, judged as robobt's own learner is.

    pip install stable-baselines3
    python benchmarks/sb3_peers.py go_to_ball --seeds 5 --out runs/sb3

They train with their own defaults, DDPG and TD3 with the exploration noise of Spinning Up, in one
environment or in one simulator with many arenas (``--arenas``), for as many environment steps as
the preset ``fast`` may take at most. The best actor by the validation starts plays the held-out
starts and is written as a model file, which is a skill like any other:
``GoToBall(policy="runs/sb3/go_to_ball_sb3_td3_0.pt")``.
"""

from __future__ import annotations

import argparse
import json
import time
from copy import deepcopy
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import stable_baselines3
import torch
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.noise import NormalActionNoise
from torch import nn

import robobt
from robobt.config.atomic import write_atomically
from robobt.config.commit import source_commit
from robobt.learning.envs.stable_baselines3 import ArenasVecEnv
from robobt.learning.training.evaluation import Policy
from robobt.learning.training.export_run import held_out
from robobt.learning.training.problems import Problem, problem_of
from robobt.learning.training.settings import environment_of, load_settings
from robobt.models.card import ModelCard, ObservationCard, action_outputs
from robobt.models.export import export_model
from robobt.world.features import GO_TO_BALL, SHOOT

ALGORITHMS = {
    "ddpg": stable_baselines3.DDPG,
    "td3": stable_baselines3.TD3,
    "sac": stable_baselines3.SAC,
    "ppo": stable_baselines3.PPO,
}
NOISE = 0.1
TASKS = {
    "go_to_ball": ("GoToBall-v0", "GoToBall", GO_TO_BALL),
    "shoot": ("ShootTowardsGoal-v0", "Shoot", SHOOT),
}


def main() -> None:
    """Train, and write model files and ``peers.json``."""
    parser = argparse.ArgumentParser(description="Stable-Baselines3 on robobt's environments")
    parser.add_argument("task", choices=sorted(TASKS))
    parser.add_argument("--algorithms", nargs="+", choices=sorted(ALGORITHMS), default=["ddpg", "td3"])
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--steps", type=int, help="environment steps; by default those of the preset fast")
    parser.add_argument("--arenas", type=int, default=1, help="how many are stepped together")
    parser.add_argument("--every", type=int, default=20_000, help="steps between evaluations")
    parser.add_argument("--starts", type=int, default=1000, help="held-out starts")
    parser.add_argument("--out", type=Path, default=Path("runs/sb3"))
    given = parser.parse_args()
    steps = given.steps or load_settings(given.task, "fast").steps
    runs: list[dict[str, Any]] = []
    for algorithm in given.algorithms:
        for seed in range(given.seeds):
            figures = train_peer(
                given.task, algorithm, seed, steps, given.every, given.starts, given.out, given.arenas
            )
            runs.append(figures)
            print(json.dumps(figures), flush=True)
            write_atomically(given.out / "peers.json", (json.dumps(runs, indent=2) + "\n").encode())


def train_peer(
    task: str, algorithm: str, seed: int, steps: int, every: int, starts: int, out: Path, arenas: int = 1
) -> dict[str, Any]:
    """Train one agent and write its best actor as a model file into ``out``.

    Returns:
        ``task``, ``algorithm``, ``seed``, ``steps``, ``cpu_s`` (without evaluations), ``to_99`` (steps and
        CPU seconds to 99 % of the validation starts, None where that was never reached), ``file`` and
        ``held_out``, as on the model's card.
    """
    torch.set_num_threads(1)
    environment = environment_of(load_settings(task))
    problem = problem_of(environment)
    name, skill, observation = TASKS[task]
    envs: Any = (
        gymnasium.make(name, settings=environment)
        if arenas == 1
        else ArenasVecEnv(
            gymnasium.make_vec(name, arenas, vectorization_mode="vector_entry_point", settings=environment)
        )
    )
    actions = len(problem.smoothed)
    noise = NormalActionNoise(np.zeros(actions), np.full(actions, NOISE))
    agent = ALGORITHMS[algorithm](
        "MlpPolicy",
        envs,
        seed=seed,
        device="cpu",
        **({"action_noise": noise} if algorithm in ("ddpg", "td3") else {}),
    )
    evaluator = _Evaluator(problem, every)
    agent.learn(steps, callback=evaluator)
    evaluator.evaluate()
    figures = held_out(problem.evaluate(_policy(evaluator.best), "held_out", starts))
    action = environment.action
    card = ModelCard(
        kind="policy",
        name=f"{task}_sb3_{algorithm}_{seed}",
        skill=skill,
        description=f"{skill}, trained by Stable-Baselines3's {algorithm.upper()}.",
        observation=ObservationCard.of(observation),
        outputs=action_outputs(action),
        action=action,
        period=environment.period,
        limits=environment.robot_limits,
        environment=environment.model_dump(mode="json"),
        training={"algorithm": algorithm, "steps": steps, "stable_baselines3": stable_baselines3.__version__},
        seed=seed,
        held_out=figures,
        code_version=robobt.__version__,
        code_commit=source_commit(),
        created_by="benchmarks/sb3_peers.py",
    )
    (file,) = export_model(evaluator.best, card, out)
    return {
        "task": task,
        "algorithm": algorithm,
        "seed": seed,
        "steps": evaluator.num_timesteps,
        "cpu_s": round(evaluator.cpu_s, 1),
        "to_99": evaluator.to_99,
        "file": str(file),
        "held_out": {key: one.model_dump(mode="json") for key, one in figures.items()},
    }


def actor_of(agent: Any) -> nn.Module:
    """Return the part of an agent's policy that maps raw observations to actions in [-1, 1].

    Flattening and scaling, which a policy has besides, do nothing to a vector within its bounds.
    """
    policy = agent.policy
    if isinstance(agent, stable_baselines3.PPO):
        # The mean of a Gaussian; PPO clips what it draws.
        return nn.Sequential(policy.mlp_extractor.policy_net, policy.action_net, nn.Hardtanh())
    if isinstance(agent, stable_baselines3.SAC):
        return nn.Sequential(policy.actor.latent_pi, policy.actor.mu, nn.Tanh())
    network: nn.Module = policy.actor.mu
    return network


class _Evaluator(BaseCallback):
    """Plays the validation starts now and then and keeps the best actor, by success and then time."""

    best: nn.Module

    def __init__(self, problem: Problem, every: int) -> None:
        super().__init__()
        self._problem = problem
        self._every = every
        self._score = (-1.0, 0.0)
        self._evaluated = 0
        self._begun = time.process_time()
        self._evaluation_s = 0.0
        self.to_99: dict[str, float] | None = None

    @property
    def cpu_s(self) -> float:
        """CPU time of collecting and learning."""
        return time.process_time() - self._begun - self._evaluation_s

    def evaluate(self) -> None:
        """Evaluate the actor as it is now."""
        spent, begun = self.cpu_s, time.process_time()
        network = deepcopy(actor_of(self.model))
        figures = self._problem.evaluate(_policy(network), "validation", 300)
        score = (figures.rate, -figures.mean_time if figures.mean_time is not None else float("-inf"))
        if score > self._score:
            self._score, self.best = score, network
        if figures.rate >= 0.99 and self.to_99 is None:
            self.to_99 = {"steps": self.num_timesteps, "cpu_s": round(spent, 1)}
        self._evaluation_s += time.process_time() - begun

    def _on_step(self) -> bool:
        if self.num_timesteps // self._every > self._evaluated:
            self._evaluated = self.num_timesteps // self._every
            self.evaluate()
        return True


def _policy(network: nn.Module) -> Policy:
    def act(observation: np.ndarray) -> np.ndarray:
        with torch.no_grad():
            return network(torch.from_numpy(observation.astype(np.float32))).numpy().astype(np.float64)

    return act


if __name__ == "__main__":
    main()
