from __future__ import annotations

import pytest

from robobt.skills.conditions.ball_at_defense_edge import BallAtDefenseEdge
from robobt.testing import frame, robot
from robobt.tree import Status
from tests.skills.fixed_world import Alone

ME = robot(-4.3, 0.0)


@pytest.mark.parametrize("ball", [(-3.4, 0.0), (-3.52, 0.0), (-4.0, 1.1), (-4.0, -0.97)])
def test_a_ball_that_rests_on_the_edge_is_fetched(ball: tuple[float, float]) -> None:
    assert Alone(BallAtDefenseEdge()).tick(frame(ME, ball)) is Status.SUCCESS


@pytest.mark.parametrize("ball", [(-3.2, 0.0), (-4.0, 0.0), (-3.4, 0.0, 0.5, 0.0)])
def test_a_ball_farther_out_farther_in_or_moving_is_not(ball: tuple[float, ...]) -> None:
    assert Alone(BallAtDefenseEdge()).tick(frame(ME, ball)) is Status.FAILURE


def test_a_ball_nearer_to_an_opponent_is_not() -> None:
    opponent = robot(-3.0, 0.0)
    assert Alone(BallAtDefenseEdge()).tick(frame(ME, (-3.4, 0.0), opponents=(opponent,))) is Status.FAILURE


def test_once_begun_it_lasts_until_the_ball_is_well_inside() -> None:
    alone = Alone(BallAtDefenseEdge())
    alone.tick(frame(ME, (-3.4, 0.0)))
    assert alone.tick(frame(ME, (-3.55, 0.0, -0.4, 0.0))) is Status.SUCCESS
    assert alone.tick(frame(ME, (-3.6, 0.0, -0.4, 0.0))) is Status.FAILURE
    assert alone.tick(frame(ME, (-3.55, 0.0, 0.0, 0.0))) is Status.FAILURE


def test_it_ends_when_the_ball_rolls_away() -> None:
    alone = Alone(BallAtDefenseEdge())
    alone.tick(frame(ME, (-3.4, 0.0)))
    assert alone.tick(frame(ME, (-3.2, 0.0))) is Status.FAILURE
