"""The events that an automatic referee reports and a referee's decision, with the league's names."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from enum import StrEnum

from robobt.world.game import GameState, Team
from robobt.world.geometry import Point
from robobt.world.state import RobotId


class EventKind(StrEnum):
    """The league's game events, ``GameEvent.Type`` in lower case; outdated ones are left out."""

    POSSIBLE_GOAL = "possible_goal"
    GOAL = "goal"
    INVALID_GOAL = "invalid_goal"
    BALL_LEFT_FIELD_TOUCH_LINE = "ball_left_field_touch_line"
    BALL_LEFT_FIELD_GOAL_LINE = "ball_left_field_goal_line"
    AIMLESS_KICK = "aimless_kick"
    BOUNDARY_CROSSING = "boundary_crossing"
    NO_PROGRESS_IN_GAME = "no_progress_in_game"
    KEEPER_HELD_BALL = "keeper_held_ball"
    ATTACKER_DOUBLE_TOUCHED_BALL = "attacker_double_touched_ball"
    BOT_DRIBBLED_BALL_TOO_FAR = "bot_dribbled_ball_too_far"
    BOT_KICKED_BALL_TOO_FAST = "bot_kicked_ball_too_fast"
    ATTACKER_TOUCHED_BALL_IN_DEFENSE_AREA = "attacker_touched_ball_in_defense_area"
    DEFENDER_IN_DEFENSE_AREA = "defender_in_defense_area"
    ATTACKER_TOO_CLOSE_TO_DEFENSE_AREA = "attacker_too_close_to_defense_area"
    DEFENDER_TOO_CLOSE_TO_KICK_POINT = "defender_too_close_to_kick_point"
    BOT_TOO_FAST_IN_STOP = "bot_too_fast_in_stop"
    BOT_CRASH_UNIQUE = "bot_crash_unique"
    BOT_CRASH_DRAWN = "bot_crash_drawn"
    BOT_PUSHED_BOT = "bot_pushed_bot"
    BOT_HELD_BALL_DELIBERATELY = "bot_held_ball_deliberately"
    BOT_TIPPED_OVER = "bot_tipped_over"
    BOT_DROPPED_PARTS = "bot_dropped_parts"
    BOT_INTERFERED_PLACEMENT = "bot_interfered_placement"
    PLACEMENT_SUCCEEDED = "placement_succeeded"
    PLACEMENT_FAILED = "placement_failed"
    PENALTY_KICK_FAILED = "penalty_kick_failed"
    MULTIPLE_FOULS = "multiple_fouls"
    MULTIPLE_CARDS = "multiple_cards"
    TOO_MANY_ROBOTS = "too_many_robots"
    BOT_SUBSTITUTION = "bot_substitution"
    EXCESSIVE_BOT_SUBSTITUTION = "excessive_bot_substitution"
    CHALLENGE_FLAG = "challenge_flag"
    CHALLENGE_FLAG_HANDLED = "challenge_flag_handled"
    EMERGENCY_STOP = "emergency_stop"
    UNSPORTING_BEHAVIOR_MINOR = "unsporting_behavior_minor"
    UNSPORTING_BEHAVIOR_MAJOR = "unsporting_behavior_major"


Detail = str | int | float | bool | Team | Point | None
"""A field of a league's event: a number in SI units, a team, a point in world coordinates, or a text."""


@dataclass(slots=True, frozen=True)
class RefereeEvent:
    """An event on the field.

    Attributes:
        time: time of the event [s].
        kind: kind of the event.
        team: the league's ``by_team``: the scorer of a goal, the offender of a foul; None if no team caused
            it.
        robot: number of the robot, if known.
        x, y: place of the event, in world coordinates [m].
        details: the other fields of the league's message by name, such as ``crash_speed``; SI units and world
            coordinates (blue defends -x).
    """

    time: float
    kind: EventKind
    team: Team | None = None
    robot: RobotId | None = None
    x: float = 0.0
    y: float = 0.0
    details: Mapping[str, Detail] = field(default_factory=dict)

    def mirrored(self) -> RefereeEvent:
        """Return the event as seen from the other side of the field."""
        turned = {
            name: (-value[0], -value[1]) if isinstance(value, tuple) else value
            for name, value in self.details.items()
        }
        return replace(self, x=-self.x, y=-self.y, details=turned)

    @property
    def text(self) -> str:
        """The details as readable text."""
        return ", ".join(
            f"{name} {_told(value)}" for name, value in self.details.items() if value is not None
        )


def _told(value: Detail) -> str:
    if isinstance(value, tuple):
        return f"({value[0]:.2f}, {value[1]:.2f})"
    return f"{value:.2f}" if isinstance(value, float) else str(value)


@dataclass(slots=True)
class Decision:
    """The referee's decision on one frame.

    Attributes:
        game: the game state from now on, in world coordinates.
        events: the events in this frame.
        place_ball: where the ball has to be placed at rest now [m], None to leave it.
    """

    game: GameState
    events: tuple[RefereeEvent, ...] = ()
    place_ball: Point | None = None
