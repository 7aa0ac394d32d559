from __future__ import annotations

from robobt.skills import BallInOwnDefenseArea
from robobt.testing import alone, eventually, frame, robot, succeeds
from robobt.tree import Status
from tests.skills.fixed_world import Alone


def tick(x: float, y: float, margin: float = 0.0) -> Status:
    return Alone(BallInOwnDefenseArea(margin=margin)).tick(frame(robot(), ball=(x, y)))


def test_it_holds_in_the_own_area_and_nowhere_else() -> None:
    assert tick(-3.6, 0.9) is Status.SUCCESS
    assert tick(-3.4, 0.0) is Status.FAILURE
    assert tick(-4.0, 1.1) is Status.FAILURE
    assert tick(4.0, 0.0) is Status.FAILURE


def test_the_area_can_be_grown() -> None:
    assert tick(-3.4, 1.05, margin=0.15) is Status.SUCCESS


def test_a_ball_that_rolls_in_is_noticed() -> None:
    condition = BallInOwnDefenseArea()
    trial = alone(condition, (0.0, 2.0, 0.0), (-3.0, 0.0, -1.0, 0.0))
    end = trial.run(2.0, eventually("it is in", succeeds(condition)))
    assert -3.6 < end.ball.x <= -3.5
