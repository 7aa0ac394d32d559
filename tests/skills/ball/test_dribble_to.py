from __future__ import annotations

from math import copysign, hypot, pi

import pytest

from robobt.motion.dribbling import MAX_ACCELERATION, MAX_TURN, TURN_ACCELERATION, dribbling_limits, settle
from robobt.sim import SimSettings
from robobt.skills import DribbleTo
from robobt.testing import (
    Trial,
    alone,
    always,
    ball_near,
    blue,
    dribbles_too_far,
    eventually,
    fails,
    frame,
    held,
    never,
    robot,
    touches_a_robot,
    yellow,
)
from robobt.tree import Status
from robobt.world import Frame, RobotLimits
from robobt.world.geometry import to_robot_frame
from robobt.world.state import TOUCH_DISTANCE
from tests.skills.fixed_world import Alone, moved

MOUTH = 0.0975


def carrying(frame: Frame) -> bool:
    me, ball = frame.own[0], frame.ball
    return hypot(ball.x - me.x, ball.y - me.y) < 0.13


def test_without_target_or_ball_it_fails() -> None:
    me = robot()
    assert Alone(DribbleTo()).tick(frame(me, ball=held(me))) is Status.FAILURE
    alone = Alone(DribbleTo(), target=(2.0, 0.0))
    assert alone.tick(frame(me, ball=(0.5, 0.0))) is Status.FAILURE
    assert alone.tree.feedback_message == "it does not have the ball"


def test_it_is_done_when_the_ball_is_near_the_target() -> None:
    me = robot()
    assert Alone(DribbleTo(target=(0.39, 0.0))).tick(frame(me, ball=held(me))) is Status.SUCCESS
    assert Alone(DribbleTo(target=(0.41, 0.0))).tick(frame(me, ball=held(me))) is Status.RUNNING


def test_it_turns_before_it_drives() -> None:
    alone, me = Alone(DribbleTo(target=(-2.0, 0.0))), robot(contact=True)
    alone.tick(frame(me, ball=held(me)))
    assert hypot(alone.command.vx, alone.command.vy) < 1e-9
    assert alone.command.omega != 0.0
    assert alone.command.dribbler


@pytest.mark.parametrize(("keep", "turns"), [(0.0, {-1.0, 1.0}), (0.2, {1.0})])
def test_it_keeps_to_its_way_where_two_like_ones_take_turns(keep: float, turns: set[float]) -> None:
    alone, me = Alone(DribbleTo(keep=keep)), robot(contact=True)
    seen = set()
    for step in range(20):
        alone.store.target = (0.0, 1.0 if step % 2 == 0 else -1.0)
        alone.tick(frame(me, ball=held(me), time=step / 60))
        seen.add(copysign(1.0, alone.command.omega))
    assert seen == turns


def test_another_way_that_lasts_is_taken() -> None:
    alone, me = Alone(DribbleTo(keep=0.2)), robot(contact=True)
    for step in range(20):
        alone.store.target = (0.0, 1.0 if step == 0 else -1.0)
        alone.tick(frame(me, ball=held(me), time=step / 60))
        assert (alone.command.omega > 0.0) is (step / 60 < 0.2)


@pytest.mark.parametrize("heading", [0.0, 1.0])
def test_its_commands_stay_within_what_the_dribbler_bears(heading: float) -> None:
    alone, period = Alone(DribbleTo(target=(2.0, 0.0))), 1 / 60
    me = robot(heading=heading, velocity=(0.5, 0.0, 1.0), contact=True)
    alone.tick(frame(me, ball=held(me), period=period))
    command = alone.command
    assert abs(command.omega) <= MAX_TURN
    assert abs(command.omega - me.omega) <= TURN_ACCELERATION * period + 1e-9
    middle = heading + command.omega * period / 2
    vx, vy = to_robot_frame(me.vx, me.vy, middle)
    assert hypot(command.vx - vx, command.vy - vy) <= MAX_ACCELERATION * period + 1e-9


def test_it_brakes_and_turns_only_as_hard_as_a_weak_dribbler_holds() -> None:
    period, limits = 1 / 60, RobotLimits(hold_acceleration=0.35)
    for target in ((2.0, 0.0), (0.3, 2.0)):
        dribble, me = Alone(DribbleTo(target=target)), robot(contact=True, limits=limits)
        gains = []
        for _ in range(600):
            dribble.tick(frame(me, ball=held(me), period=period))
            driven = moved(me, dribble.command, period)
            gains.append((driven.speed - me.speed) / period)
            assert driven.omega**2 * TOUCH_DISTANCE <= 0.35 + 1e-9
            me = driven
        assert min(gains) > -0.4
        # Speeding up pushes the ball, and needs no dribbler.
        assert max(gains) > 1.4
        assert hypot(me.x - target[0], me.y - target[1]) < 0.1


