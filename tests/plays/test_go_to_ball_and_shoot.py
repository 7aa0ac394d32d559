from __future__ import annotations

from typing import Literal

import pytest

from robobt.plays import go_to_ball_and_shoot
from robobt.testing import Trial, alone, always, blue, eventually, goal_for, has_ball, inside_the_field
from robobt.world import Team

Style = Literal["default", "robobulls"]
START = (-3.9, 0.0, 0.0)


def benchmark(ball: tuple[float, float], style: Style) -> Trial:
    """A run of the paper's Table 4, under its conditions."""
    tree = go_to_ball_and_shoot(style=style)
    trial = alone(tree, START, ball, "robobulls", period=0.03)
    trial.run(
        10.0,
        eventually("the ball is in the goal", goal_for(Team.BLUE)),
        always("inside the field", inside_the_field),
    )
    return trial


def time_to_ball(trial: Trial) -> float:
    return next(frame.time for frame in trial.frames if frame.own[0].ball_contact)


@pytest.mark.parametrize(("ball", "paper"), [((0.0, 0.0), 3.4998), ((0.0, 1.5), 4.9846)])
def test_the_baseline_gets_to_the_ball_as_fast_as_in_the_paper(
    ball: tuple[float, float], paper: float
) -> None:
    assert time_to_ball(benchmark(ball, "robobulls")) == pytest.approx(paper, rel=0.1)


@pytest.mark.parametrize("away", [(0.35, 0.2), (-0.6, 0.9), (2.0, -1.5)])
@pytest.mark.parametrize("preset", ["default", "grsim"])
def test_a_ball_that_is_lost_with_the_shot_begun_is_fetched_again(
    preset: str, away: tuple[float, float]
) -> None:
    tree = go_to_ball_and_shoot(policy="geometric", shoot="geometric")
    trial = alone(tree, (-1.0, 0.0, 0.0), (0.0, 1.0), preset, period=0.03)
    trial.run(5.0, eventually("it has the ball", has_ball(blue(0))))
    me = trial.frames[-1].own[0]
    trial.world.place_ball(me.x + away[0], me.y + away[1])
    trial.run(8.0, eventually("the ball is in the goal", goal_for(Team.BLUE)))
    assert len(trial.kicks) == 1


@pytest.mark.parametrize("ball", [(0.0, 0.0), (0.0, 1.5), (2.0, -1.0), (-3.0, 2.0)])
def test_the_default_style_is_faster(ball: tuple[float, float]) -> None:
    baseline, ours = benchmark(ball, "robobulls"), benchmark(ball, "default")
    assert ours.kicks[0][0] < baseline.kicks[0][0]
