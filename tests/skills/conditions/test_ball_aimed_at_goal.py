from __future__ import annotations

from math import pi

import pytest

from robobt.skills.conditions.ball_aimed_at_goal import BallAimedAtGoal
from robobt.testing import frame, held, robot
from robobt.tree import Status
from tests.skills.fixed_world import Alone

ME = robot(-4.3, 0.0)


def test_an_opponent_that_holds_the_ball_and_faces_the_goal_aims_at_it() -> None:
    shooter = robot(-2.0, 0.2, heading=pi)
    alone = Alone(BallAimedAtGoal())
    assert alone.tick(frame(ME, held(shooter), opponents=(shooter,))) is Status.SUCCESS
    assert alone.store.target == pytest.approx((-4.41, 0.2))


def test_a_team_mate_that_faces_the_goal_counts_too() -> None:
    mate = robot(-2.0, 0.2, heading=pi, number=1)
    assert Alone(BallAimedAtGoal()).tick(frame(ME, held(mate), mates=(mate,))) is Status.SUCCESS


@pytest.mark.parametrize("heading", [0.0, pi / 2, 0.8 * pi])
def test_a_robot_that_faces_elsewhere_does_not_aim(heading: float) -> None:
    shooter = robot(-2.0, 0.2, heading=heading)
    alone = Alone(BallAimedAtGoal())
    assert alone.tick(frame(ME, held(shooter), opponents=(shooter,))) is Status.FAILURE


def test_a_robot_without_the_ball_does_not_aim() -> None:
    shooter = robot(-2.0, 0.2, heading=pi)
    assert Alone(BallAimedAtGoal()).tick(frame(ME, (0.0, 0.0), opponents=(shooter,))) is Status.FAILURE


def test_the_goalkeeper_itself_does_not_count() -> None:
    me = robot(-4.0, 0.0, heading=pi)
    assert Alone(BallAimedAtGoal()).tick(frame(me, held(me))) is Status.FAILURE
