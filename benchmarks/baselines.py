"""Every task of the suite by PPO and TD3 of robobt, and by PPO, SAC and TD3 of Stable-Baselines3.

    pip install "robobt[sb3]"
    python -m benchmarks baselines --seeds 5 --out runs/baselines
    python -m benchmarks baselines --out runs/baselines --table --curves baselines.svg

A cell is a task, an algorithm and a seed. All learn in the same environment for the same CPU seconds of
collecting and learning, are evaluated on the same validation starts without noise, and the best policy by
those plays the held-out starts. A finished cell is a line of ``OUT/baselines.jsonl`` and a model file in
``OUT/models``; what is there is not trained again, so that a run that was broken off goes on.

An algorithm has the same settings in every task. Robobt's are those of its presets (PPO ``fast`` of the
tasks of several robots, TD3 ``td3`` of Shoot), Stable-Baselines3's its defaults but for what many arenas
need. Where several robots learn in an arena, each is a row of the rollout or replay, with its own reward.
"""

from __future__ import annotations

import argparse
from copy import deepcopy
from functools import cached_property
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, cast

import gymnasium
import numpy as np
from torch import nn

import robobt
from benchmarks.baselines_report import add_cell, draw, read_cells, table
from robobt.config.commit import source_commit
from robobt.config.extras import need
from robobt.learning import TaskSettings
from robobt.learning.agents.networks import one_thread, policy_of
from robobt.learning.envs import find_task, make_task
from robobt.learning.envs.soccer.settings import SoccerSettings
from robobt.learning.envs.soccer.suite import against
from robobt.learning.tasks import environment_id
from robobt.learning.training.export_run import held_out
from robobt.learning.training.off_policy import OffPolicyRun
from robobt.learning.training.on_policy import OnPolicyRun
from robobt.learning.training.preset_files import merged, read_preset
from robobt.learning.training.problems import Problem, problem_of
from robobt.learning.training.progress import RunClock
from robobt.learning.training.run import TrainingRun
from robobt.learning.training.run_folder import RunFolder
from robobt.learning.training.settings import settings_of
from robobt.models import ModelCard, ObservationCard, action_outputs, export_model

if TYPE_CHECKING:
    from robobt.learning.envs.gymnasium_base import TaskVectorEnv

TASKS = {
    "GoToBall": "go_to_ball",
    "Shoot": "shoot",
    "Save": "save",
    "Receive": "receive",
    "ScoreOnGoalkeeper": "score_on_goalkeeper",
    "ScoreOnGoalkeeperAndDefenders": "score_on_goalkeeper_and_defenders",
    "Duel": "duel",
    "GoToBallAmongRobots": "go_to_ball_among_robots",
    "Pass": "pass",
    "Redirect": "redirect",
    "Keepaway": "keepaway",
    "ScoreOnGoalkeeperAndTwoDefenders": "score_on_goalkeeper_and_two_defenders",
    "Attack3v2": "attack3v2",
    "Small3v3": "small3v3",
}
ALGORITHMS = {"ppo": "PPO", "td3": "TD3", "sb3_ppo": "SB3 PPO", "sb3_sac": "SB3 SAC", "sb3_td3": "SB3 TD3"}

ROWS = {"ppo": 192, "td3": 48, "sac": 48}
"""Learners that step together, of whole arenas: many for rollouts, fewer between updates from a replay."""
PRESETS = {"ppo": ("small3v3", "fast"), "td3": ("shoot", "td3")}
NOISE = 0.1


