"""The bundled scenarios, played."""

import pytest

from robobt.config.resources import bundled_scenarios
from robobt.match import MatchLoop, load_scenario, run_trials_in, summarise
from robobt.worlds import sim_world

pytestmark = pytest.mark.integration


@pytest.mark.parametrize("name", bundled_scenarios())
def test_it_plays_without_a_tree_failing(name: str):
    scenario = load_scenario(name)
    result = MatchLoop(scenario.lasting(min(5.0, scenario.ends.time_limit)), scenario.seed, sim_world).play()
    assert {robot: figures.first_error for robot, figures in result.robots.items() if figures.errors} == {}


def test_the_striker_scores_against_the_goalkeeper():
    summary = summarise(run_trials_in(load_scenario("striker_vs_goalkeeper"), sim_world, 20).results)
    assert summary.goals["blue"].trials.count >= 10


def test_a_match_with_a_referee_is_the_same_match_again():
    scenario = load_scenario("six_v_six").lasting(5.0)
    assert MatchLoop(scenario, 3, sim_world).play().trace == MatchLoop(scenario, 3, sim_world).play().trace
