from __future__ import annotations

from math import nan

import pytest

from robobt.skills import SettleBall
from robobt.testing import frame, held, robot
from robobt.tree import Status
from robobt.world import RobotLimits
from tests.skills.fixed_world import Alone


def fast() -> tuple[float, ...]:
    return (*held(robot()), 2.0, 0.0)


ME = robot(velocity=(2.0, 0.0, 0.0), contact=True)


def test_it_brakes_with_the_dribbler_on_while_the_ball_is_fast() -> None:
    alone = Alone(SettleBall())
    assert alone.tick(frame(ME, fast())) is Status.RUNNING
    assert alone.command.vx < 2.0
    assert alone.command.dribbler


def test_a_ball_that_a_weak_dribbler_cannot_stop_within_the_rules_is_let_go() -> None:
    for hold, gentle in ((0.35, False), (3.0, True)):
        alone, me = Alone(SettleBall()), robot(velocity=(1.5, 0.0, 0.0), contact=True)
        me.limits = RobotLimits(hold_acceleration=hold)
        assert alone.tick(frame(me, (*held(me), 1.5, 0.0), period=0.01)) is Status.RUNNING
        assert (alone.command.vx > 1.5 - 0.01 * hold) is gentle


def test_it_is_done_once_the_ball_is_slow_and_stays_done() -> None:
    alone = Alone(SettleBall())
    alone.tick(frame(ME, fast()))
    assert alone.tick(frame(ME, (*held(ME), 0.3, 0.0), time=0.1)) is Status.FAILURE
    # What it does with the ball now may be fast.
    assert alone.tick(frame(ME, fast(), time=0.2)) is Status.FAILURE


def test_a_ball_that_was_lost_is_settled_anew() -> None:
    alone = Alone(SettleBall())
    alone.tick(frame(ME, (*held(ME), 0.3, 0.0)))
    assert alone.tick(frame(robot(), (1.0, 0.0), time=0.1)) is Status.FAILURE
    assert alone.tick(frame(ME, fast(), time=0.6)) is Status.RUNNING


@pytest.mark.parametrize(
    ("setting", "value"), [("slow", -0.1), ("pause", nan), ("share", 0.0), ("share", 1.1)]
)
def test_a_setting_that_makes_no_sense_is_refused(setting: str, value: float) -> None:
    with pytest.raises(ValueError, match=setting):
        SettleBall(**{setting: value})  # type: ignore[arg-type]
