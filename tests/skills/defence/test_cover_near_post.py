from __future__ import annotations

import pytest

from robobt.skills.defence.cover_near_post import CoverNearPost
from robobt.testing import frame, robot
from robobt.tree import Status
from robobt.world.geometry import segment_distance
from tests.skills.fixed_world import Alone, moved


def test_it_stands_between_the_ball_and_the_near_post() -> None:
    me, ball = robot(-4.3, 0.0), (-2.0, 1.5)
    alone = Alone(CoverNearPost())
    for _ in range(120):
        assert alone.tick(frame(me, ball)) is Status.RUNNING
        me = moved(me, alone.command, 1 / 60)
    assert segment_distance(me.position, ball, (-4.5, 0.5)) < 0.02


@pytest.mark.parametrize("ball", [(-4.45, 1.5), (-4.4, -2.0)])
def test_a_ball_beside_the_goal_is_not_covered(ball: tuple[float, float]) -> None:
    assert Alone(CoverNearPost()).tick(frame(robot(-4.3, 0.0), ball)) is Status.FAILURE


def test_it_does_not_leave_the_area() -> None:
    assert Alone(CoverNearPost()).tick(frame(robot(-2.0, 0.0), (0.0, 0.0))) is Status.FAILURE
