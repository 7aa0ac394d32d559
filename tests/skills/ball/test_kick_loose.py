"""A ball that two robots hold against each other is kicked loose."""

from __future__ import annotations

from math import pi

import pytest

from robobt.skills import KickLoose
from robobt.testing import frame, held, robot
from robobt.tree import Status
from robobt.world import RobotLimits, RobotState
from tests.skills.fixed_world import Alone

ME = robot(contact=True)
BALL = held(ME)
FACING = robot(2.0 * BALL[0], 0.0, pi, number=4)


def when_held(alone: Alone, me: RobotState, other: RobotState, most: float = 3.0) -> float | None:
    """The time at which it kicks; None within ``most`` seconds."""
    time = 0.0
    while time < most:
        if alone.tick(frame(me, held(me), opponents=(other,), time=time)) is Status.RUNNING:
            assert alone.command.kick_speed > 0.0
            assert not alone.command.dribbler
            return time
        time += 1 / 60
    return None


def test_it_kicks_once_the_hold_has_lasted() -> None:
    assert when_held(Alone(KickLoose(patience=0.6)), ME, FACING) == pytest.approx(0.6, abs=0.02)


@pytest.mark.parametrize("y", [0.02, -0.02])
def test_two_weak_dribblers_lose_a_ball_that_one_turns_out_away_from_the_other(y: float) -> None:
    alone, me = Alone(KickLoose()), robot(contact=True, limits=RobotLimits(hold_acceleration=0.35))
    other = robot(FACING.x, y, pi, number=4)
    for step in range(20):
        alone.tick(frame(me, BALL, opponents=(other,), time=step / 60))
    assert alone.command.kick_speed == 0.0
    assert alone.command.dribbler
    assert alone.command.omega * y < 0.0


def test_it_holds_on_for_longer_before_it_kicks_towards_its_own_goal() -> None:
    me = robot(heading=pi, contact=True)
    other = robot(2.0 * held(me)[0], 0.0, 0.0, number=4)
    assert when_held(Alone(KickLoose(patience=0.6)), me, other) == pytest.approx(1.2, abs=0.02)


@pytest.mark.parametrize(
    "other",
    [robot(0.3, 0.0, pi), robot(BALL[0], 0.115, 0.0)],
    ids=["away from the ball", "looks past it"],
)
def test_a_ball_that_no_opponent_holds_too_is_kept(other: RobotState) -> None:
    assert when_held(Alone(KickLoose()), ME, other) is None


def test_a_hold_that_was_broken_begins_anew() -> None:
    alone = Alone(KickLoose(patience=0.6))
    assert when_held(alone, ME, FACING, most=0.5) is None
    alone.tick(frame(ME, BALL, time=0.7))
    assert alone.tick(frame(ME, BALL, opponents=(FACING,), time=0.9)) is Status.FAILURE


@pytest.mark.parametrize("patience", [0.0, -1.0])
def test_its_patience_is_positive(patience: float) -> None:
    with pytest.raises(ValueError, match="patience must be positive"):
        KickLoose(patience=patience)
