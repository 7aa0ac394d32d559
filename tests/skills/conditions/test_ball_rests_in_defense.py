from __future__ import annotations

from robobt.skills.conditions.ball_rests_in_defense import BallRestsInDefense
from robobt.testing import frame, held, robot
from robobt.tree import Status
from tests.skills.fixed_world import Alone

ME = robot(-4.3, 0.0)


def test_a_ball_at_rest_in_the_area_has_to_be_cleared() -> None:
    assert Alone(BallRestsInDefense()).tick(frame(ME, (-4.0, 0.5))) is Status.SUCCESS


def test_a_ball_outside_the_area_has_not() -> None:
    assert Alone(BallRestsInDefense()).tick(frame(ME, (-3.0, 0.5))) is Status.FAILURE


def test_a_moving_ball_has_not_unless_the_goalkeeper_moves_it() -> None:
    assert Alone(BallRestsInDefense()).tick(frame(ME, (-4.0, 0.5, 1.0, 0.0))) is Status.FAILURE
    assert Alone(BallRestsInDefense()).tick(frame(ME, (*held(ME), 0.4, 0.0))) is Status.SUCCESS
