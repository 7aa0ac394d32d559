"""The task that belongs to an environment's settings."""

from __future__ import annotations

from robobt.learning.envs.arena_task import ArenaTask
from robobt.learning.envs.go_to_ball.settings import GoToBallSettings
from robobt.learning.envs.go_to_ball.task import GoToBallTask
from robobt.learning.envs.score_on_goalkeeper.settings import ScoreOnGoalkeeperSettings
from robobt.learning.envs.score_on_goalkeeper.task import ScoreOnGoalkeeperTask
from robobt.learning.envs.settings import TaskSettings
from robobt.learning.envs.shoot.settings import ShootSettings
from robobt.learning.envs.shoot.task import ShootTask


def make_task(settings: TaskSettings, n: int) -> ArenaTask:
    """Return ``n`` arenas of the environment with these settings."""
    if isinstance(settings, GoToBallSettings):
        return GoToBallTask(settings, n)
    if isinstance(settings, ShootSettings):
        return ShootTask(settings, n)
    if isinstance(settings, ScoreOnGoalkeeperSettings):
        return ScoreOnGoalkeeperTask(settings, n)
    raise TypeError(f"{type(settings).__name__} is no environment of a task")