def test_a_ball_gone_for_a_moment_is_not_yet_lost() -> None:
    alone, me = Alone(DribbleTo(target=(2.0, 0.0))), robot()
    assert alone.tick(frame(me, ball=held(me), time=0.0)) is Status.RUNNING
    assert alone.tick(frame(me, ball=(0.2, 0.0), time=0.1)) is Status.RUNNING
    assert alone.tick(frame(me, ball=(0.2, 0.0), time=0.2)) is Status.FAILURE


def test_a_ball_that_slipped_from_the_mouth_is_taken_again() -> None:
    slipped = (MOUTH + 0.012, 0.004)
    dribble = Alone(DribbleTo(target=(-2.0, 0.0)))
    for step in range(20):
        assert dribble.tick(frame(robot(), ball=slipped, time=step / 60)) is Status.RUNNING
    assert dribble.command.vx > 0.0
    assert dribble.command.dribbler
    # It then turns with the ball, which otherwise stays behind.
    alone(DribbleTo(target=(-2.0, 0.0)), (0.0, 0.0, 0.0), slipped).run(
        6.0, eventually("the ball is there", ball_near((-2.0, 0.0), 0.3))
    )


def test_it_carries_no_farther_than_allowed() -> None:
    alone = Alone(DribbleTo(target=(3.0, 0.0), max_distance=1.0))
    for x, expected in ((0.0, Status.RUNNING), (0.85, Status.RUNNING), (0.95, Status.FAILURE)):
        me = robot(x)
        assert alone.tick(frame(me, ball=held(me), time=x)) is expected
    assert alone.tree.feedback_message == "the ball has been carried as far as allowed"


def test_it_gives_up_before_the_referee_would_call_it_too_far() -> None:
    dribble = DribbleTo(target=(3.0, 0.0), max_distance=1.0)
    alone(dribble, (0.0, 0.0, 0.0), (MOUTH, 0.0)).run(
        5.0,
        eventually("it gives up", fails(dribble)),
        eventually("it has come some way", lambda frame: frame.ball.x > 0.9),
        never("it dribbles too far", dribbles_too_far(blue(0))),
    )


@pytest.mark.parametrize("target", [(2.0, 0.0), (-2.0, 0.5), (0.0, -2.0)])
def test_it_brings_the_ball_anywhere(target: tuple[float, float]) -> None:
    trial = alone(DribbleTo(target=target), (0.0, 0.0, 0.0), (MOUTH, 0.0))
    trial.run(
        5.0,
        eventually("the ball is there", ball_near(target, 0.3)),
        always("the robot has the ball", carrying),
    )


def test_it_carries_the_ball_round_an_opponent() -> None:
    trial = Trial(
        {blue(0): DribbleTo(target=(2.0, 0.0))},
        {blue(0): (0.0, 0.0, 0.0), yellow(0): (1.0, 0.05, pi)},
        (MOUTH, 0.0),
    )
    trial.run(
        5.0,
        eventually("the ball is there", ball_near((2.0, 0.0), 0.3)),
        always("the robot has the ball", carrying),
        never("it touches the opponent", touches_a_robot(blue(0))),
    )


def test_turning_hard_with_the_ball_is_what_loses_it() -> None:
    """The same way with limits beyond the dribbler's: the bar above is not a free pass."""
    wild = DribbleTo(target=(-2.0, 0.5), max_speed=3.0, max_turn=9.0, max_acceleration=6.0)
    told = SimSettings(limits=RobotLimits(hold_acceleration=50.0))
    trial = alone(wild, (0.0, 0.0, 0.0), (MOUTH, 0.0), told)
    trial.run(3.0, eventually("the ball is lost", fails(wild)))


def test_settling_stops_the_robot_gently() -> None:
    me = robot(velocity=(1.0, 0.0, 2.0))
    command = settle(me, 0.02)
    assert hypot(command.vx, command.vy) == pytest.approx(1.0 - MAX_ACCELERATION * 0.02)
    assert command.omega == pytest.approx(2.0 - TURN_ACCELERATION * 0.02)
    assert dribbling_limits() is dribbling_limits()
