"""Game events are the same on both sides of the wire."""

from __future__ import annotations

import random
from dataclasses import replace
from itertools import islice

import pytest

from robobt.league.wire.gameevents import read_event, write_event
from robobt.league.wire.messages import DecodeError, GameEvent
from robobt.match.referee.events import Detail, EventKind, RefereeEvent
from robobt.world.game import Team
from robobt.world.state import RobotId
from tests.league.mutations import mutations

EPOCH = 1_700_000_000.0
BLUE_3 = RobotId(Team.BLUE, 3)


def there_and_back(event: RefereeEvent) -> RefereeEvent | None:
    data = write_event(event, EPOCH, "me").SerializeToString()
    return read_event(GameEvent.FromString(data), EPOCH, 0.0)


@pytest.mark.parametrize("kind", EventKind)
def test_every_kind_comes_back_as_it_was_sent(kind: EventKind) -> None:
    event = there_and_back(RefereeEvent(12.5, kind, Team.BLUE, BLUE_3, 1.5, -2.0))
    assert event is not None
    assert event.kind is kind
    assert event.time == pytest.approx(12.5, abs=1e-5)
    named = GameEvent.DESCRIPTOR.fields_by_name[kind.value].message_type.fields_by_name
    assert event.team is (Team.BLUE if "by_team" in named else None)
    if "location" in named:
        assert (event.x, event.y) == (1.5, -2.0)
    offender = {"by_bot", "violator", "kicking_bot"} & set(named)
    assert event.robot == (BLUE_3 if offender else None)


@pytest.mark.parametrize(
    ("kind", "details"),
    [
        (EventKind.BOT_CRASH_UNIQUE, {"victim": 4, "crash_speed": 2.5, "speed_diff": 0.5}),
        (EventKind.BOT_KICKED_BALL_TOO_FAST, {"initial_ball_speed": 7.25, "chipped": True}),
        (EventKind.AIMLESS_KICK, {"kick_location": (-2.0, 0.5)}),
        (EventKind.PENALTY_KICK_FAILED, {"reason": "the ball turned"}),
        (EventKind.CHALLENGE_FLAG_HANDLED, {"accepted": False}),
        (EventKind.TOO_MANY_ROBOTS, {"num_robots_allowed": 5, "num_robots_on_field": 6}),
        (EventKind.POSSIBLE_GOAL, {"kicking_team": Team.BLUE, "num_robots_by_team": 6}),
    ],
)
def test_details_come_back_by_their_names(kind: EventKind, details: dict[str, Detail]) -> None:
    event = there_and_back(RefereeEvent(1.0, kind, Team.BLUE, None, details=details))
    assert event is not None
    assert event.details == details


def test_a_dribble_is_where_it_began() -> None:
    start, end = (1.0, -0.5), (2.5, 0.0)
    event = there_and_back(
        RefereeEvent(
            1.0, EventKind.BOT_DRIBBLED_BALL_TOO_FAR, Team.BLUE, details={"start": start, "end": end}
        )
    )
    assert event is not None
    assert (event.x, event.y) == start


def test_a_moment_is_told_in_the_controllers_time() -> None:
    goal = RefereeEvent(20.0, EventKind.POSSIBLE_GOAL, Team.YELLOW, details={"last_touch_by_team": 18.25})
    message = write_event(goal, EPOCH, "me")
    assert message.possible_goal.last_touch_by_team == (1_700_000_000 * 1000 + 18_250) * 1000
    back = there_and_back(goal)
    assert back is not None
    assert back.details["last_touch_by_team"] == pytest.approx(18.25, abs=1e-5)


def test_an_own_goal_names_the_robot_of_the_other_team() -> None:
    details = {"kicking_team": Team.YELLOW, "kicking_bot": 2}
    event = there_and_back(RefereeEvent(1.0, EventKind.POSSIBLE_GOAL, Team.BLUE, details=details))
    assert event is not None
    assert (event.team, event.robot) == (Team.BLUE, RobotId(Team.YELLOW, 2))


def test_where_nobody_did_it_the_team_is_unknown_and_not_missing() -> None:
    message = write_event(RefereeEvent(1.0, EventKind.BALL_LEFT_FIELD_TOUCH_LINE), EPOCH, "me")
    assert message.ball_left_field_touch_line.HasField("by_team")
    assert message.ball_left_field_touch_line.by_team == 0


def test_the_fouls_that_led_to_a_card_are_named() -> None:
    message = GameEvent(type="MULTIPLE_FOULS")
    message.multiple_fouls.by_team = 2
    for kind in ("BOT_CRASH_UNIQUE", "BOT_TOO_FAST_IN_STOP"):
        message.multiple_fouls.caused_game_events.add().type = kind
    event = read_event(message, EPOCH, 5.0)
    assert event is not None
    assert event.details == {"caused_game_events": "bot_crash_unique, bot_too_fast_in_stop"}
    assert event.time == 5.0


def test_an_outdated_kind_is_none_of_ours() -> None:
    assert read_event(GameEvent(type="CHIPPED_GOAL"), EPOCH, 0.0) is None


def test_impossible_values_are_left_out() -> None:
    message = GameEvent(type="BOT_TOO_FAST_IN_STOP")
    body = message.bot_too_fast_in_stop
    body.by_team, body.by_bot, body.speed = 1, 99, float("nan")
    body.location.x, body.location.y = float("inf"), 0.0
    event = read_event(message, EPOCH, 3.0)
    assert event == RefereeEvent(3.0, EventKind.BOT_TOO_FAST_IN_STOP, Team.YELLOW)


def test_ten_thousand_mutated_events_are_read_or_refused() -> None:
    rng = random.Random(0)
    seeds = [
        write_event(
            RefereeEvent(rng.uniform(0, 600), kind, Team.BLUE, BLUE_3, 1.0, 2.0, {"reason": "x"}), EPOCH, "me"
        )
        for kind in EventKind
    ]
    read = 0
    for data in islice(mutations(seeds, 0), 10_000):
        try:
            message = GameEvent.FromString(data)
        except DecodeError:
            continue
        event = read_event(message, EPOCH, 0.0)
        if event is not None:
            read += 1
            assert event.text.isprintable()
            assert there_and_back(replace(event, time=0.0, details={})) is not None
    assert read > 1000
