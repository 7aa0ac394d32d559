"""Who may touch the ball in the defence areas, and for how long it may stay there."""

from __future__ import annotations

import pytest

from robobt.match.referee.events import EventKind
from robobt.world import DIVISION_A, DIVISION_B, FieldGeometry, Team
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS
from tests.match.referee.watching import Watching

HULL = ROBOT_RADIUS + BALL_RADIUS
MOUTH = 0.097
"""From the centre of a robot to that of the ball at its front [m]."""
FRONT = DIVISION_B.half_length - DIVISION_B.defense_depth


def touching(us: Team, x: float, y: float = 0.3, number: int = 3, wait: float = 0.6) -> Watching:
    """Our robot touches the ball from behind, its centre at (x, y), after so long in play."""
    game = Watching(us).wait(wait)
    return game.ours(number, x, y).touch(number).roll(x + MOUTH, y)


@pytest.mark.parametrize(("gap", "inside"), [(0.069, True), (0.071, False)])
def test_an_attacker_that_touches_partly_inside_their_area_is_told(
    us: Team, gap: float, inside: bool
) -> None:
    game = touching(us, FRONT - gap).wait(0.5)
    assert game.kinds == [EventKind.ATTACKER_TOUCHED_BALL_IN_DEFENSE_AREA] * inside


def test_the_distance_of_the_hull_is_told_as_zero_inside(us: Team) -> None:
    assert touching(us, FRONT - 0.05).last.details["distance"] == 0.0


def test_it_is_told_again_after_two_seconds(us: Team) -> None:
    game = touching(us, FRONT)
    assert len(game.wait(1.9).events) == 1
    assert len(game.wait(0.2).events) == 2


def test_the_first_half_second_of_play_does_not_count(us: Team) -> None:
    assert touching(us, FRONT, wait=0.4).events == []


def test_touching_with_an_opponent_is_no_offence(us: Team) -> None:
    game = Watching(us).wait(0.6).ours(3, FRONT, 0.3).theirs(1, FRONT + MOUTH + HULL, 0.3)
    assert game.touch(3).roll(FRONT + MOUTH, 0.3).events == []


@pytest.mark.parametrize(("depth", "inside"), [(0.091, True), (0.089, False)])
def test_a_defender_that_touches_wholly_inside_its_area_is_told(us: Team, depth: float, inside: bool) -> None:
    game = touching(us, -FRONT - depth)
    assert game.kinds == [EventKind.DEFENDER_IN_DEFENSE_AREA] * inside


def test_the_keeper_may_and_only_in_its_own_area(us: Team) -> None:
    assert touching(us, -FRONT - 0.3, number=0).events == []
    assert touching(us, FRONT + 0.3, number=0).kinds == [EventKind.ATTACKER_TOUCHED_BALL_IN_DEFENSE_AREA]


@pytest.mark.parametrize(("gap", "offence"), [(0.189, False), (0.191, True)])
def test_a_defender_that_may_be_pushed_is_not_told(us: Team, gap: float, offence: bool) -> None:
    game = Watching(us).wait(0.6).ours(3, -FRONT - 0.3, 0.3).theirs(1, -FRONT - 0.3, 0.3 + gap)
    game.touch(3).roll(-FRONT - 0.3 + MOUTH, 0.3)
    assert game.kinds == [EventKind.DEFENDER_IN_DEFENSE_AREA] * offence


@pytest.mark.parametrize(("field", "limit"), [(DIVISION_A, 5.0), (DIVISION_B, 10.0)], ids=["a", "b"])
def test_the_ball_stays_in_an_area_for_the_divisions_time(
    us: Team, field: FieldGeometry, limit: float
) -> None:
    game = Watching(us, field, no_progress_time=None).roll(-field.half_length + 0.5, 0.0)
    assert game.wait(limit - 0.1).events == []
    (held,) = game.wait(0.2).events
    assert (held.kind, held.team) == (EventKind.KEEPER_HELD_BALL, us)


def test_the_time_in_an_area_is_that_of_the_settings(us: Team) -> None:
    game = Watching(us, keeper_hold_time=3.0).roll(-4.0, 0.0).wait(2.9)
    assert game.events == []
    assert game.wait(0.2).kinds == [EventKind.KEEPER_HELD_BALL]


def test_out_of_the_area_the_time_begins_anew(us: Team) -> None:
    game = Watching(us, no_progress_time=None).roll(-4.0, 0.0).wait(9.0).roll(-3.4, 0.0)
    assert game.roll(-4.0, 0.0).wait(9.0).events == []
