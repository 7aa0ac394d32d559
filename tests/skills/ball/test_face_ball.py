from __future__ import annotations

from math import atan2, hypot

import pytest

from robobt.skills import FaceBall
from robobt.testing import alone, always, eventually, frame, robot, succeeds
from robobt.tree import Status
from tests.skills.fixed_world import Alone


def test_it_turns_the_short_way() -> None:
    left, right = Alone(FaceBall()), Alone(FaceBall())
    assert left.tick(frame(robot(), ball=(0.0, 1.0))) is Status.RUNNING
    assert right.tick(frame(robot(), ball=(0.0, -1.0))) is Status.RUNNING
    assert left.command.omega > 0.0 > right.command.omega


def test_facing_the_ball_it_succeeds() -> None:
    assert Alone(FaceBall()).tick(frame(robot(), ball=(1.0, 0.02))) is Status.SUCCESS


@pytest.mark.parametrize("ball", [(-1.0, 0.1), (0.0, 1.0), (1.0, -1.0)])
def test_it_turns_on_the_spot(ball: tuple[float, float]) -> None:
    face = FaceBall()
    trial = alone(face, (0.0, 0.0, 0.0), ball)
    end = trial.run(
        2.0,
        eventually("it faces the ball", succeeds(face)),
        always("it stays", lambda frame: hypot(frame.own[0].x, frame.own[0].y) < 0.001),
    )
    assert end.own[0].heading == pytest.approx(atan2(ball[1], ball[0]), abs=0.06)
