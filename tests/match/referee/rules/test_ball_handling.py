"""Dribbling, ball speed, double touch."""

from __future__ import annotations

from math import pi

import pytest

from robobt.match.referee.events import EventKind
from robobt.world import Team
from robobt.world.game import Restart
from robobt.world.rules import KEPT_GAP
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS
from tests.match.referee.watching import PLAY, STOP, Watching

HULL = ROBOT_RADIUS + BALL_RADIUS
MOUTH = 0.097
"""From the centre of a robot to that of the ball at its front [m]."""


def carry(us: Team, way: float, gap_at_half: float = 0.0) -> Watching:
    """We take the ball so far along x."""
    game = Watching(us).touch(1)
    for step in range(101):
        x = way * step / 100
        gap = gap_at_half if step == 50 else 0.0
        game.ours(1, x - (HULL + gap if gap else MOUTH), 0.0).roll(x, 0.0)
    return game


def test_a_carry_of_more_than_a_metre_is_told_once_from_its_start(us: Team) -> None:
    game = carry(us, 1.3)
    assert game.kinds == [EventKind.BOT_DRIBBLED_BALL_TOO_FAR]
    assert game.last.robot == (us, 1)
    assert game.at(game.last) == (0.0, 0.0)


def test_a_carry_of_less_is_fair(us: Team) -> None:
    assert carry(us, 0.99).events == []


def test_a_visible_gap_begins_the_metre_anew_and_a_smaller_one_does_not(us: Team) -> None:
    assert carry(us, 1.5, KEPT_GAP + 0.005).events == []
    assert carry(us, 1.5, KEPT_GAP - 0.005).kinds == [EventKind.BOT_DRIBBLED_BALL_TOO_FAR]


def test_the_way_of_a_placement_does_not_count(us: Team) -> None:
    game = Watching(us, game=STOP).touch(1)
    game.ours(1, -MOUTH, 0.0).roll(0.0, 0.0).ours(1, 2.0 - MOUTH, 0.0).roll(2.0, 0.0)
    assert game.now(PLAY).wait(0.1).events == []


@pytest.mark.parametrize(("speed", "too_fast"), [(6.505, False), (6.515, True)])
def test_a_kick_is_too_fast_above_the_limit(us: Team, speed: float, too_fast: bool) -> None:
    game = Watching(us).touch(1).roll(0.0, 0.0).roll(0.1, 0.0, 0.6 * speed, 0.8 * speed)
    game.roll(0.2, 0.0, 6.51).roll(0.3, 0.0, 6.0)
    assert game.kinds == [EventKind.BOT_KICKED_BALL_TOO_FAST] * too_fast
    if too_fast:
        assert game.last.details["initial_ball_speed"] == pytest.approx(speed)


@pytest.mark.parametrize(("speed", "too_fast"), [(6.505, False), (6.515, True)])
def test_a_chip_is_as_fast_as_the_ball_is_in_space(us: Team, speed: float, too_fast: bool) -> None:
    game = Watching(us).touch(1).roll(0.0, 0.0).roll(0.1, 0.0, 0.6 * speed, 0.0, 0.1, 0.8 * speed)
    assert game.kinds == [EventKind.BOT_KICKED_BALL_TOO_FAST] * too_fast
    assert all(event.details["chipped"] for event in game.events)


def test_the_kick_of_a_restart_counts_once(us: Team) -> None:
    game = Watching(us).kick_of(us).touch(1).roll(0.1, 0.0, 6.7).in_play().wait(0.1)
    assert game.kinds == [EventKind.BOT_KICKED_BALL_TOO_FAST]


def kicked(us: Team, restart: Restart, x: float) -> Watching:
    """We move the ball of a restart to x and stay in contact."""
    game = Watching(us, game=STOP, stop_distance=None).wait(0.1).ours(1, -MOUTH, 0.0).kick_of(us, restart)
    game.touch(1).ours(1, x - MOUTH, 0.0).roll(x, 0.0)
    return game.in_play()


@pytest.mark.parametrize("restart", [Restart.FREE_KICK, Restart.KICKOFF])
def test_staying_at_the_ball_for_more_than_five_centimetres_is_a_double_touch(
    us: Team, restart: Restart
) -> None:
    game = kicked(us, restart, 0.051)
    assert game.kinds == [EventKind.ATTACKER_DOUBLE_TOUCHED_BALL]
    assert game.last.robot == (us, 1)
    assert game.at(game.last) == (0.0, 0.0)


def test_staying_at_a_ball_that_has_hardly_moved_is_none(us: Team) -> None:
    # The time to take the kick is over: the ball is in play where it lies.
    game = kicked(us, Restart.FREE_KICK, 0.049)
    game.ours(1, 0.2 - MOUTH, 0.0).roll(0.2, 0.0)
    assert game.events == []


def test_a_second_robot_that_has_touched_it_before_may_go_on(us: Team) -> None:
    # The ball of a short kick meets a mate before it is in play.
    game = Watching(us, game=STOP, stop_distance=None).ours(2, 0.04 + MOUTH, 0.0, heading=pi).kick_of(us)
    game.touch(1).roll(0.02, 0.0).touch(2).roll(0.04, 0.0)
    game.ours(2, 0.06 + MOUTH, 0.0, heading=pi).roll(0.06, 0.0).in_play().wait(0.1)
    assert game.events == []


def test_a_mate_that_stops_a_kick_between_two_frames_did_not_take_it(us: Team) -> None:
    # Seen in a match: no frame showed the taker in touch with the ball, and the mate kept it.
    game = Watching(us, game=STOP, stop_distance=None)
    game.ours(1, -0.11, 0.0).ours(2, 0.1 + MOUTH, 0.0, heading=pi).kick_of(us).wait(0.05)
    game.touch(2).roll(0.1, 0.0).in_play().wait(0.1)
    assert game.events == []


def free_ball(us: Team) -> Watching:
    game = kicked(us, Restart.FREE_KICK, 0.04)
    game = Watching(us, game=STOP, stop_distance=None).ours(1, -MOUTH, 0.0).kick_of(us).touch(1)
    game.roll(0.5, 0.0).in_play().wait(0.1)
    assert game.events == []
    return game


def test_coming_back_to_the_ball_is_a_double_touch(us: Team) -> None:
    game = free_ball(us).ours(1, 0.5 - MOUTH, 0.0).tick()
    assert game.kinds == [EventKind.ATTACKER_DOUBLE_TOUCHED_BALL]


def test_after_another_robots_touch_it_is_none(us: Team) -> None:
    game = free_ball(us).touch(2).tick().touch(1).ours(1, 0.5 - MOUTH, 0.0).tick()
    assert game.events == []


def test_another_robot_in_contact_ends_it_too(us: Team) -> None:
    game = free_ball(us).theirs(4, 0.5 + HULL, 0.0).tick().ours(1, 0.5 - MOUTH, 0.0).tick()
    assert game.events == []


def test_a_forced_start_has_no_kicker(us: Team) -> None:
    game = Watching(us).kick_of(us).touch(1).now(STOP).roll(0.3, 0.0).now(PLAY)
    assert game.ours(1, 0.3 - MOUTH, 0.0).wait(0.1).events == []
