"""PPO of robobt beside PPO of Stable-Baselines3: the same arenas, networks, rollouts and minibatches."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import ceil
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from typing import TYPE_CHECKING, Annotated, Any, cast

import gymnasium
import numpy as np
import torch
import typer
from rich.markup import escape
from torch import Tensor, nn

from benchmarks.baselines import actor_of
from robobt.cli import Json, console, print_json, say, table
from robobt.cli.common import errors
from robobt.config.extras import need
from robobt.learning.agents.networks import one_thread, policy_of
from robobt.learning.agents.settings import PPOSettings
from robobt.learning.envs import find_task
from robobt.learning.envs.soccer.settings import SoccerSettings
from robobt.learning.envs.soccer.suite import against
from robobt.learning.tasks import environment_id
from robobt.learning.training.on_policy import OnPolicyRun
from robobt.learning.training.problems import Problem, problem_of
from robobt.learning.training.progress import RunClock
from robobt.learning.training.run_folder import RunFolder
from robobt.learning.training.settings import settings_of
from robobt.statistics import mean_interval
from robobt.world.geometry import FloatArray

if TYPE_CHECKING:
    from robobt.learning.envs.gymnasium_base import TaskVectorEnv

ARENAS = 128
"""Learners that step together."""

STEPS = 614_400
"""Steps of a training, 120 rollouts."""

STARTS = 1000
"""Held-out starts that a policy plays after its last step."""

PARTS = ("environment", "acting", "update")
"""What CPU time is spent on; acting is all that is neither of the others."""

Figures = dict[str, float]


def bench_ppo(
    task: str = "score_on_goalkeeper", seeds: int = 5, steps: int = STEPS, starts: int = STARTS
) -> dict[str, Any]:
    """Train by both for the same steps, seed by seed in turn, on one thread of this process.

    Both take the defaults of :class:`~robobt.learning.agents.settings.PPOSettings`: layers of tanh that begin
    with the task's scale of the observation, rollouts, minibatches, epochs, discount, clipping, a rate that
    falls to 0, entropy bonus. What differs is the library's: Stable-Baselines3 steps policy and value
    together and draws a kick as the sign of a normal entry, robobt as a Bernoulli one.

    Args:
        task: name of the task.
        seeds: number of seeds of either.
        steps: of a training, rounded up to whole rollouts.
        starts: held-out starts that the last policy plays without noise.

    Returns:
        ``robobt`` and ``sb3``, each with ``seeds`` (a list of steps a CPU second, mean return, success, and
        microseconds a step by :data:`PARTS`) and the medians or means of those; ``speed_ratio``, the median
        of the pairs' ratios; ``return_difference`` and ``success_difference`` with 95 % intervals, robobt's
        less Stable-Baselines3's, by pairs of seeds.

    Raises:
        MissingExtraError: Stable-Baselines3 is not installed.
    """
    need("sb3", "stable_baselines3")
    kind = find_task(task)
    environment = kind.Settings()
    judged = against(environment, "attack") if isinstance(environment, SoccerSettings) else environment
    problem = problem_of(environment, held_out=judged, validated=(judged,))
    learners = {"robobt": _ours, "sb3": _theirs}
    rollout = ARENAS * PPOSettings().num_steps
    steps = rollout * ceil(steps / rollout)
    found: dict[str, list[Figures]] = {name: [] for name in learners}
    with one_thread():
        for learn in learners.values():
            # What is compiled or imported at first use is not in the time.
            learn(task, problem, 0, rollout)
        for seed in range(seeds):
            for name, learn in learners.items():
                actor, figures = learn(task, problem, seed, steps)
                played = problem.evaluate(policy_of(actor), "held_out", starts)
                figures |= {"return": float(played.returns.mean()), "success": played.rate}
                found[name].append(figures)
    ours, theirs = [
        {key: np.array([one[key] for one in found[name]]) for key in found[name][0]} for name in learners
    ]
    result: dict[str, Any] = {name: {"seeds": list(found[name])} for name in learners}
    for name, by_seed in (("robobt", ours), ("sb3", theirs)):
        for key in ("steps_per_s", *PARTS):
            result[name][key] = float(np.median(by_seed[key]))
        for key in ("return", "success"):
            result[name][key] = _mean(by_seed[key])
    result["speed_ratio"] = float(np.median(ours["steps_per_s"] / theirs["steps_per_s"]))
    for key in ("return", "success"):
        result[f"{key}_difference"] = _mean(ours[key] - theirs[key])
    return result


def _mean(values: FloatArray) -> Figures:
    """Return the mean over the seeds, with its 95 % interval by Student's t."""
    interval = mean_interval(values)
    return {"mean": float(values.mean()), "low": interval.low, "high": interval.high}


class _Run(OnPolicyRun):
    """A run without evaluations, checkpoints and reports."""

    def learn(self, steps: int) -> tuple[nn.Module, Figures]:
        spent: Figures = {}
        _time(self._task, "step", spent, "environment")
        _time(self._agent, "update", spent, "update")
        begin = process_time()
        self._rebuild()
        while self._steps < steps:
            self._advance()
        return self._agent.actor, _figures(spent, process_time() - begin, self._steps)


