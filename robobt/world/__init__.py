"""What is on a field: geometry, states, commands, the state of the game, observations."""

from robobt.world.command import KickTrigger, RobotCommand
from robobt.world.field import DIVISION_A, DIVISION_B, FIELDS, FieldGeometry
from robobt.world.game import OPEN_PLAY, GameState, RefereeCommand, Restart, Stage, Team
from robobt.world.limits import DEFAULT_LIMITS, RobotLimits
from robobt.world.protocol import Placement, World
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, BallState, Frame, RobotId, RobotState

__all__ = [
    "BALL_RADIUS",
    "DEFAULT_LIMITS",
    "DIVISION_A",
    "DIVISION_B",
    "FIELDS",
    "OPEN_PLAY",
    "ROBOT_RADIUS",
    "BallState",
    "FieldGeometry",
    "Frame",
    "GameState",
    "KickTrigger",
    "Placement",
    "RefereeCommand",
    "Restart",
    "RobotCommand",
    "RobotId",
    "RobotLimits",
    "RobotState",
    "Stage",
    "Team",
    "World",
]
