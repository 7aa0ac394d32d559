"""Crashes and pushing."""

from __future__ import annotations

import pytest

from robobt.match.referee.events import EventKind
from robobt.world import DIVISION_B, GameState, RobotId, Team
from robobt.world.game import RefereeCommand
from tests.match.referee.watching import STOP, Watching

UNIQUE, DRAWN, PUSHED = EventKind.BOT_CRASH_UNIQUE, EventKind.BOT_CRASH_DRAWN, EventKind.BOT_PUSHED_BOT


@pytest.mark.parametrize(("speed", "crash"), [(1.79, False), (1.81, True)])
def test_a_fast_robot_that_hits_one_at_rest_crashes(us: Team, speed: float, crash: bool) -> None:
    # 1.5 m/s, and 0.3 m/s that it may have braked.
    game = Watching(us).ours(1, 0.0, 1.0, vx=speed).theirs(2, 0.18, 1.0).wait(0.5)
    assert game.kinds == [UNIQUE] * crash
    if crash:
        assert game.last.robot == (us, 1)
        assert game.last.details["victim"] == 2
        assert game.last.details["crash_speed"] == pytest.approx(1.51)


@pytest.mark.parametrize(("gap", "crash"), [(0.1979, True), (0.1981, False)])
def test_only_robots_that_touch_crash(us: Team, gap: float, crash: bool) -> None:
    game = Watching(us).ours(1, 0.0, 1.0, vx=2.5).theirs(2, gap, 1.0).tick()
    assert game.kinds == [UNIQUE] * crash


@pytest.mark.parametrize(("theirs", "kind"), [(-1.01, DRAWN), (-0.99, UNIQUE)])
def test_at_like_speeds_both_are_at_fault(us: Team, theirs: float, kind: EventKind) -> None:
    game = Watching(us).ours(1, 0.0, 1.0, vx=1.3).theirs(2, 0.18, 1.0, vx=theirs).tick()
    assert game.kinds == [kind]
    numbers = {us: 1, us.other: 2}
    if kind is DRAWN:
        assert game.last.team is None
        assert game.last.details["bot_blue"] == numbers[Team.BLUE]
        assert game.last.details["bot_yellow"] == numbers[Team.YELLOW]


def test_only_the_speed_along_the_line_of_centres_counts(us: Team) -> None:
    assert Watching(us).ours(1, 0.0, 1.0, vy=3.0).theirs(2, 0.18, 1.0).tick().events == []


def test_robots_of_one_team_may_crash(us: Team) -> None:
    assert Watching(us).ours(1, 0.0, 1.0, vx=3.0).ours(2, 0.18, 1.0).tick().events == []


def test_the_speeds_before_robots_stopped_each_other_count(us: Team) -> None:
    game = Watching(us).ours(1, 0.0, 1.0, vx=2.0).theirs(2, 0.21, 1.0).tick()
    assert game.events == []
    game.ours(1, 0.03, 1.0, vx=0.6).theirs(2, 0.22, 1.0, vx=0.5).tick()
    assert game.kinds == [UNIQUE]


def test_crashes_count_in_stop_and_not_in_halt(us: Team) -> None:
    halt = GameState(RefereeCommand.HALT, may_touch=False)
    for game, kinds in ((STOP, [UNIQUE]), (halt, [])):
        watching = Watching(us, game=game).ours(1, 0.0, 1.0, vx=2.0).theirs(2, 0.18, 1.0)
        assert watching.tick().kinds == kinds


def test_the_same_two_are_told_again_after_two_seconds(us: Team) -> None:
    game = Watching(us).ours(1, 0.0, 1.0, vx=2.0).theirs(2, 0.18, 1.0)
    assert len(game.wait(1.9).events) == 1
    assert len(game.wait(0.2).events) == 2


def shove(us: Team, way: float, theirs: float = 0.5, x: float = 0.0, **settings: object) -> Watching:
    """Our robot drives one of theirs along x, which moves at a speed of its own."""
    game = Watching(us, **settings)
    for step in range(21):
        moved = x + way * step / 20
        game.ours(1, moved, 1.0, vx=0.5).theirs(2, moved + 0.18, 1.0, vx=theirs).tick()
    return game


def test_a_robot_shoved_by_more_than_twenty_centimetres_is_pushed(us: Team) -> None:
    game = shove(us, 0.21, pushing=True)
    assert (game.kinds, game.last.robot) == ([PUSHED], RobotId(us, 1))
    assert game.last.details["victim"] == 2


def test_a_shorter_way_is_fair(us: Team) -> None:
    assert shove(us, 0.19, pushing=True).events == []


def test_a_robot_that_pushes_back_is_not_pushed(us: Team) -> None:
    assert shove(us, 0.3, theirs=-0.1, pushing=True).events == []


def test_a_short_push_into_the_own_area_counts(us: Team) -> None:
    front = DIVISION_B.half_length - DIVISION_B.defense_depth
    game = shove(us, 0.1, x=front - 0.18 - 0.05, pushing=True)
    assert game.kinds == [PUSHED]


def test_pushing_is_not_looked_for_by_default(us: Team) -> None:
    assert shove(us, 0.5).events == []
