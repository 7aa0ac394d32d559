from __future__ import annotations

from math import pi

import pytest

from robobt.skills.defence.shot_coming import ShotComing
from robobt.testing import frame, held, robot
from robobt.tree import Status
from tests.skills.fixed_world import Alone

ME = robot(-4.3, 0.0)


def test_a_ball_on_its_way_into_the_goal_is_a_shot() -> None:
    alone = Alone(ShotComing())
    assert alone.tick(frame(ME, (-2.5, 0.0, -4.0, 0.4))) is Status.SUCCESS
    assert alone.store.target == pytest.approx((-4.41, 0.2))


@pytest.mark.parametrize(
    "ball",
    [
        (-2.5, 0.0, 4.0, 0.0),
        (-2.5, 0.0, 0.0, 0.0),
        (-2.5, 0.0, -4.0, 2.0),
        (-4.6, 0.0, -1.0, 0.0),
    ],
    ids=["rolls away", "rests", "goes wide", "is in already"],
)
def test_any_other_ball_is_none(ball: tuple[float, ...]) -> None:
    assert Alone(ShotComing()).tick(frame(ME, ball)) is Status.FAILURE


def test_a_ball_that_goes_just_wide_counts_within_the_margin() -> None:
    ball = (-3.5, 0.0, -4.0, 2.2)
    assert Alone(ShotComing()).tick(frame(ME, ball)) is Status.FAILURE
    assert Alone(ShotComing(margin=0.1)).tick(frame(ME, ball)) is Status.SUCCESS


def test_a_ball_the_goalkeeper_pulls_back_is_no_shot() -> None:
    me = robot(-4.0, 0.0, velocity=(-0.4, 0.0, 0.0), contact=True)
    assert Alone(ShotComing()).tick(frame(me, (*held(me), -0.4, 0.0))) is Status.FAILURE


def test_a_ball_an_opponent_dribbles_is_no_shot_until_it_is_kicked() -> None:
    opponent = robot(-2.0, 0.0, heading=pi, velocity=(-2.0, 0.0, 0.0), contact=True)
    x, y = held(opponent)
    dribbled = frame(ME, (x, y, -2.0, 0.0), opponents=(opponent,))
    kicked = frame(ME, (x, y, -6.0, 0.0), opponents=(opponent,))
    assert Alone(ShotComing()).tick(dribbled) is Status.FAILURE
    assert Alone(ShotComing()).tick(kicked) is Status.SUCCESS


def test_a_shot_that_touches_the_goalkeeper_is_one_until_it_has_been_stopped() -> None:
    me = robot(-4.3, 0.0)
    assert Alone(ShotComing()).tick(frame(me, (*held(me), -4.0, 0.0))) is Status.SUCCESS
