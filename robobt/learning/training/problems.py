"""What the learner must know of a task besides how to step it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from robobt.learning.envs import (
    GoToBallSettings,
    ScoreOnGoalkeeperSettings,
    ShootSettings,
    ShootTask,
    TaskSettings,
    VectorTask,
    make_task,
    run_starts,
)
from robobt.learning.training.evaluation import Evaluation, Policy

Split = Literal["validation", "held_out"]
"""Fixed starts of evaluations: those that choose the actor, or those that its figures come from."""

_SPLIT_SEEDS: dict[Split, int] = {"validation": 1_000_001, "held_out": 2_000_003}
_TRAINING = 2**62
"""Seeds of training episodes have this bit, so that none is the seed of fixed starts."""

_ARENAS = 128
"""Side by side in an evaluation."""


@dataclass(frozen=True)
class Problem:
    """A task to learn.

    Attributes:
        make: ``n`` arenas of it.
        evaluate: play a policy once from each of so many of a split's starts.
        scale: (observation,) typical size of each entry, in its unit.
        smoothed: (action,) whether target smoothing may change an entry; not a threshold.
    """

    make: Callable[[int], VectorTask]
    evaluate: Callable[[Policy, Split, int], Evaluation]
    scale: tuple[float, ...]
    smoothed: tuple[bool, ...]


def problem_of(environment: TaskSettings, held_out: TaskSettings | None = None) -> Problem:
    """Return the task in that environment; ``held_out`` is where held-out starts are played, if elsewhere."""
    speed, turn = environment.action.max_speed, environment.action.max_turn
    scale: tuple[float, ...]
    smoothed: tuple[bool, ...]
    if isinstance(environment, GoToBallSettings):
        scale, smoothed = (1.0, 1.0, 3.0, speed, speed, turn), (True,) * 3
        if environment.to_shoot:
            scale += (1.0, 1.0)
    elif isinstance(environment, ShootSettings):
        # What matters is a ball that is about to slip off the dribbler, by millimetres, at less than 1 m/s.
        scale = (0.1, 0.1, 1.0, 1.0, turn, 3.0, 1.0, 1.0, 1.0, 1.0)
        smoothed = (True, False)
    elif isinstance(environment, ScoreOnGoalkeeperSettings):
        # Beside the line of the heading, less counts than along it.
        scale = (speed, speed, turn, 2.0, 1.5, 3.0, 3.0, 1.0, 1.0, *(4.0, 2.0) * 3, 2.0, 2.0, 0.3, 0.2)
        smoothed = (True, True, True, False)
    else:
        raise TypeError(f"{type(environment).__name__} is no environment of a task")
    where: dict[Split, TaskSettings] = {"validation": environment, "held_out": held_out or environment}
    return Problem(
        lambda n: make_task(environment, n),
        lambda policy, split, starts: _evaluate(where[split], policy, split, starts),
        scale,
        smoothed,
    )


def training_seed(seed: int, steps: int) -> int:
    """Return the seed that a run's simulator is built with after so many steps."""
    drawn = int(np.random.SeedSequence([seed, steps]).generate_state(1, np.uint64)[0])
    return (drawn & (_TRAINING - 1)) | _TRAINING


def split_seed(split: Split) -> int:
    """Return the seed of a split's starts, their noise and randomisation; of no run's simulator."""
    return _SPLIT_SEEDS[split]


def _evaluate(environment: TaskSettings, policy: Policy, split: Split, starts: int) -> Evaluation:
    task, seed = make_task(environment, min(_ARENAS, starts)), split_seed(split)
    episodes = run_starts(task, policy, task.sample_starts(seed, starts), seed)
    timed = episodes.kick_time if isinstance(task, ShootTask) else episodes.time
    return Evaluation(episodes.success, timed, episodes.optimum, episodes.total_reward)
