from __future__ import annotations

from robobt.skills import BallIsMoving
from robobt.testing import alone, eventually, fails, frame, robot
from robobt.tree import Status
from tests.skills.fixed_world import Alone


def test_it_compares_the_speed() -> None:
    assert Alone(BallIsMoving(speed=0.5)).tick(frame(robot(), ball=(0, 0, 0.4, 0.4))) is Status.SUCCESS
    assert Alone(BallIsMoving(speed=0.5)).tick(frame(robot(), ball=(0, 0, 0.3, 0.3))) is Status.FAILURE


def test_a_rolling_ball_moves_until_it_rests() -> None:
    condition = BallIsMoving()
    trial = alone(condition, (0.0, 2.0, 0.0), (0.0, 0.0, 0.5, 0.0))
    trial.tick()
    assert condition.status is Status.SUCCESS
    trial.run(3.0, eventually("it rests", fails(condition)))
