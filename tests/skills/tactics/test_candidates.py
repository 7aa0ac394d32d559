from __future__ import annotations

from dataclasses import replace

import pytest

from robobt.skills.aims import Pass
from robobt.skills.plan import Omitted
from robobt.skills.store import TeamStore
from robobt.skills.tactics.agree import agree
from robobt.skills.tactics.candidates import passes
from robobt.skills.tactics_settings import DEFAULT_TACTICS
from robobt.testing import frame, held, robot
from robobt.world import DIVISION_B, GameState, RobotLimits, RobotState, Team
from robobt.world.game import TeamStatus
from robobt.world.geometry import Point, distance
from robobt.world.rules import in_their_defense_area
from tests.skills.refereed import OPEN, free_kick

ME = robot(-1.0, 0.0, number=1, contact=True)
MATE = robot(0.5, 1.5, number=4)


def found(
    mates: tuple[RobotState, ...] = (MATE,),
    theirs: tuple[RobotState, ...] = (),
    places: dict[int, Point] | None = None,
    last: Pass | None = None,
    least: float = 0.15,
    chips: bool = True,
    game: GameState = OPEN,
    without: Omitted = "nothing",
    me: RobotState = ME,
) -> list[Pass]:
    team = TeamStore()
    team.plan.without = without
    team.plan.players.update((me.id, *(mate.id for mate in mates)))
    view = frame(me, held(me), mates, theirs, game=game)
    agree(view, team)
    team.plan.places.update(places or {})
    return passes(view, team, me, last, 1.5, least=least, most=100, chips=chips)


def test_there_are_passes_to_points_about_every_mate_the_best_first() -> None:
    rated = found((MATE, robot(1.0, -1.5, number=5)))
    assert {one.receiver for one in rated} == {4, 5}
    assert [one.score for one in rated] == sorted((one.score for one in rated), reverse=True)


def test_no_pass_is_too_short_out_of_the_field_or_into_a_defence_area() -> None:
    rated = found((robot(4.0, 1.4, number=4), robot(-0.2, 2.9, number=5), robot(-0.5, 0.3, number=6)))
    ball = held(ME)
    for one in rated:
        assert distance(ball, one.target) >= DEFAULT_TACTICS.shortest
        assert DIVISION_B.contains(*one.target)
        assert not in_their_defense_area(DIVISION_B, *one.target)


def test_at_a_restart_no_receiver_stands_too_close_to_their_defence_area() -> None:
    mates = (robot(3.28, 0.4, number=4), robot(4.0, 1.2, number=5))
    for game, close in ((OPEN, True), (free_kick(Team.BLUE, held(ME)), False)):
        rated = found(mates, game=game)
        assert rated
        assert any(in_their_defense_area(DIVISION_B, *one.target, 0.29) for one in rated) is close


def test_who_does_not_share_out_tasks_gets_no_pass() -> None:
    assert not found(())


def test_the_goalkeeper_is_not_passed_to_however_free_it_is() -> None:
    other = robot(-1.0, -2.0, number=5)
    assert found((MATE, other))[0].receiver == MATE.id
    goalkeeper = replace(OPEN, blue=TeamStatus(keeper=MATE.id))
    assert {one.receiver for one in found((MATE, other), game=goalkeeper)} == {other.id}


def test_the_ball_waits_for_a_receiver_that_has_a_long_way() -> None:
    far = (-1.3, 1.6)
    there = next(one for one in found(places={4: far}) if one.target == far)
    assert there.wait > 0.1
    here = next(one for one in found() if one.target == MATE.position)
    assert here.wait == 0.0


def test_a_pass_that_has_to_wait_for_its_receiver_counts_less() -> None:
    target = (-1.3, 1.6)
    me = robot(-1.0, 0.0, heading=1.75, number=1, contact=True)
    there, waiting = (
        next(one for one in found((mate,), places={4: target}, me=me) if one.target == target)
        for mate in (robot(*target, number=4), MATE)
    )
    assert waiting.wait > 0.2 > there.wait
    assert waiting.score < 0.97 * there.score


def test_the_last_pass_counts_more() -> None:
    last = found()[3]
    again = next(one for one in found(last=last) if one.target == last.target)
    assert again.score == pytest.approx(1.5 * last.score)


def test_a_hopeless_pass_is_left_out_unless_there_has_to_be_one() -> None:
    wall = tuple(robot(-0.6, 0.35 + 0.05 * i, number=i) for i in range(4))
    assert len(found(theirs=wall, least=0.0)) > len(found(theirs=wall))


def test_a_pass_flies_over_opponents_where_there_is_no_other_way_and_it_may() -> None:
    wall = (robot(-0.5, 0.43, number=1),)
    over = found(theirs=wall)
    assert any(one.chip and one.target == MATE.position for one in over)
    assert not any(one.chip for one in found(theirs=wall, chips=False))
    assert not any(one.chip for one in found())


def test_a_pass_that_is_to_go_on_with_one_touch_is_faster_and_can_be_done_without() -> None:
    me, mate = robot(3.2, -2.0, heading=1.5, number=1, contact=True), robot(2.0, 1.4, number=4)
    keeper = robot(4.3, -0.4, number=0)
    whole, without = (
        next(one for one in found((mate,), (keeper,), without=part, me=me) if one.target == mate.position)
        for part in ("nothing", "one_touch")
    )
    assert whole.score > without.score
    assert whole.speed > without.speed + 0.5


def test_a_short_pass_is_faster_where_robots_with_weak_dribblers_take_a_fast_ball() -> None:
    def fastest(taken: float, held: float) -> float:
        limits = RobotLimits(receive_speed=taken, hold_acceleration=held)
        return max(one.speed for one in found((robot(0.5, 0.5, number=4, limits=limits),)))

    assert fastest(3.0, 0.35) > 1.2 * fastest(0.5, 0.35)
    assert fastest(3.0, 3.0) == fastest(0.5, 3.0) == fastest(0.5, 0.35)