def _ours(task: str, problem: Problem, seed: int, steps: int) -> tuple[nn.Module, Figures]:
    """Train by robobt; return the policy and the figures of its speed."""
    data = {
        "task": task,
        "learner": "ppo",
        "steps": steps,
        "seed": seed,
        "tensorboard": False,
        "collection": {"num_envs": ARENAS},
        "evaluation": {"every": STEPS},
        "rebuild_every": STEPS,
    }
    settings = settings_of(data, "benchmarks/ppo.py")
    with TemporaryDirectory() as folder:
        run = _Run(settings, problem, RunFolder(Path(folder), settings, False), RunClock(), None)
        return run.learn(steps)


class _Scaled(nn.Module):
    """Divides an observation by its typical size, as robobt's networks do: the first layer of theirs."""

    inverse_scale: Tensor

    def __init__(self, _space: object, scale: Sequence[float]) -> None:
        super().__init__()
        self.features_dim = len(scale)
        self.register_buffer("inverse_scale", 1.0 / torch.tensor(scale))

    def forward(self, observation: Tensor) -> Tensor:
        return observation * self.inverse_scale


def _theirs(task: str, problem: Problem, seed: int, steps: int) -> tuple[nn.Module, Figures]:
    """Train by Stable-Baselines3; see :func:`_ours`."""
    from stable_baselines3 import PPO

    from robobt.learning import ArenasVecEnv

    name = f"{environment_id(task)}-v0"
    rows = ArenasVecEnv(
        cast("TaskVectorEnv", gymnasium.make_vec(name, ARENAS, vectorization_mode="vector_entry_point"))
    )
    given = PPOSettings()
    layers = list(given.hidden_sizes)
    agent = PPO(
        "MlpPolicy",
        rows,
        learning_rate=lambda left: left * given.learning_rate,
        n_steps=given.num_steps,
        batch_size=given.minibatch_size,
        n_epochs=given.num_epochs,
        gamma=given.gamma,
        gae_lambda=given.gae_lambda,
        clip_range=given.clip_coef,
        ent_coef=given.ent_coef,
        max_grad_norm=given.max_grad_norm,
        policy_kwargs={
            "features_extractor_class": _Scaled,
            "features_extractor_kwargs": {"scale": problem.scale},
            "net_arch": {"pi": layers, "vf": layers},
            "activation_fn": nn.Tanh,
            "log_std_init": float(np.log(given.init_std)),
        },
        seed=seed,
        device="cpu",
    )
    spent: Figures = {}
    _time(rows, "step", spent, "environment")
    _time(agent, "train", spent, "update")
    begin = process_time()
    agent.learn(steps, log_interval=10**9)
    figures = _figures(spent, process_time() - begin, agent.num_timesteps)
    return nn.Sequential(agent.policy.features_extractor, actor_of(agent)), figures


def _time(owner: object, method: str, spent: Figures, part: str) -> None:
    """Add the CPU seconds of an object's method to a part of what is spent."""
    called: Callable[..., object] = getattr(owner, method)
    spent[part] = 0.0

    def timed(*args: object, **options: object) -> object:
        begin = process_time()
        try:
            return called(*args, **options)
        finally:
            spent[part] += process_time() - begin

    setattr(owner, method, timed)


def _figures(spent: Mapping[str, float], total_s: float, steps: int) -> Figures:
    acting = total_s - sum(spent.values())
    parts = {part: 1e6 * seconds / steps for part, seconds in {**spent, "acting": acting}.items()}
    return {"steps": steps, "cpu_s": total_s, "steps_per_s": steps / total_s, **parts}


def ppo(
    task: Annotated[str, typer.Argument(help="What is learned.")] = "score_on_goalkeeper",
    seeds: Annotated[int, typer.Option("--seeds", "-n", min=2, max=100, help="Seeds of either.")] = 5,
    steps: Annotated[int, typer.Option("--steps", min=1, help="Steps of a training.")] = STEPS,
    as_json: Json = False,
) -> None:
    """Train by PPO of robobt and of Stable-Baselines3 for the same steps: speed, and return thereafter.

    Both have the same arenas, networks, rollouts, minibatches and epochs, and one thread; seeds are trained
    in turn. Needs Stable-Baselines3 (pip install "robobt[sb3]").

    Keys of --json: robobt and sb3, each with steps_per_s (median steps a CPU second), environment, acting and
    update (median microseconds of CPU time a step), return and success (mean over the seeds on held-out
    starts without noise, with low and high of a 95 % interval) and seeds (these figures of each seed);
    speed_ratio (median of the pairs); return_difference and success_difference (robobt's less
    Stable-Baselines3's, by pairs).
    """

    with errors.status(f"training {escape(task)} by both"):
        figures = bench_ppo(task, seeds, steps)
    if as_json:
        print_json(figures)
        return
    shown = table("", "steps/CPU s", *(f"{part} [us/step]" for part in PARTS), "return", "success")
    for name, label in (("robobt", "robobt"), ("sb3", "Stable-Baselines3")):
        one = figures[name]
        shown.add_row(
            label,
            f"{one['steps_per_s']:,.0f}",
            *(f"{one[part]:.1f}" for part in PARTS),
            "{mean:.3f} ({low:.3f} to {high:.3f})".format(**one["return"]),
            "{mean:.1%} ({low:.1%} to {high:.1%})".format(**one["success"]),
        )
    console.print(shown)
    difference = "{mean:+.3f} ({low:+.3f} to {high:+.3f})".format(**figures["return_difference"])
    say(
        f"robobt makes {figures['speed_ratio']:.2f} times as many steps a CPU second. "
        f"Its return less the other's: {difference}, by pairs of {seeds} seeds."
    )
