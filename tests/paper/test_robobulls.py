"""RoboBulls' plays."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from paper.robobulls import robobulls_attack_main, robobulls_go_to_ball_and_shoot, robobulls_goalkeeper
from paper.table4_starts import SCENARIOS
from robobt import load_scenario, run_trials
from robobt.cli import app
from robobt.plays import go_to_ball_and_shoot
from robobt.testing import Pose, Trial, alone, always, eventually, goal_for, inside_the_field, never
from robobt.tree import Behaviour
from robobt.world import Team

START = (-3.9, 0.0, 0.0)


def benchmark(tree: Behaviour, ball: tuple[float, float]) -> Trial:
    """A run of the paper's Table 4, under its conditions."""
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
def test_it_gets_to_the_ball_as_fast_as_in_the_paper(ball: tuple[float, float], paper: float) -> None:
    baseline = benchmark(robobulls_go_to_ball_and_shoot(), ball)
    assert time_to_ball(baseline) == pytest.approx(paper, rel=0.1)


@pytest.mark.parametrize("ball", [(0.0, 0.0), (0.0, 1.5), (2.0, -1.0), (-3.0, 2.0)])
def test_our_own_play_is_faster(ball: tuple[float, float]) -> None:
    baseline, ours = (
        benchmark(robobulls_go_to_ball_and_shoot(), ball),
        benchmark(go_to_ball_and_shoot(), ball),
    )
    assert ours.kicks[0][0] < baseline.kicks[0][0]


@pytest.mark.integration
@pytest.mark.parametrize(("trial", "printed"), [(1, 3.4998), (2, 4.9846)])
def test_the_baseline_row_of_table_4(trial: int, printed: float) -> None:
    """Goals of 25 and the time to the ball, printed in the paper: 25 goals, time within 10 %."""
    summary = run_trials(load_scenario(SCENARIOS / f"table4_trial{trial}.yaml")).summary()
    assert summary.trials == 25
    assert summary.outcomes["goal_blue"].count == 25
    assert summary.robots["blue 0"].go_to_ball.mean == pytest.approx(printed, rel=0.10)


@pytest.mark.integration
def test_a_command_plays_the_scenario_of_a_file_and_a_play_of_one() -> None:
    scenario = str(SCENARIOS / "table4_trial1.yaml")
    call = ["match", scenario, "--trials", "2", "--workers", "1"]
    for change in ([], ["--blue", "paper/robobulls.py:robobulls_attack_main"]):
        played = CliRunner().invoke(app, [*call, *change, "--json"])
        assert played.exit_code == 0, played.output
        assert json.loads(played.stdout)["outcomes"]["goal_blue"]["count"] == 2


def test_its_attack_scores_in_an_empty_goal() -> None:
    alone(robobulls_attack_main(), (-1.0, 1.0, 0.0), ball=(0.5, 0.0), settings="robobulls").run(
        10.0,
        eventually("the ball is in the goal", goal_for(Team.BLUE)),
        always("inside the field", inside_the_field),
    )


def keeping(ball: tuple[float, ...], speed: float = 1.0, start: Pose = (-4.35, 0.0, 0.0)) -> Trial:
    return alone(robobulls_goalkeeper(speed_factor=speed), start, ball, "robobulls")


@pytest.mark.parametrize("y", [-0.3, 0.0, 0.3])
def test_its_goalkeeper_saves_a_slow_shot(y: float) -> None:
    keeping((-1.0, 0.0, -2.5, y * 2.5 / 3.5)).run(
        4.0,
        never("the ball is in our goal", goal_for(Team.YELLOW)),
        always("inside the field", inside_the_field),
    )


def test_its_goalkeeper_clears_a_ball_that_rests_in_its_area() -> None:
    keeping((-3.9, 0.4)).run(
        8.0,
        eventually("the ball is far away", lambda frame: frame.ball.x > -2.5),
        never("the ball is in our goal", goal_for(Team.YELLOW)),
    )


def fastest(speed: float) -> float:
    """Top speed on the way from the corner of its area to the line of a shot [m/s]."""
    trial = keeping((0.0, -0.3, -1.5, 0.0), speed, start=(-4.3, 2.0, 0.0))
    trial.run(2.0)
    return max(frame.own[0].speed for frame in trial.frames)


def test_its_goalkeepers_speed_scales_its_top_speed() -> None:
    assert fastest(0.5) == pytest.approx(1.125, abs=0.02)
    assert 1.2 < fastest(1.0) <= 2.27
    with pytest.raises(ValueError, match="above 0"):
        robobulls_goalkeeper(speed_factor=0.0)


def test_at_half_speed_its_goalkeeper_covers_less_than_at_full_speed() -> None:
    ways = []
    for speed in (0.5, 1.0):
        trial = keeping((0.0, -0.3, -1.5, 0.0), speed, start=(-4.3, 2.0, 0.0))
        ways.append(2.0 - trial.run(1.5).own[0].y)
    assert ways[0] < ways[1] - 0.1
