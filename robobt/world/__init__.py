"""What is on a field: geometry, states, commands, the state of the game, observations."""

from typing import TYPE_CHECKING

from robobt.config.lazy import lazily
from robobt.world.command import KickTrigger as KickTrigger
from robobt.world.command import RobotCommand as RobotCommand
from robobt.world.field import DIVISION_A as DIVISION_A
from robobt.world.field import DIVISION_B as DIVISION_B
from robobt.world.field import FIELDS as FIELDS
from robobt.world.field import FieldGeometry as FieldGeometry
from robobt.world.game import OPEN_PLAY as OPEN_PLAY
from robobt.world.game import GameState as GameState
from robobt.world.game import RefereeCommand as RefereeCommand
from robobt.world.game import Restart as Restart
from robobt.world.game import Stage as Stage
from robobt.world.game import Team as Team
from robobt.world.limits import DEFAULT_LIMITS as DEFAULT_LIMITS
from robobt.world.limits import RobotLimits as RobotLimits
from robobt.world.protocol import Placement as Placement
from robobt.world.protocol import World as World
from robobt.world.state import BALL_RADIUS as BALL_RADIUS
from robobt.world.state import ROBOT_RADIUS as ROBOT_RADIUS
from robobt.world.state import BallState as BallState
from robobt.world.state import Frame as Frame
from robobt.world.state import RobotId as RobotId
from robobt.world.state import RobotState as RobotState

_HOMES = {
    "MeasuredDelay": "delay",
    "DelayWatch": "delay",
    "FloatArray": "geometry",
    "GO_TO_BALL": "features",
    "Point": "geometry",
    "Seen": "observation",
    "direction": "geometry",
    "distance": "geometry",
    "entries": "observation",
    "has_ball": "rules",
    "own_observation": "observation",
    "wrap_angle": "geometry",
}

if TYPE_CHECKING:
    from robobt.world.delay import DelayWatch as DelayWatch
    from robobt.world.delay import MeasuredDelay as MeasuredDelay
    from robobt.world.features import GO_TO_BALL as GO_TO_BALL
    from robobt.world.geometry import FloatArray as FloatArray
    from robobt.world.geometry import Point as Point
    from robobt.world.geometry import direction as direction
    from robobt.world.geometry import distance as distance
    from robobt.world.geometry import wrap_angle as wrap_angle
    from robobt.world.observation import Seen as Seen
    from robobt.world.observation import entries as entries
    from robobt.world.observation import own_observation as own_observation
    from robobt.world.rules import has_ball as has_ball
else:
    __getattr__, __dir__ = lazily(__name__, _HOMES)