def main() -> None:
    """Train what is not there yet, or show what is."""
    parser = argparse.ArgumentParser(description="every task by PPO, SAC and TD3")
    parser.add_argument("--task", action="append", choices=list(TASKS), help="all by default")
    parser.add_argument("--algorithm", action="append", choices=list(ALGORITHMS), help="all by default")
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--cpu-seconds", type=float, default=30.0, help="of collecting and learning, a cell")
    parser.add_argument("--parts", type=int, default=5, help="evaluations on the way")
    parser.add_argument("--validation", type=int, default=100, help="starts of each of them")
    parser.add_argument("--starts", type=int, default=1000, help="held-out starts of the best policy")
    parser.add_argument("--out", type=Path, default=Path("runs/baselines"))
    parser.add_argument("--table", action="store_true", help="print what is there")
    parser.add_argument("--curves", type=Path, help="draw what is there: .svg, .png or .pdf")
    given = parser.parse_args()
    file = given.out / "baselines.jsonl"
    there_are = read_cells(file)
    cells = [cell for cell in there_are if cell["cpu_seconds"] == given.cpu_seconds]
    if (given.table or given.curves) and not cells:
        budgets = ", ".join(f"{budget:g}" for budget in sorted({cell["cpu_seconds"] for cell in there_are}))
        other = f"; there are some of {budgets}: give --cpu-seconds" if budgets else ""
        parser.error(f"{file}: has no cells of {given.cpu_seconds:g} CPU seconds{other}")
    if given.table:
        print(table(cells, list(TASKS), ALGORITHMS))
    if given.curves:
        draw(cells, list(TASKS), ALGORITHMS, given.curves)
    if given.table or given.curves:
        return
    there = {(cell["task"], cell["algorithm"], cell["seed"]) for cell in cells}
    given.out.mkdir(parents=True, exist_ok=True)
    for seed in range(given.seeds):
        for task in given.task or TASKS:
            for algorithm in given.algorithm or ALGORITHMS:
                if (task, algorithm, seed) in there:
                    continue
                with one_thread():
                    cell = train_cell(task, algorithm, seed, given)
                add_cell(file, cell)
                reached = cell["held_out"]["success"]["value"]
                print(f"{task:33}{ALGORITHMS[algorithm]:8} seed {seed}: {reached:.1%}", flush=True)


def train_cell(task: str, algorithm: str, seed: int, given: argparse.Namespace) -> dict[str, Any]:
    """Train one agent and write its best policy as a model file.

    Returns:
        What the line is to say: ``cpu_seconds`` is the budget, ``steps`` and ``cpu_s`` are what was spent,
        ``curve`` is explained at :class:`Curve`, ``held_out`` is as on the model's card.
    """
    kind = find_task(TASKS[task])
    environment = kind.Settings()
    judged = against(environment, "attack") if isinstance(environment, SoccerSettings) else environment
    problem = problem_of(environment, held_out=judged, validated=(judged,))
    curve = Curve(problem, given.cpu_seconds, given.parts, given.validation)
    if algorithm in PRESETS:
        settings = train_ours(task, algorithm, seed, problem, curve)
    else:
        settings = train_sb3(task, algorithm.removeprefix("sb3_"), seed, environment, curve)
    figures = held_out(problem.evaluate(policy_of(curve.best), "held_out", given.starts))
    card = ModelCard(
        kind="policy",
        name=f"{TASKS[task]}_{algorithm}_{seed}",
        skill=kind.played_by,
        description=f"{task}, trained by {ALGORITHMS[algorithm]} for {given.cpu_seconds:g} CPU seconds.",
        observation=ObservationCard.of(make_task(environment, 1).observation),
        outputs=action_outputs(environment.action),
        action=environment.action,
        period=environment.period * environment.decide_every,
        limits=environment.robot_limits,
        algorithm=algorithm,
        environment=environment.model_dump(mode="json"),
        training=settings,
        seed=seed,
        held_out=figures,
        code_version=robobt.__version__,
        code_commit=source_commit(),
        created_by="benchmarks/baselines.py",
    )
    (model,) = export_model(curve.best, card, given.out / "models", force=True)
    steps, cpu_s = curve.points[-1][:2]
    return {
        "task": task,
        "algorithm": algorithm,
        "seed": seed,
        "cpu_seconds": given.cpu_seconds,
        "steps": steps,
        "cpu_s": cpu_s,
        "curve": curve.points,
        "held_out": {key: one.model_dump(mode="json") for key, one in figures.items()},
        "model": str(model),
        "settings": settings,
        "robobt": robobt.__version__,
        "commit": source_commit(),
    }


class Curve:
    """What a policy did on the way: the validation starts, in equal parts of the CPU seconds.

    Attributes:
        points: (steps, CPU seconds, success, mean time of the successes [s]) of each evaluation.
        best: a copy of the best policy, by success and then time.
    """

    best: nn.Module

    def __init__(self, problem: Problem, budget_s: float, parts: int, starts: int) -> None:
        self._problem, self._budget_s, self._parts, self._starts = problem, budget_s, parts, starts
        self._score, self._part = (-1.0, 0.0), -1
        self.points: list[tuple[int, float, float, float | None]] = []

    @cached_property
    def clock(self) -> RunClock:
        """Begins with the first evaluation, which also compiles what has to be compiled."""
        return RunClock()

    @property
    def share(self) -> float:
        """How much of the budget is spent."""
        return min(self.clock.cpu_s / self._budget_s, 1.0)

    def pass_by(self, steps: int, network: nn.Module) -> None:
        """Evaluate the policy if it is time to."""
        spent = self.clock.cpu_s
        part = int(min(spent / self._budget_s, 1.0) * self._parts)
        if part <= self._part:
            return
        self._part = part
        with self.clock.evaluating():
            figures = self._problem.evaluate(policy_of(network), "validation", self._starts)
            score = (figures.rate, -np.inf if figures.mean_time is None else -figures.mean_time)
            if score > self._score:
                self._score, self.best = score, deepcopy(network)
        self.points.append((steps, round(spent, 2), figures.rate, figures.mean_time))


