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


def test_from_the_other_side_every_place_is_turned() -> None:
    details = {"crash_speed": 1.74, "kick_location": (1.0, -2.0), "kicking_team": Team.BLUE}
    event = RefereeEvent(1.0, EventKind.GOAL, Team.BLUE, None, 4.5, 0.5, details)
    turned = event.mirrored()
    assert (turned.x, turned.y, turned.details["kick_location"]) == (-4.5, -0.5, (-1.0, 2.0))
    assert (turned.team, turned.details["kicking_team"]) == (Team.BLUE, Team.BLUE)
    assert turned.mirrored() == event
