"""The league's game events."""

from __future__ import annotations

from robobt.league.wire.messages import GameEvent
from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.world import RobotId, Team


def test_every_kind_is_a_game_event_of_the_league() -> None:
    names = {name.lower() for name, _ in GameEvent.Type.items()}
    assert {kind.value for kind in EventKind} <= names


def test_an_event_tells_its_details() -> None:
    details = {"crash_speed": 1.74, "victim": 3, "kick_location": (1.0, -2.345), "message": None}
    event = RefereeEvent(1.0, EventKind.BOT_CRASH_UNIQUE, Team.BLUE, RobotId(Team.BLUE, 1), details=details)
    assert event.text == "crash_speed 1.74, victim 3, kick_location (1.00, -2.35)"
