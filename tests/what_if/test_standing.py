"""How a moment stands: the chance of the shot of whoever has the ball."""

from __future__ import annotations

import pytest

from robobt.skills.aim.raters.expected_goal import ExpectedGoal
from robobt.what_if.standing import standing
from robobt.world import DIVISION_B, BallState, Frame, RobotState, Team

RATER = ExpectedGoal(goalkeeper="fitted")


def scene(
    ball: tuple[float, float], own: tuple[float, float], opponents: tuple[RobotState, ...] = ()
) -> Frame:
    me = RobotState(1, *own, 0.0)
    return Frame(0.0, DIVISION_B, BallState(*ball), (me,), opponents)


def test_a_robot_before_an_empty_goal_will_score() -> None:
    frame = scene((3.5, 0.0), (3.4, 0.0))
    assert standing(frame, RATER, Team.BLUE) > 0.9
    assert standing(frame, RATER, Team.YELLOW) == -standing(frame, RATER, Team.BLUE)
    assert standing(frame.mirrored(), RATER, Team.BLUE) == pytest.approx(standing(frame, RATER, Team.BLUE))


def test_a_goalkeeper_makes_it_harder_and_distance_too() -> None:
    keeper = (RobotState(0, 4.3, 0.0, 3.14),)
    near = standing(scene((3.0, 0.0), (2.9, 0.0), keeper), RATER, Team.BLUE)
    far = standing(scene((-1.0, 0.0), (-1.1, 0.0), keeper), RATER, Team.BLUE)
    assert far < near < standing(scene((3.0, 0.0), (2.9, 0.0)), RATER, Team.BLUE)


def test_opponents_with_the_ball_count_against_the_team() -> None:
    opponent = (RobotState(3, -3.3, 0.0, 3.14),)
    assert standing(scene((-3.4, 0.0), (2.0, 2.0), opponent), RATER, Team.BLUE) < -0.5


def test_a_ball_that_nobody_can_have_soon_is_nobodys() -> None:
    assert standing(scene((3.5, 0.0), (-4.0, 0.0)), RATER, Team.BLUE) == 0.0


def test_a_robot_that_meets_the_ball_first_has_it_there() -> None:
    frame = scene((2.6, 0.0), (3.6, 0.0))
    frame.ball = BallState(2.6, 0.0, 2.0, 0.0)
    assert standing(frame, RATER, Team.BLUE) > 0.9
