from __future__ import annotations

from dataclasses import replace

import pytest

from robobt.skills.conditions.carried_far import CarriedFar
from robobt.testing import frame, held, robot
from robobt.tree import Status
from robobt.world.limits import RobotLimits
from tests.skills.fixed_world import Alone

PERIOD = 1 / 60


def carry(alone: Alone, start: float, end: float, steps: int, tick: int = 0, contact: bool = True) -> Status:
    """The robot drives from x = start to x = end with the ball, or without contact well behind it."""
    status = Status.INVALID
    for step in range(steps + 1):
        me = robot(start + (end - start) * step / steps, contact=contact)
        ball = held(me) if contact else (me.x + 0.3, 0.0)
        status = alone.tick(frame(me, ball, time=(tick + step) * PERIOD))
    return status


def test_the_way_with_the_ball_is_measured_from_where_it_got_it() -> None:
    assert carry(Alone(CarriedFar(limit=0.8)), 1.0, 1.79, 30) is Status.FAILURE
    assert carry(Alone(CarriedFar(limit=0.8)), 1.0, 1.81, 30) is Status.SUCCESS


def test_what_a_fast_ball_rolls_while_it_is_let_go_counts() -> None:
    me = robot(contact=True)
    alone = Alone(CarriedFar(limit=0.3))
    assert alone.tick(frame(me, (*held(me), 1.9, 0.0))) is Status.FAILURE
    assert alone.tick(frame(me, (*held(me), 2.1, 0.0), time=PERIOD)) is Status.SUCCESS


def test_a_ball_that_is_not_clear_of_the_robot_is_still_carried() -> None:
    alone = Alone(CarriedFar(limit=0.8))
    carry(alone, 0.0, 0.7, 30)
    me = robot(0.76)
    assert alone.tick(frame(me, (me.x + 0.15, 0.0), time=31 * PERIOD)) is Status.SUCCESS
    assert alone.tick(frame(me, (me.x + 0.19, 0.0), time=32 * PERIOD)) is Status.FAILURE


def test_there_and_back_is_not_far() -> None:
    alone = Alone(CarriedFar(limit=0.8))
    carry(alone, 0.0, 0.5, 30)
    assert carry(alone, 0.5, 0.0, 30, tick=31) is Status.FAILURE


def test_letting_the_ball_go_starts_the_way_anew() -> None:
    alone = Alone(CarriedFar(limit=0.8))
    carry(alone, 0.0, 0.7, 30)
    assert carry(alone, 0.7, 0.8, 1, tick=31, contact=False) is Status.FAILURE
    assert carry(alone, 0.8, 1.5, 30, tick=33) is Status.FAILURE


def test_after_a_pause_it_counts_anew() -> None:
    alone = Alone(CarriedFar(limit=0.8))
    carry(alone, 0.0, 0.7, 30)
    assert carry(alone, 0.9, 1.5, 30, tick=120) is Status.FAILURE


def test_a_ball_that_the_hull_pushes_along_is_carried() -> None:
    alone = Alone(CarriedFar(limit=0.8))
    status = Status.INVALID
    for step in range(31):
        me = robot(-step / 30.0, 0.0)
        status = alone.tick(frame(me, (me.x - 0.112, 0.0), time=step * PERIOD))
    assert status is Status.SUCCESS


WEAK = RobotLimits(hold_acceleration=0.35, hold_straight=1.0)


def carry_weakly(alone: Alone, start: float, end: float, tick: int, *, away: int = 0) -> Status:
    """As carry() in 30 steps with a weak dribbler; the ball seems to be far ahead for some ticks first."""
    status = Status.INVALID
    for step in range(-away, 31):
        me = replace(robot(start + (end - start) * max(step, 0) / 30, contact=step >= 0), limits=WEAK)
        ball = held(me) if step >= 0 else (me.x + 0.4, 0.0)
        status = alone.tick(frame(me, ball, time=(tick + step) * PERIOD))
    return status


@pytest.mark.parametrize(("away", "status"), [(5, Status.SUCCESS), (12, Status.FAILURE)])
def test_a_ball_that_a_weak_dribbler_loses_for_a_moment_is_still_carried(away: int, status: Status) -> None:
    alone = Alone(CarriedFar(limit=0.8))
    assert carry_weakly(alone, 0.0, 0.5, 0) is Status.FAILURE
    assert carry_weakly(alone, 0.5, 0.8, 31 + away, away=away) is status


def test_a_pass_that_leaves_a_weak_dribbler_is_not_a_carry() -> None:
    alone = Alone(CarriedFar(limit=0.8))
    carry_weakly(alone, 0.0, 0.5, 0)
    me = replace(robot(0.5), limits=WEAK)
    assert alone.tick(frame(me, (0.9, 0.0, 5.0, 0.0), time=31 * PERIOD)) is Status.FAILURE


def test_a_ball_that_a_weak_dribbler_lets_go_rolls_on() -> None:
    assert carry_weakly(Alone(CarriedFar(limit=0.8)), 0.0, 0.73, 0) is Status.FAILURE
    assert carry_weakly(Alone(CarriedFar(limit=0.8)), 0.0, 0.75, 0) is Status.SUCCESS


def test_a_weak_dribbler_s_short_pause_does_not_count_anew() -> None:
    alone = Alone(CarriedFar(limit=0.8))
    carry_weakly(alone, 0.0, 0.5, 0)
    assert carry_weakly(alone, 0.6, 0.8, 42) is Status.SUCCESS


@pytest.mark.parametrize("limits", [RobotLimits(), WEAK])
@pytest.mark.parametrize(("tick", "gap"), [(120, 0.15), (-600, 0.15), (-600, 3.0)])
def test_after_a_pause_or_an_earlier_time_a_ball_that_it_does_not_touch_is_not_carried(
    limits: RobotLimits, tick: int, gap: float
) -> None:
    alone = Alone(CarriedFar(limit=0.8))
    carry_weakly(alone, 0.0, 0.9, 0)
    me = replace(robot(1.5), limits=limits)
    for step in range(3):
        ball = (me.x + gap, 0.0)
        assert alone.tick(frame(me, ball, time=(tick + step) * PERIOD)) is Status.FAILURE
