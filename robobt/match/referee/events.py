"""What the referee reports of a frame."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from robobt.world.game import GameState, Team
from robobt.world.geometry import Point
from robobt.world.state import RobotId


class EventKind(StrEnum):
    """The kinds of events that a referee records."""

    GOAL = "goal"
    INVALID_GOAL = "invalid_goal"
    BALL_OUT = "ball_out"
    AIMLESS_KICK = "aimless_kick"
    DOUBLE_TOUCH = "double_touch"
    DRIBBLING = "dribbling"
    BALL_SPEED = "ball_speed"
    OWN_AREA_TOUCH = "own_area_touch"
    THEIR_AREA_TOUCH = "their_area_touch"
    KEEPER_HELD = "keeper_held"
    CRASH = "crash"
    NO_PROGRESS = "no_progress"
    STOP_SPEED = "stop_speed"
    STOP_DISTANCE = "stop_distance"
    INTERFERENCE = "interference"
    KICK_TIMEOUT = "kick_timeout"


@dataclass(slots=True, frozen=True)
class RefereeEvent:
    """An event on the field.

    ``team`` did it: the scorer of a goal, the offender of a foul; None when nobody did. ``robot`` is which,
    as far as known; ``x`` and ``y`` are in world coordinates [m], ``time`` in seconds.
    """

    time: float
    kind: EventKind
    team: Team | None
    robot: RobotId | None
    x: float
    y: float


@dataclass(slots=True)
class Decision:
    """What the referee decides on one frame.

    Attributes:
        game: the game state from now on, in world coordinates.
        events: what happened in this frame.
        place_ball: where the ball has to be put down at rest right now, None to leave it [m].
    """

    game: GameState
    events: tuple[RefereeEvent, ...] = ()
    place_ball: Point | None = None
