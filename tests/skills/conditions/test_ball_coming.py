from __future__ import annotations

import pytest

from robobt.skills.conditions.ball_coming import BallComing
from robobt.testing import frame, robot
from robobt.tree import Status
from robobt.world import RobotState
from tests.skills.fixed_world import Alone


def comes(ball: tuple[float, ...], me: RobotState | None = None) -> bool:
    return Alone(BallComing()).tick(frame(me or robot(), ball)) is Status.SUCCESS


def test_a_ball_that_rolls_at_the_robot_comes() -> None:
    assert comes((2.0, 0.0, -2.0, 0.0))


def test_a_ball_that_has_passed_does_not() -> None:
    assert not comes((0.2, 0.0, 2.0, 0.0))


def test_a_ball_abreast_of_the_robot_has_passed() -> None:
    assert not comes((0.0, 0.3, 2.0, 0.0))


def test_a_slow_ball_is_to_be_fetched() -> None:
    assert not comes((2.0, 0.0, -0.3, 0.0))


@pytest.mark.parametrize(("aside", "expected"), [(0.2, True), (-0.2, True), (1.5, False), (-1.5, False)])
def test_a_ball_comes_only_if_the_robot_can_step_into_its_way(aside: float, expected: bool) -> None:
    assert comes((1.0, aside, -2.0, 0.0)) is expected


def test_a_slower_ball_leaves_more_time_to_step_in() -> None:
    assert not comes((1.0, 1.0, -2.0, 0.0))
    assert comes((1.0, 1.0, -0.6, 0.0))


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_robot_already_on_its_way_there_needs_less_time(side: float) -> None:
    ball = (1.0, 0.6 * side, -2.0, 0.0)
    assert comes(ball, robot(velocity=(0.0, 1.5 * side, 0.0)))
    assert not comes(ball, robot(velocity=(0.0, -1.5 * side, 0.0)))


def test_a_ball_in_the_mouth_comes_no_more() -> None:
    assert not comes((0.0965, 0.0, -1.0, 0.0), robot(contact=True))
