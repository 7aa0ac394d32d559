from __future__ import annotations

from robobt.skills import BallIsMoving
from robobt.tree import Status
from tests.simulation import Trial, blue, eventually
from tests.skills.fixed_world import Alone, frame, robot


def test_it_compares_the_speed() -> None:
    assert Alone(BallIsMoving(speed=0.5)).tick(frame(robot(), ball=(0, 0, 0.4, 0.4))) is Status.SUCCESS
    assert Alone(BallIsMoving(speed=0.5)).tick(frame(robot(), ball=(0, 0, 0.3, 0.3))) is Status.FAILURE


def test_a_rolling_ball_moves_until_it_rests() -> None:
    condition = BallIsMoving()
    trial = Trial({blue(0): condition}, {blue(0): (0.0, 2.0, 0.0)}, (0.0, 0.0, 0.5, 0.0))
    trial.tick()
    assert condition.status is Status.SUCCESS
    trial.run(3.0, eventually("it rests", lambda _: condition.status is Status.FAILURE))
