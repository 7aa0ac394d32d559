from __future__ import annotations

from math import pi
from pathlib import Path

import pytest

from robobt.plays import team_goalkeeper
from robobt.skills import Goalkeeper
from robobt.testing import Trial, blue, eventually, frame, goal_for, has_ball, never, robot, yellow
from robobt.world import Team
from tests.models.made_models import network, team_card, write_model
from tests.skills.fixed_world import Alone

HOME, BALL = (-4.35, 0.0, 0.0), (-3.9, 0.4)


def test_it_clears_a_ball_in_its_area_to_a_mate_that_gets_it() -> None:
    trial = Trial({blue(0): team_goalkeeper()}, {blue(0): HOME, blue(1): (-1.0, 2.0, pi)}, BALL)
    trial.run(
        8.0,
        eventually("the mate gets the ball", has_ball(blue(1))),
        never("the ball is in our goal", goal_for(Team.YELLOW)),
    )


@pytest.mark.parametrize("chips", [True, False])
def test_without_a_mate_it_gets_the_ball_away_over_those_who_wait(chips: bool) -> None:
    fence = {yellow(number): (-2.6, 0.25 * number - 0.5, pi) for number in range(5)}
    trial = Trial({blue(0): team_goalkeeper(chips=chips)}, {blue(0): HOME, **fence}, BALL)
    trial.run(8.0, never("the ball is in our goal", goal_for(Team.YELLOW)))
    highest = max(frame.ball.z for frame in trial.frames)
    assert (highest > 0.15) is chips
    assert trial.frames[-1].ball.x > -3.3


def test_a_policy_keeps_goal_while_the_ball_is_near_and_somebody_elses(tmp_path: Path) -> None:
    model = write_model(tmp_path, network(23, 4), team_card("Goalkeeper", 0, 1))
    alone = Alone(team_goalkeeper(policy=str(model)))

    def playing(*ball: float) -> str:
        alone.tick(frame(robot(-4.3, 0.0), ball, opponents=(robot(0.5, 0.0, pi, number=1),)))
        tip = alone.tree.tip()
        assert tip is not None
        return tip.name

    assert playing(-2.0, 0.5) == playing(-2.0, 0.5, -3.0, 0.0) == "Goalkeeper"
    assert playing(1.0, 0.5) == "CoverAngle"
    assert playing(-4.0, 0.5) not in ("Goalkeeper", "CoverAngle")
    assert not any(isinstance(node, Goalkeeper) for node in team_goalkeeper().iterate())
