"""Learning: tasks, the arenas they are trained in, agents, training, export.

Importing it registers the tasks with Gymnasium: ``GoToBall-v0``, ``Duel-v0`` and so on, also as
``robobt/GoToBall-v0``, for ``gymnasium.make`` and, with ``vectorization_mode="vector_entry_point"``, for
``gymnasium.make_vec``. :data:`TASKS` has them by name; register your own tasks there.
"""

from typing import TYPE_CHECKING

from robobt.config.extras import need
from robobt.config.lazy import lazily

need("learn", "gymnasium", "scipy", "pyarrow", "matplotlib")

from robobt.learning.tasks import TASKS as TASKS  # noqa: E402

_HOMES = {
    "ArenaTask": "envs",
    "ArenasVecEnv": "envs.stable_baselines3",
    "FieldPlayers": "opponents.field_players",
    "GoToBallTask": "envs",
    "Goalkeepers": "opponents.goalkeepers",
    "SoccerParallelEnv": "envs.soccer.parallel",
    "TaskSettings": "envs",
    "Tick": "envs",
    "TrainSettings": "training.settings",
    "TrainedRun": "trained",
    "load_settings": "training.settings",
    "run_starts": "envs",
    "start_parts": "envs",
    "straight_drive": "envs.scripted",
    "straight_line_time": "envs",
}

if TYPE_CHECKING:
    from robobt.learning.envs import ArenaTask as ArenaTask
    from robobt.learning.envs import GoToBallTask as GoToBallTask
    from robobt.learning.envs import TaskSettings as TaskSettings
    from robobt.learning.envs import Tick as Tick
    from robobt.learning.envs import run_starts as run_starts
    from robobt.learning.envs import start_parts as start_parts
    from robobt.learning.envs import straight_line_time as straight_line_time
    from robobt.learning.envs.scripted import straight_drive as straight_drive
    from robobt.learning.envs.soccer.parallel import SoccerParallelEnv as SoccerParallelEnv
    from robobt.learning.envs.stable_baselines3 import ArenasVecEnv as ArenasVecEnv
    from robobt.learning.opponents.field_players import FieldPlayers as FieldPlayers
    from robobt.learning.opponents.goalkeepers import Goalkeepers as Goalkeepers
    from robobt.learning.trained import TrainedRun as TrainedRun
    from robobt.learning.training.settings import TrainSettings as TrainSettings
    from robobt.learning.training.settings import load_settings as load_settings
else:
    __getattr__, __dir__ = lazily(__name__, _HOMES)
