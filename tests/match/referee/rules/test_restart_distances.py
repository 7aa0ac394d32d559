"""Distances to areas and kick points, speed in STOP."""

from __future__ import annotations

import pytest

from robobt.match.referee.events import EventKind
from robobt.world import DIVISION_B, GameState, Team
from robobt.world.game import RefereeCommand, Restart
from tests.match.referee.watching import PLAY, STOP, Watching

FRONT = DIVISION_B.half_length - DIVISION_B.defense_depth
AREA, POINT = EventKind.ATTACKER_TOO_CLOSE_TO_DEFENSE_AREA, EventKind.DEFENDER_TOO_CLOSE_TO_KICK_POINT
FAST = EventKind.BOT_TOO_FAST_IN_STOP
PLACEMENT = GameState(RefereeCommand.BALL_PLACEMENT_BLUE, restart=Restart.BALL_PLACEMENT)


@pytest.mark.parametrize(("gap", "near"), [(0.274, True), (0.276, False)])
def test_in_stop_robots_keep_off_the_opponents_area(us: Team, gap: float, near: bool) -> None:
    game = Watching(us, game=STOP).ours(3, FRONT - gap, 0.3).wait(2.1)
    assert game.kinds == [AREA] * near


def test_beside_the_area_they_keep_off_too(us: Team) -> None:
    game = Watching(us, game=STOP).ours(3, FRONT + 0.5, 1.0 + 0.27).wait(2.1)
    assert game.kinds == [AREA]
    assert game.last.details["distance"] == pytest.approx(0.18)


def test_they_have_two_seconds_to_get_away(us: Team) -> None:
    game = Watching(us, game=STOP).ours(3, FRONT, 0.3).wait(1.9)
    assert game.events == []
    assert len(game.wait(2.1).events) == 1
    assert len(game.wait(0.2).events) == 2


def test_at_a_free_kick_they_keep_off_and_in_play_they_need_not(us: Team) -> None:
    game = Watching(us).ours(3, FRONT, 0.3).wait(3.0)
    assert game.events == []
    assert game.kick_of(us).wait(2.1).kinds == [AREA]


def test_a_robot_in_contact_with_an_opponent_may_be_pushed_there(us: Team) -> None:
    game = Watching(us, game=STOP).ours(3, FRONT, 0.3).theirs(1, FRONT + 0.18, 0.3).wait(3.0)
    assert game.events == []


def test_their_own_area_is_theirs(us: Team) -> None:
    assert Watching(us, game=STOP).ours(3, -FRONT, 0.3).wait(3.0).events == []


@pytest.mark.parametrize("restart", [Restart.FREE_KICK, Restart.KICKOFF])
@pytest.mark.parametrize(("gap", "near"), [(0.569, True), (0.571, False)])
def test_opponents_keep_off_the_ball_of_a_restart(us: Team, restart: Restart, gap: float, near: bool) -> None:
    game = Watching(us, game=STOP).theirs(1, gap, 0.0).ours(2, -0.2, 0.0).wait(2.1)
    assert game.kick_of(us, restart).kinds == [POINT] * near
    if near:
        assert (game.last.team, game.last.details["distance"]) == (us.other, pytest.approx(gap - 0.09))


def test_the_time_to_get_away_counts_from_the_stop(us: Team) -> None:
    game = Watching(us, game=STOP).theirs(1, 0.3, 0.0).wait(0.5).kick_of(us).wait(1.4)
    assert game.events == []
    assert game.wait(0.2).kinds == [POINT]
    assert game.wait(1.7).kinds == [POINT]
    assert game.wait(0.4).kinds == [POINT] * 2


@pytest.mark.parametrize(("speed", "fast"), [(1.49, False), (1.51, True)])
def test_robots_are_slow_in_stop_from_two_seconds_on(us: Team, speed: float, fast: bool) -> None:
    game = Watching(us, game=STOP).ours(1, -1.0, 1.0, vx=0.6 * speed, vy=0.8 * speed).wait(2.2)
    assert game.events == []
    assert game.wait(5.0).kinds == [FAST] * fast


def test_how_fast_and_from_when_on_are_settings(us: Team) -> None:
    game = Watching(us, game=STOP, stop_speed=0.5, grace=1.0).ours(1, -1.0, 1.0, vx=0.6)
    assert game.wait(1.2).events == []
    assert game.wait(0.3).kinds == [FAST]


def test_a_short_burst_is_forgiven(us: Team) -> None:
    game = Watching(us, game=STOP).wait(2.1).ours(1, -1.0, 1.0, vx=2.0).wait(0.28)
    assert game.ours(1, -1.0, 1.0, vx=1.0).wait(0.1).ours(1, -1.0, 1.0, vx=2.0).wait(0.28).events == []


def test_each_stop_counts_anew(us: Team) -> None:
    game = Watching(us, game=STOP).ours(1, -1.0, 1.0, vx=2.0).wait(3.0).now(PLAY).now(STOP).wait(3.0)
    assert game.kinds == [FAST] * 2


def test_a_placement_may_be_fast(us: Team) -> None:
    assert Watching(us, game=PLACEMENT).ours(1, -1.0, 1.0, vx=2.0).wait(3.0).events == []
