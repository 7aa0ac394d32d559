from __future__ import annotations

from dataclasses import replace
from math import cos, hypot, radians, sin

import pytest

from robobt.skills import PickUpBall
from robobt.testing import Trial, blue, eventually, frame, held, robot, succeeds
from robobt.tree import Status
from robobt.world import RobotCommand
from robobt.world.limits import RobotLimits
from robobt.world.rules import has_ball
from tests.skills.fixed_world import Alone


def test_it_creeps_forward_with_the_dribbler_on() -> None:
    alone = Alone(PickUpBall())
    assert alone.tick(frame(robot(), ball=(0.18, 0.0))) is Status.RUNNING
    assert alone.command == RobotCommand(vx=0.5, dribbler=True)


def test_the_paper_s_speed_is_a_parameter() -> None:
    alone = Alone(PickUpBall(speed=0.2))
    alone.tick(frame(robot(), ball=(0.18, 0.0)))
    assert alone.command.vx == pytest.approx(0.2)


def test_it_turns_to_a_ball_that_lies_aside_before_it_closes_in() -> None:
    alone = Alone(PickUpBall())
    alone.tick(frame(robot(), ball=(0.0, 0.18)))
    assert alone.command.omega > 1.0
    assert hypot(alone.command.vx, alone.command.vy) < 0.01


def test_it_closes_in_relative_to_a_rolling_ball() -> None:
    alone = Alone(PickUpBall())
    alone.tick(frame(robot(), ball=(0.18, 0.0, 0.6, 0.0)))
    assert alone.command.vx == pytest.approx(1.1)


@pytest.mark.parametrize(("speed", "faster"), [(1.2, False), (0.3, True)])
def test_a_weak_dribbler_pushes_no_ball_on_that_its_sensor_misses(speed: float, faster: bool) -> None:
    alone = Alone(PickUpBall())
    weak = RobotLimits(hold_acceleration=0.35, hold_straight=1.0)
    me = replace(robot(velocity=(speed, 0.0, 0.0)), limits=weak)
    alone.tick(frame(me, ball=(0.09, 0.0, speed, 0.0)))
    assert (alone.command.vx > speed) is faster


def test_it_succeeds_once_the_ball_stays_in_the_mouth() -> None:
    alone, me = Alone(PickUpBall(settle=0.05)), robot(contact=True)
    ticks = [alone.tick(frame(me, ball=held(me), time=k / 60)) for k in range(5)]
    assert ticks == [Status.RUNNING] * 3 + [Status.SUCCESS] * 2


def test_a_break_of_contact_starts_the_count_anew() -> None:
    alone, me = Alone(PickUpBall(settle=0.05)), robot(contact=True)
    for k, contact in enumerate([True, True, True, False, True, True, True]):
        me.ball_contact = contact
        assert alone.tick(frame(me, ball=held(me), time=k / 60)) is Status.RUNNING


def test_with_the_ball_it_brakes_gently() -> None:
    alone, me = Alone(PickUpBall()), robot(contact=True, velocity=(0.5, 0.0, 0.0))
    alone.tick(frame(me, ball=held(me)))
    assert alone.command.vx == pytest.approx(0.5 - 1.5 / 60)
    assert alone.command.dribbler


def test_a_ball_far_away_is_not_one_to_pick_up() -> None:
    assert Alone(PickUpBall()).tick(frame(robot(), ball=(0.31, 0.0))) is Status.FAILURE


@pytest.mark.parametrize("degrees", [-60, -20, 0, 35, 60])
@pytest.mark.parametrize("preset", ["default", "grsim", "erforce"])
def test_it_takes_a_resting_ball(preset: str, degrees: int) -> None:
    pick, angle = PickUpBall(), radians(degrees)
    trial = Trial(
        {blue(0): pick}, {blue(0): (0.0, 0.0, 0.0)}, (0.2 * cos(angle), 0.2 * sin(angle)), settings=preset
    )
    end = trial.run(1.5, eventually("it has the ball", succeeds(pick)))
    assert has_ball(end.own[0], end.ball)


@pytest.mark.parametrize(("speed", "commanded"), [(0.5, 0.3), (0.2, 0.2), (None, 0.3)])
def test_it_closes_in_no_faster_than_the_dribbler_takes_the_ball(
    speed: float | None, commanded: float
) -> None:
    alone, me = Alone(PickUpBall(speed=speed)), robot()
    me.limits = me.limits.model_copy(update={"catch_speed": 0.3})
    alone.tick(frame(me, ball=(0.18, 0.0)))
    assert alone.command.vx == pytest.approx(commanded)
