from __future__ import annotations

import pytest

from robobt.plays import go_to_ball_and_shoot
from robobt.testing import alone, blue, eventually, goal_for, has_ball
from robobt.world import Team


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
