from __future__ import annotations

import pytest

from robobt.skills.select_clearance import SelectClearance
from robobt.tree import Status
from tests.skills.fixed_world import Alone, frame, robot

ME = robot(-4.3, 0.0)
BALL = (-4.0, 0.3)


def test_without_team_mates_the_ball_goes_upfield() -> None:
    alone = Alone(SelectClearance())
    assert alone.tick(frame(ME, BALL)) is Status.SUCCESS
    assert alone.store.target == pytest.approx((1.0, 0.0))


def test_the_foremost_free_team_mate_gets_it() -> None:
    near, far = robot(-1.0, 1.0, number=1), robot(1.0, -2.0, number=2)
    alone = Alone(SelectClearance())
    alone.tick(frame(ME, BALL, mates=(near, far)))
    assert alone.store.target == far.position


def test_a_team_mate_behind_an_opponent_does_not() -> None:
    near, far = robot(-1.0, 1.0, number=1), robot(1.0, -2.0, number=2)
    between = robot((1.0 - 4.0) / 2, (-2.0 + 0.3) / 2)
    alone = Alone(SelectClearance())
    alone.tick(frame(ME, BALL, mates=(near, far), opponents=(between,)))
    assert alone.store.target == near.position


def test_a_team_mate_near_the_own_goal_does_not() -> None:
    alone = Alone(SelectClearance())
    alone.tick(frame(ME, BALL, mates=(robot(-2.0, 1.0, number=1),)))
    assert alone.store.target == pytest.approx((1.0, 0.0))
