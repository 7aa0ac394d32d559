"""The tasks by name, and the arenas that belong to an environment's settings."""

from __future__ import annotations

import re

from robobt.learning.envs.arena_task import ArenaTask
from robobt.learning.envs.go_to_ball.settings import GoToBallAmongRobotsSettings, GoToBallSettings
from robobt.learning.envs.go_to_ball.task import GoToBallTask
from robobt.learning.envs.score_on_goalkeeper.settings import ScoreOnGoalkeeperSettings
from robobt.learning.envs.score_on_goalkeeper.task import ScoreOnGoalkeeperTask
from robobt.learning.envs.settings import TaskSettings
from robobt.learning.envs.shoot.settings import ShootSettings
from robobt.learning.envs.shoot.task import ShootTask
from robobt.learning.envs.soccer.per_robot import PerRobot
from robobt.learning.envs.soccer.settings import SoccerSettings
from robobt.learning.envs.soccer.suite import TASKS
from robobt.learning.envs.soccer.task import SoccerTask

SEVERAL = {re.sub(r"(?<=[a-z])(?=[A-Z])", "_", name).lower(): model for name, model in TASKS.items()}
"""Settings of the tasks of several robots by the names that training has for them."""

ENVIRONMENTS: dict[str, type[TaskSettings]] = {
    "go_to_ball": GoToBallSettings,
    "shoot": ShootSettings,
    "score_on_goalkeeper": ScoreOnGoalkeeperSettings,
    "go_to_ball_among_robots": GoToBallAmongRobotsSettings,
    **SEVERAL,
}
"""The settings of each task's environment."""


def make_task(settings: TaskSettings, n: int) -> ArenaTask:
    """Return ``n`` arenas of the environment with these ``settings``."""
    if isinstance(settings, GoToBallSettings):
        return GoToBallTask(settings, n)
    if isinstance(settings, ShootSettings):
        return ShootTask(settings, n)
    if isinstance(settings, ScoreOnGoalkeeperSettings):
        return ScoreOnGoalkeeperTask(settings, n)
    if isinstance(settings, SoccerSettings):
        return SoccerTask(settings, n)
    raise TypeError(f"{type(settings).__name__} is no environment of a task")


def make_rows(settings: TaskSettings, n: int, central: bool = False) -> ArenaTask | PerRobot:
    """Return arenas of the environment with these ``settings`` that have ``n`` learners together, a row each.

    With ``central`` each row ends with what a central critic sees; of a task of several robots alone.

    Raises:
        ValueError: these are not the learners of whole arenas.
    """
    task = make_task(settings, n // learners_of(settings))
    if n % len(task.learners):
        raise ValueError(f"{n} learners are not those of whole arenas, with {len(task.learners)} each")
    return PerRobot(task, central) if isinstance(task, SoccerTask) else task


def learners_of(settings: TaskSettings) -> int:
    """Return how many robots learn in an arena with these ``settings``."""
    return len(settings.learners) if isinstance(settings, SoccerSettings) else 1
