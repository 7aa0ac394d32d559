"""No progress, and too many robots."""

from __future__ import annotations

from dataclasses import replace

import pytest

from robobt.match.referee.events import EventKind
from robobt.world import DIVISION_A, DIVISION_B, FieldGeometry, GameState, Team
from robobt.world.game import TeamStatus
from tests.match.referee.watching import PLAY, STOP, Watching


@pytest.mark.parametrize(("field", "limit"), [(DIVISION_A, 5.0), (DIVISION_B, 10.0)], ids=["a", "b"])
def test_a_ball_that_rests_for_the_divisions_time_makes_no_progress(
    us: Team, field: FieldGeometry, limit: float
) -> None:
    game = Watching(us, field).roll(1.0, 1.0)
    assert game.wait(limit - 0.1).events == []
    (stuck,) = game.wait(0.2).events
    assert (stuck.kind, stuck.team) == (EventKind.NO_PROGRESS_IN_GAME, None)
    assert stuck.details["time"] == pytest.approx(limit, abs=0.05)


@pytest.mark.parametrize(("way", "stuck"), [(0.099, True), (0.101, False)])
def test_a_tenth_of_a_metre_is_progress(us: Team, way: float, stuck: bool) -> None:
    game = Watching(us).roll(1.0, 1.0).wait(9.5).roll(1.0 + way, 1.0).wait(1.0)
    assert game.kinds == [EventKind.NO_PROGRESS_IN_GAME] * stuck


def test_time_and_way_are_those_of_the_settings(us: Team) -> None:
    game = (
        Watching(us, no_progress_time=3.0, no_progress_distance=0.5).roll(1.0, 1.0).wait(1.5).roll(1.4, 1.0)
    )
    assert game.wait(1.3).events == []
    assert game.wait(0.3).kinds == [EventKind.NO_PROGRESS_IN_GAME]


def test_the_time_of_a_stop_does_not_count(us: Team) -> None:
    assert Watching(us).wait(9.0).now(STOP).wait(3.0).now(PLAY).wait(9.0).events == []


def six(us: Team, most: int) -> Watching:
    game = Watching(us, no_progress_time=None, game=allowed(us, 6))
    for number in range(6):
        game.ours(number, -1.0 - 0.5 * number, 1.0)
    return game.wait(3.0).now(allowed(us, most))


def allowed(us: Team, most: int) -> GameState:
    status = TeamStatus(max_robots=most)
    return replace(PLAY, **{us.value: status})


def test_after_a_card_a_team_has_ten_seconds_of_play(us: Team) -> None:
    game = six(us, 5).wait(9.8)
    assert game.events == []
    (event,) = game.wait(0.4).events
    assert (event.kind, event.team) == (EventKind.TOO_MANY_ROBOTS, us)
    assert (event.details["num_robots_allowed"], event.details["num_robots_on_field"]) == (5, 6)
    assert len(game.wait(1.7).events) == 1
    assert len(game.wait(0.3).events) == 2


def test_a_robot_beside_the_half_way_line_has_left(us: Team) -> None:
    assert six(us, 5).ours(4, 0.5, DIVISION_B.half_width + 0.1).wait(20.0).events == []


def test_each_card_takes_a_robot(us: Team) -> None:
    game = six(us, 4).ours(4, 0.5, DIVISION_B.half_width + 0.1)
    assert game.wait(11.0).kinds == [EventKind.TOO_MANY_ROBOTS]


def test_as_many_as_allowed_are_fair(us: Team) -> None:
    assert six(us, 6).wait(20.0).events == []
