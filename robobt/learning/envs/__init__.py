"""The environments in which skills are trained: Go-To-Ball and Shoot-Towards-Goal.

A learner steps many arenas at once (:class:`GoToBallTask`, :class:`ShootTask`);
Gymnasium's interface is over the same.
"""

from robobt.learning.envs.arena_task import ArenaTask
from robobt.learning.envs.episodes import Episodes, straight_line_time
from robobt.learning.envs.evaluation import Decide, run_starts
from robobt.learning.envs.go_to_ball.env import GoToBallEnv, GoToBallVectorEnv
from robobt.learning.envs.go_to_ball.rewards import GoToBallReward
from robobt.learning.envs.go_to_ball.settings import ContactRule, GoToBallSettings, GoToBallStarts
from robobt.learning.envs.go_to_ball.task import GoToBallTask
from robobt.learning.envs.make import make_task
from robobt.learning.envs.settings import (
    HARDWARE_CHALLENGE,
    NoiseSettings,
    RandomisationSettings,
    TaskSettings,
)
from robobt.learning.envs.shoot.env import ShootTowardsGoalEnv, ShootTowardsGoalVectorEnv
from robobt.learning.envs.shoot.rewards import SHOOT_REWARDS, ShootReward
from robobt.learning.envs.shoot.settings import ShootSettings, ShootStarts
from robobt.learning.envs.shoot.task import ShootTask
from robobt.learning.envs.starts import START_COLUMNS
from robobt.learning.envs.task import StepResult, VectorTask

__all__ = [
    "HARDWARE_CHALLENGE",
    "SHOOT_REWARDS",
    "START_COLUMNS",
    "ArenaTask",
    "ContactRule",
    "Decide",
    "Episodes",
    "GoToBallEnv",
    "GoToBallReward",
    "GoToBallSettings",
    "GoToBallStarts",
    "GoToBallTask",
    "GoToBallVectorEnv",
    "NoiseSettings",
    "RandomisationSettings",
    "ShootReward",
    "ShootSettings",
    "ShootStarts",
    "ShootTask",
    "ShootTowardsGoalEnv",
    "ShootTowardsGoalVectorEnv",
    "StepResult",
    "TaskSettings",
    "VectorTask",
    "make_task",
    "run_starts",
    "straight_line_time",
]
