from pathlib import Path
from typing import Any

import numpy as np
import pytest

import robobt
from robobt.config.yaml import write_yaml
from robobt.match import ScenarioError, load_scenario
from robobt.match.scenario.scenario import scenario_from
from robobt.sim import preset
from robobt.world import World
from robobt.worlds import sim_world
from tests.match.scripted import data


def world_of(**changes: Any) -> Any:
    return sim_world(scenario_from(data(**changes), "test.yaml"))


def limits_of(world: Any) -> Any:
    scenario = scenario_from(data(), "test.yaml")
    world.reset(scenario.place(np.random.default_rng(0)), 0)
    return world.truth().own[0].limits


def test_it_has_the_field_and_period_of_the_scenario():
    world = world_of(field="division_a", period=0.03)
    assert isinstance(world, World)
    assert world.field.length == 12.0
    assert world.period == 0.03


def test_settings_are_those_of_the_preset_with_changes():
    settings = world_of(simulator={"preset": "grsim", "kicker": {"max_speed": 3.0}}).settings
    assert settings.kicker.max_speed == 3.0
    assert settings.ball == preset("grsim").ball


def test_limits_not_given_are_those_of_the_simulator():
    robots = data()["robots"]
    robots["blue"][0]["limits"] = {"max_speed": 1.0}
    limits = limits_of(world_of(simulator="grsim", robots=robots))
    assert limits == preset("grsim").limits.model_copy(update={"max_speed": 1.0})
    assert limits_of(world_of(simulator="grsim")) == preset("grsim").limits


@pytest.mark.parametrize(
    "simulator", [{"ball": None}, {"preset": []}, {"sub_step": "x"}, {"limits": {"a": 1}}]
)
def test_wrong_settings_name_file_and_field(simulator: dict[str, Any]):
    with pytest.raises(ScenarioError, match=r"^test\.yaml: simulator"):
        world_of(simulator=simulator)


@pytest.mark.integration
def test_a_scenario_is_played_by_its_name_too(tmp_path: Path):
    given = load_scenario("score_on_defender").lasting(0.5)
    file = tmp_path / "mine.yaml"
    file.write_text(write_yaml(data(ends={"time_limit": 0.1})))
    assert robobt.run_trials(file, 1).summary().trials == 1
    assert robobt.Match("score_on_defender", 3).scenario.name == given.name
    with pytest.raises(ScenarioError, match="no such file or bundled scenario"):
        robobt.play_match("score_on_nobody")
