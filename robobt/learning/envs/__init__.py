"""The tasks that skills are trained on, and the parts for tasks of your own.

A learner steps many arenas at once (:class:`ArenaTask`); Gymnasium's interface wraps the same tasks.
"""

from robobt.learning.envs.arena_task import ArenaTask as ArenaTask
from robobt.learning.envs.episodes import straight_line_time as straight_line_time
from robobt.learning.envs.evaluation import run_starts as run_starts
from robobt.learning.envs.go_to_ball.among_robots import GoToBallAmongRobotsTask as GoToBallAmongRobotsTask
from robobt.learning.envs.go_to_ball.settings import (
    GoToBallAmongRobotsSettings as GoToBallAmongRobotsSettings,
)
from robobt.learning.envs.go_to_ball.settings import GoToBallSettings as GoToBallSettings
from robobt.learning.envs.go_to_ball.task import GoToBallTask as GoToBallTask
from robobt.learning.envs.make import find_task as find_task
from robobt.learning.envs.make import make_task as make_task
from robobt.learning.envs.score_on_goalkeeper.settings import (
    ScoreOnGoalkeeperSettings as ScoreOnGoalkeeperSettings,
)
from robobt.learning.envs.score_on_goalkeeper.task import ScoreOnGoalkeeperTask as ScoreOnGoalkeeperTask
from robobt.learning.envs.settings import HARDWARE_CHALLENGE as HARDWARE_CHALLENGE
from robobt.learning.envs.settings import TaskSettings as TaskSettings
from robobt.learning.envs.shoot.rewards import SHOOT_REWARDS as SHOOT_REWARDS
from robobt.learning.envs.shoot.rewards import ShootReward as ShootReward
from robobt.learning.envs.shoot.settings import ShootSettings as ShootSettings
from robobt.learning.envs.shoot.task import ShootTask as ShootTask
from robobt.learning.envs.starts import START_COLUMNS as START_COLUMNS
from robobt.learning.envs.starts import start_parts as start_parts
from robobt.learning.envs.task import StepResult as StepResult
from robobt.learning.envs.task import VectorTask as VectorTask
from robobt.learning.envs.tick import TaskError as TaskError
from robobt.learning.envs.tick import Tick as Tick
