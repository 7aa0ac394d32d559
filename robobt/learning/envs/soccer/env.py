"""Tasks of several robots as Gymnasium knows them."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np
from gymnasium.spaces import Box

from robobt.learning.envs.bounds import BUMP, bounded, farthest, seen_speed, seen_turn
from robobt.learning.envs.gymnasium_base import EnvKind, ManyEnv, SingleEnv
from robobt.learning.envs.settings import TaskSettings
from robobt.learning.envs.soccer.per_robot import PerRobot
from robobt.learning.envs.soccer.settings import SoccerSettings
from robobt.learning.envs.soccer.suite import TASKS
from robobt.learning.envs.soccer.task import SoccerTask
from robobt.world.scoring import FAR_OFF
from robobt.world.state import ROBOT_RADIUS
from robobt.world.team_view import AWAY


def learner_space(settings: SoccerSettings) -> Box[np.float32]:
    """Return one learner's observations, with bounds that follow from walls, limits, kicker and noise."""
    limits, noise, starts = settings.robot_limits, settings.noise, settings.starts
    most, fastest = farthest(settings), limits.max_speed * settings.randomisation.top_speed[1]
    driven = max(fastest, settings.simulator.limits.max_speed) + BUMP
    turned = max(limits.max_turn, settings.simulator.limits.max_turn) + driven / ROBOT_RADIUS
    # A ball comes off a robot that drives and turns at most so much faster than it was kicked.
    kicked = settings.simulator.kicker.max_speed + driven + turned * ROBOT_RADIUS + BUMP
    robot = seen_speed(settings, driven, noise.robot_position)
    ball = seen_speed(settings, max(kicked, starts.ball_speed[1]), noise.ball_position)
    far = most + AWAY
    own = [robot, robot, seen_turn(settings, turned), most, most, 1.0, 1.0, far, far, ball, ball]
    goals = [most + settings.field.goal_width] * 6
    mates, opponents = settings.places
    return bounded(
        [
            *own,
            *goals,
            FAR_OFF,
            FAR_OFF / 2,
            *[far, far, robot, robot] * (mates + opponents),
            *[1.0] * settings.rules.told,
        ],
        distances=(),
    )


def _all_learners(settings: SoccerSettings) -> Box[np.float32]:
    one, count = learner_space(settings), len(settings.learners)
    return Box(np.tile(one.low, count), np.tile(one.high, count), dtype=np.float32)


def kind_of(task: str) -> EnvKind:
    """Return what Gymnasium has to know of a task of the suite.

    Raises:
        ValueError: there is no such task.
    """
    if task not in TASKS:
        raise ValueError(f"no task is called {task!r}; there are {', '.join(TASKS)}")
    model = TASKS[task]
    return EnvKind(partial(_arenas, model), model, _all_learners)


def _arenas(model: type[SoccerSettings], settings: SoccerSettings | None, n: int) -> SoccerTask:
    return SoccerTask(model() if settings is None else settings, n)


class SoccerEnv(SingleEnv):
    """A task of several robots, one arena; several learners are one agent that commands them all.

    Their observations (:func:`robobt.world.team_view.team_view`) stand one after the other, and so do their
    actions (:data:`robobt.models.actions.SCORE_ACTION`); the reward is their mean. There is an agent for each
    learner in :class:`~robobt.learning.envs.soccer.parallel.SoccerParallelEnv`.

    Args:
        task: name in :data:`~robobt.learning.envs.soccer.suite.TASKS`, whose class documents it.
        settings: that task's settings, or the mapping that makes them, as out of a YAML file.
        render_mode: None or "rgb_array".

    Raises:
        ValueError: there is no such task.
    """

    def __init__(
        self,
        task: str,
        settings: TaskSettings | Mapping[str, object] | None = None,
        render_mode: str | None = None,
    ) -> None:
        self.kind = kind_of(task)
        super().__init__(settings, render_mode)


class SoccerVectorEnv(ManyEnv):
    """Many arenas of a task of several robots, with every learner as an environment of its own.

    An arena's learners stand one after the other, and their episodes end together; each earns its own reward.
    The rest is as for :class:`SoccerEnv`.

    Args:
        task: name in :data:`~robobt.learning.envs.soccer.suite.TASKS`.
        num_envs: learners of all arenas together, a multiple of a task's learners.
        settings: as for :class:`SoccerEnv`.
        render_mode: None or "rgb_array", a picture an arena.

    Raises:
        ValueError: there is no such task, or not so many learners in whole arenas.
    """

    def __init__(
        self,
        task: str,
        num_envs: int = 1,
        settings: TaskSettings | Mapping[str, object] | None = None,
        render_mode: str | None = None,
    ) -> None:
        model = TASKS.get(task)
        self.kind = EnvKind(_per_robot, model, learner_space) if model else kind_of(task)
        super().__init__(
            num_envs, settings if settings is not None or model is None else model(), render_mode
        )


def _per_robot(settings: Any, n: int) -> PerRobot:
    each = len(settings.learners)
    if n % each:
        raise ValueError(f"num_envs must be a multiple of the arena's {each} learners, not {n}")
    return PerRobot(SoccerTask(settings, n // each))
