"""Not running into opponents while the ball is not in play."""

from __future__ import annotations

from math import hypot

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robobt.motion.give_way import slowed_in_play, slowed_towards
from robobt.motion.path_planner import travel
from robobt.testing import frame, robot
from robobt.world import RobotCommand, RobotState
from robobt.world.game import Team
from robobt.world.records import ROBOT, Robot, mover_records, movers, robot_of
from tests.skills.fixed_world import moved
from tests.skills.refereed import OPEN, STOP, free_kick

FULL = RobotCommand(3.0, 0.0, 0.0)
speed = st.floats(-3.0, 3.0)


def record(me: RobotState) -> Robot:
    return robot_of(me).view(ROBOT)[0]


def order(me: RobotState, *others: RobotState, ahead: float = 3.0, left: float = 0.0) -> RobotCommand:
    return RobotCommand(*slowed_towards(record(me), (ahead, left), mover_records(movers(others)), -1, 0))


def test_a_robot_brakes_before_one_that_stands_in_its_way() -> None:
    me, other = robot(number=1), robot(1.5, 0.0)
    for _ in range(180):
        before = me
        me = moved(me, order(me, other), 1 / 60)
        if hypot(other.x - me.x, other.y - me.y) < 0.19:
            break
    assert before.speed < 1.4


def test_it_stops_for_one_that_comes_at_full_speed() -> None:
    oncoming = robot(0.8, 0.0, velocity=(-3.0, 0.0, 0.0))
    assert order(robot(number=1), oncoming).vx == 0.0


def test_a_mate_is_touched_more_gently_than_an_opponent() -> None:
    here = record(robot(number=1))
    at_it = mover_records(movers([robot(0.18, 0.0)]))
    opponent, mate = (slowed_towards(here, (3.0, 0.0), at_it, -1, mates) for mates in (0, 1))
    assert opponent == pytest.approx((1.0, 0.0))
    assert mate == pytest.approx((0.3, 0.0))


def test_what_passes_by_or_is_far_away_does_not_matter() -> None:
    assert order(robot(number=1), robot(0.5, 0.6)) == FULL
    assert order(robot(number=1), robot(-0.3, 0.0)) == FULL
    assert order(robot(number=1), robot(2.5, 0.0)) == FULL


@given(x=st.floats(-2, 2), y=st.floats(-2, 2), vx=speed, vy=speed, asked=speed, across=speed)
def test_nobody_is_made_to_go_faster(
    x: float, y: float, vx: float, vy: float, asked: float, across: float
) -> None:
    me, other = robot(number=1), robot(x, y, velocity=(vx, vy, 0.0))
    given_way = order(me, other, ahead=asked, left=across)
    assert hypot(given_way.vx, given_way.vy) <= hypot(asked, across) + 1e-9


def test_only_while_the_ball_is_not_in_play() -> None:
    me, other = robot(number=1, velocity=(3.0, 0.0, 0.0)), robot(0.6, 0.05)
    for game, slower in ((OPEN, False), (STOP, True), (free_kick(Team.YELLOW, (0.0, 2.0)), True)):
        seen = frame(me, (0.0, 2.0), opponents=(other,), game=game)
        command = travel(seen, me, (2.0, 0.0), 0.0, me.limits)
        assert (command.vx < 2.0) is slower


def in_play(me: RobotState, other: RobotState, ahead: float = 3.0, left: float = 0.0) -> RobotCommand:
    return RobotCommand(*slowed_in_play(record(me), (ahead, left), mover_records(movers([other])), 4.0))


def test_in_play_a_robot_touches_one_that_stands_slower_than_a_crash_is() -> None:
    me, other = robot(number=1), robot(1.5, 0.0)
    for _ in range(180):
        before = me
        me = moved(me, in_play(me, other), 1 / 60)
        if hypot(other.x - me.x, other.y - me.y) < 0.19:
            break
    assert 1.0 < before.speed < 1.5


def test_in_play_it_need_not_stop_for_one_that_is_at_fault_itself() -> None:
    oncoming = robot(0.4, 0.0, velocity=(-2.0, 0.0, 0.0))
    assert 1.0 < in_play(robot(number=1), oncoming).vx <= 1.6


@given(x=st.floats(-2, 2), y=st.floats(-2, 2), vx=speed, vy=speed, asked=speed, across=speed)
def test_in_play_nobody_is_made_to_go_faster_at_the_other(
    x: float, y: float, vx: float, vy: float, asked: float, across: float
) -> None:
    me, other = robot(number=1), robot(x, y, velocity=(vx, vy, 0.0))
    given_way = in_play(me, other, ahead=asked, left=across)
    towards = asked * x + across * y
    assert given_way.vx * x + given_way.vy * y <= towards + 1e-9