class _Within(TrainingRun):
    """A run that ends, and lets its rates fall, by CPU time instead of steps."""

    curve: Curve

    @property
    def _share(self) -> float:
        return self.curve.share

    def spend(self, curve: Curve) -> None:
        """Train for the curve's budget."""
        self.curve = curve
        self._rebuild()
        curve.pass_by(0, self._agent.actor)
        while self._share < 1.0:
            self._advance()
            curve.pass_by(self._steps, self._agent.actor)


class _PPO(_Within, OnPolicyRun):
    pass


class _TD3(_Within, OffPolicyRun):
    pass


def train_ours(task: str, algorithm: str, seed: int, problem: Problem, curve: Curve) -> dict[str, Any]:
    """Train robobt's learner; return its settings."""
    data, _ = read_preset(*PRESETS[algorithm])
    own = {"task": TASKS[task], "seed": seed, "tensorboard": False}
    data = merged(data, {**own, "collection": {"num_envs": ROWS[algorithm]}})
    settings = settings_of(data, "benchmarks/baselines.py")
    kind = {"ppo": _PPO, "td3": _TD3}[algorithm]
    with TemporaryDirectory() as folder:
        kind(settings, problem, RunFolder(Path(folder), settings, False), RunClock(), None).spend(curve)
    said_elsewhere = {"task", "seed", "tensorboard", "environment"}
    return settings.model_dump(mode="json", exclude_defaults=True, exclude=said_elsewhere)


def train_sb3(
    task: str, algorithm: str, seed: int, environment: TaskSettings, curve: Curve
) -> dict[str, Any]:
    """Train Stable-Baselines3's; return what was not left at its defaults."""
    need("sb3", "stable_baselines3")
    import stable_baselines3
    from stable_baselines3.common.noise import NormalActionNoise

    from robobt.learning import ArenasVecEnv

    name = f"{environment_id(TASKS[task])}-v0"
    how: dict[str, Any] = {"vectorization_mode": "vector_entry_point", "settings": environment}
    rows = ArenasVecEnv(cast("TaskVectorEnv", gymnasium.make_vec(name, ROWS[algorithm], **how)))
    changes: dict[str, Any] = {}
    if algorithm == "ppo":
        # With 2,048 steps of each of these robots there would be few updates.
        changes = {"n_steps": 40, "batch_size": 1280}
    if algorithm == "td3":
        actions = cast("tuple[int]", rows.action_space.shape)[0]
        changes = {"action_noise": NormalActionNoise(np.zeros(actions), np.full(actions, NOISE))}
    kind = getattr(stable_baselines3, algorithm.upper())
    agent = kind("MlpPolicy", rows, seed=seed, device="cpu", **changes)
    curve.pass_by(0, actor_of(agent))

    def goes_on(*_: object) -> bool:
        curve.pass_by(agent.num_timesteps, actor_of(agent))
        return curve.share < 1.0

    agent.learn(10**9, callback=goes_on, log_interval=None)
    return {"rows": ROWS[algorithm], "stable_baselines3": stable_baselines3.__version__} | {
        key: str(value) for key, value in changes.items()
    }


def actor_of(agent: Any) -> nn.Module:
    """Return the part of a Stable-Baselines3 agent's policy that maps raw observations to actions in [-1, 1].

    Flattening and scaling, which a policy has besides, do nothing to a vector within its bounds.
    """
    policy = agent.policy
    if hasattr(policy, "mlp_extractor"):
        # PPO: the mean of a Gaussian, of which what is drawn is clipped.
        return nn.Sequential(policy.mlp_extractor.policy_net, policy.action_net, nn.Hardtanh())
    if hasattr(policy.actor, "latent_pi"):  # SAC
        return nn.Sequential(policy.actor.latent_pi, policy.actor.mu, nn.Tanh())
    network: nn.Module = policy.actor.mu
    return network
