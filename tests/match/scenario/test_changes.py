"""Scenarios changed by the names of their file."""

from __future__ import annotations

import pytest

from robobt.match import ScenarioError, load_scenario
from robobt.match.scenario.changes import changed, with_team
from robobt.world.game import Team


def test_fields_are_changed_at_any_depth_and_the_rest_stays() -> None:
    scenario = load_scenario("table4_trial1_own")
    other = changed(scenario, {"ends.time_limit": 3, "simulator.realism.ball_noise": 0.002, "seed": 7})
    assert (other.ends.time_limit, other.ends.ball_at_rest) == (3.0, scenario.ends.ball_at_rest)
    assert other.simulator["preset"] == "grsim"
    assert other.simulator["realism"] == {**scenario.simulator["realism"], "ball_noise": 0.002}  # type: ignore[dict-item]
    assert (other.seed, other.source) == (7, scenario.source)
    assert scenario.ends.time_limit == 20.0


def test_a_robot_is_changed_with_its_play_and_its_limits() -> None:
    scenario = load_scenario("deployed_full")
    changes = {"blue 0.play": "attack_nn", "blue  0.rater.threshold": 0.7, "yellow 0.limits.max_speed": 1}
    other = changed(scenario, changes)
    striker, keeper = other.robots.blue[0], other.robots.yellow[0]
    assert striker.play == "attack_nn"
    assert striker.params["max_distance"] == 3.5
    assert striker.params["rater"] == {"name": "nn_filtered", "model": "shot_nn_strong", "threshold": 0.7}
    assert keeper.limits is not None
    assert keeper.limits.max_speed == 1.0


def test_a_team_plays_something_else_but_for_its_goalkeeper() -> None:
    scenario = load_scenario("six_v_six")
    other = with_team(scenario, Team.YELLOW, "field_player", {})
    plays = [robot.play for robot in other.robots.yellow]
    assert plays == ["team_goalkeeper", *["field_player"] * 5]
    assert other.robots.blue == scenario.robots.blue
    alone = with_team(load_scenario("striker_vs_goalkeeper"), Team.YELLOW, None, {"speed_factor": 0.5})
    assert alone.robots.yellow[0].params["speed_factor"] == 0.5


def test_a_field_of_a_group_is_told_with_its_group() -> None:
    with pytest.raises(
        ScenarioError, match=r"time_limit: there is no such field; did you mean ends.time_limit\?$"
    ):
        changed(load_scenario("striker_vs_goalkeeper"), {"time_limit": 5})
