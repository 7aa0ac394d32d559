"""What the learner must know of a task besides how to step it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from robobt.learning.envs import (
    ArenaTask,
    Episodes,
    GoToBallSettings,
    GoToBallTask,
    ShootSettings,
    ShootTask,
    TaskSettings,
    VectorTask,
    run_starts,
)
from robobt.learning.training.evaluation import Evaluation, Policy
from robobt.models.actions import ActionScaling

Split = Literal["validation", "held_out"]
"""Fixed starts that a policy is judged on: those that choose, or those that tell."""

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
        judge: play a policy once from each of so many of a split's starts.
        scale: (observation,) typical size of each entry, in its unit.
        smoothed: (action,) whether target smoothing may change an entry; not a threshold.
    """

    make: Callable[[int], VectorTask]
    judge: Callable[[Policy, Split, int], Evaluation]
    scale: tuple[float, ...]
    smoothed: tuple[bool, ...]


def go_to_ball(settings: GoToBallSettings) -> Problem:
    """Go-To-Ball, timed until the ball is reached."""
    return Problem(
        lambda n: GoToBallTask(settings, n),
        lambda policy, split, starts: _judge(
            GoToBallTask(settings, min(_ARENAS, starts)), policy, split, starts
        ),
        _go_to_ball_scale(settings.action),
        (True, True, True),
    )


def shoot(settings: ShootSettings) -> Problem:
    """Shoot-Towards-Goal, timed until the kick."""
    return Problem(
        lambda n: ShootTask(settings, n),
        lambda policy, split, starts: _judge(
            ShootTask(settings, min(_ARENAS, starts)), policy, split, starts
        ),
        _shoot_scale(settings.action),
        (True, False),
    )


def problem_of(task: str, environment: TaskSettings) -> Problem:
    """The task of that name in that environment.

    Raises:
        TypeError: the environment is another task's.
    """
    if task == "go_to_ball" and isinstance(environment, GoToBallSettings):
        return go_to_ball(environment)
    if task == "shoot" and isinstance(environment, ShootSettings):
        return shoot(environment)
    raise TypeError(f"{type(environment).__name__} is no environment of {task!r}")


def training_seed(seed: int, steps: int) -> int:
    """The seed that a run's simulator is built with after so many steps."""
    drawn = int(np.random.SeedSequence([seed, steps]).generate_state(1, np.uint64)[0])
    return (drawn & (_TRAINING - 1)) | _TRAINING


def split_seed(split: Split) -> int:
    """The seed of a split's starts, their noise and randomisation; of no run's simulator."""
    return _SPLIT_SEEDS[split]


def _judge(task: ArenaTask, policy: Policy, split: Split, starts: int) -> Evaluation:
    seed = split_seed(split)
    episodes: Episodes = run_starts(task, policy, task.sample_starts(seed, starts), seed)
    timed_by = episodes.kick_time if isinstance(task, ShootTask) else episodes.time
    return Evaluation(episodes.success, timed_by, episodes.optimum, episodes.total_reward)


def _go_to_ball_scale(action: ActionScaling) -> tuple[float, ...]:
    speed, turn = action.max_speed, action.max_turn
    return (1.0, 1.0, 3.0, speed, speed, turn)


def _shoot_scale(action: ActionScaling) -> tuple[float, ...]:
    # What matters is a ball that is about to slip off the dribbler, by millimetres, at less than 1 m/s.
    return (0.1, 0.1, 1.0, 1.0, action.max_turn, 3.0, 1.0, 1.0, 1.0, 1.0)
