from __future__ import annotations

from math import pi

import pytest

from robobt.plays import team_keeper
from tests.simulation import Trial, blue, eventually, goal_for_them, never, yellow

HOME, BALL = (-4.35, 0.0, 0.0), (-3.9, 0.4)


def test_it_clears_a_ball_in_its_area_to_a_mate_that_gets_it() -> None:
    trial = Trial({blue(0): team_keeper()}, {blue(0): HOME, blue(1): (-1.0, 2.0, pi)}, BALL)
    trial.run(
        8.0,
        eventually("the mate gets the ball", lambda frame: frame.own[1].ball_contact),
        never("the ball is in our goal", goal_for_them()),
    )


@pytest.mark.parametrize("chips", [True, False])
def test_without_a_mate_it_gets_the_ball_away_over_those_who_wait(chips: bool) -> None:
    fence = {yellow(number): (-2.6, 0.25 * number - 0.5, pi) for number in range(5)}
    trial = Trial({blue(0): team_keeper(chips=chips)}, {blue(0): HOME, **fence}, BALL)
    trial.run(8.0, never("the ball is in our goal", goal_for_them()))
    highest = max(frame.ball.z for frame in trial.frames)
    assert (highest > 0.15) is chips
    assert trial.frames[-1].ball.x > -3.3
