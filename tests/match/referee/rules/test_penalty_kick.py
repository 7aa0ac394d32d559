"""When a penalty kick has failed."""

from __future__ import annotations

import pytest

from robobt.match.referee.events import EventKind
from robobt.world import Team
from robobt.world.game import Restart
from tests.match.referee.watching import Watching

FAILED = EventKind.PENALTY_KICK_FAILED
MOUTH = 0.097
"""From the centre of a robot to that of the ball at its front [m]."""


def penalty(us: Team) -> Watching:
    """Our penalty kick from x = -1.5, kicked."""
    game = Watching(us, game=Watching(us).game).roll(-1.5, 0.0).kick_of(us, Restart.PENALTY)
    return game.touch(1).roll(-1.4, 0.0, 4.0).in_play()


def test_the_ball_on_its_way_has_not_failed(us: Team) -> None:
    assert penalty(us).roll(4.0, 0.0, 3.0).wait(1.0).events == []


@pytest.mark.parametrize(("vx", "failed"), [(-0.05, True), (0.05, False)])
def test_the_keeper_turns_it_by_ninety_degrees(us: Team, vx: float, failed: bool) -> None:
    game = penalty(us).roll(4.0, 0.0, 3.0).touch(0, us.other).roll(4.1, 0.0, vx, 1.0)
    assert game.kinds == [FAILED] * failed
    if failed:
        assert game.last.team is us


def test_a_turn_is_one_within_a_fifth_of_a_second(us: Team) -> None:
    game = penalty(us).touch(0, us.other).roll(4.0, 0.0, 1.0, 0.5).wait(0.3)
    assert game.roll(4.1, 0.0, 0.5, 1.0).wait(0.3).roll(4.1, 0.2, -0.1, 1.0).events == []


def test_the_keeper_stops_it(us: Team) -> None:
    assert penalty(us).touch(0, us.other).roll(4.1, 0.0).kinds == [FAILED]


def test_the_kicker_may_stop_it(us: Team) -> None:
    assert penalty(us).ours(1, 1.0 - MOUTH, 0.0).roll(1.0, 0.0).wait(1.0).events == []


@pytest.mark.parametrize(("back", "failed"), [(0.04, False), (0.06, True)])
def test_the_kicker_may_not_take_it_back(us: Team, back: float, failed: bool) -> None:
    game = penalty(us).ours(1, 1.0 - MOUTH, 0.0).roll(1.0, 0.0)
    game.ours(1, 1.0 - back - MOUTH, 0.0).roll(1.0 - back, 0.0, -0.5)
    assert game.kinds == [FAILED] * failed


def test_a_ball_that_comes_back_from_the_post_has_not_failed(us: Team) -> None:
    assert penalty(us).roll(4.4, 0.5, 3.0).roll(4.0, 0.5, -2.0).events == []


def test_before_the_kick_nothing_has(us: Team) -> None:
    game = Watching(us).roll(-1.5, 0.0).kick_of(us, Restart.PENALTY).touch(0, us.other)
    assert game.wait(2.0).events == []
