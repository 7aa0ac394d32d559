"""A scenario with one robot changed."""

from __future__ import annotations

import pytest

from robobt.match import ScenarioError, load_scenario
from robobt.match.scenario.scenario import scenario_from
from robobt.world.game import Team
from robobt.world.state import RobotId
from tests.match.scripted import data


def test_a_parameter_of_the_play_is_set_beside_those_it_has() -> None:
    scenario = load_scenario("deployed_half")
    before = dict(scenario.robots.blue[0].params)
    changed = scenario.with_robot("blue 0", play="attack_nn", steady=0.9)
    assert changed.robots.blue[0].params == {**before, "steady": 0.9}
    assert changed.robots.blue[0].play == "attack_nn"
    assert scenario.robots.blue[0].params == before
    assert changed.source == scenario.source


def test_another_play_keeps_only_the_parameters_that_it_has() -> None:
    scenario = load_scenario("deployed_half").with_robot("blue 0", steady=0.3, min_score=0.2)
    changed = scenario.with_robot("blue 0", play="attack_nn")
    assert changed.robots.blue[0].params == {"max_distance": 3.5, "shot_speed": 7.5, "steady": 0.3}
    assert scenario.with_robot("blue 0", play="goalkeeper").robots.blue[0].params == {}


def test_a_field_of_the_setup_is_set() -> None:
    scenario = load_scenario("striker_vs_goalkeeper")
    changed = scenario.with_robot(
        RobotId(Team.YELLOW, 0), limits={"max_speed": 1.0}, start={"position": (-4.0, 0.2)}
    )
    keeper = changed.robots.yellow[0]
    assert keeper.limits is not None
    assert keeper.limits.max_speed == 1.0
    assert keeper.start.position == (-4.0, 0.2)
    assert keeper.goalkeeper
    assert changed.robots.blue == scenario.robots.blue


def test_params_replace_all_parameters() -> None:
    scenario = load_scenario("deployed_half").with_robot("blue 0", params={})
    assert scenario.robots.blue[0].params == {}


@pytest.mark.integration
def test_robots_keep_their_order() -> None:
    scenario = load_scenario("six_v_six")
    changed = scenario.with_robot("blue 3", limits={"max_speed": 1.0})
    assert [robot for robot, _ in changed.robots] == [robot for robot, _ in scenario.robots]


@pytest.mark.parametrize(
    ("robot", "changes", "problem"),
    [
        ("blue 7", {}, r"robots: there is no robot 'blue 7'; there are blue 0, yellow 0"),
        ("blue 0", {"ratter": "gaussian"}, r"robots\.blue\.0\.params\.ratter: blue 0: .*no such parameter"),
        ("blue 0", {"rater": 3}, r"robots\.blue\.0\.params\.rater.*: blue 0: "),
        ("blue 0", {"play": "nothing"}, r"robots\.blue\.0\.play: blue 0: no play is called 'nothing'"),
        ("yellow 0", {"limits": {"max_speed": -1.0}}, r"robots\.yellow\.0\.limits\.max_speed: yellow 0: "),
        (
            "blue 0",
            {"start": {"position": (9.0, 0.0)}},
            r"robots\.blue\.0\.start\.position: .*outside the field",
        ),
    ],
)
def test_what_does_not_fit_is_named(robot: str, changes: dict[str, object], problem: str) -> None:
    with pytest.raises(ScenarioError, match=problem):
        load_scenario("striker_vs_goalkeeper").with_robot(robot, **changes)


def test_two_robots_cannot_have_one_number() -> None:
    robots = [
        {"number": number, "play": "goalkeeper", "start": {"position": [-4.0, float(number)]}}
        for number in (0, 1)
    ]
    scenario = scenario_from(data(robots={"blue": robots, "yellow": []}), "mine.yaml")
    with pytest.raises(ScenarioError, match=r"^mine\.yaml: robots\.blue\.1\.number: blue has two robots 1"):
        scenario.with_robot("blue 0", number=1)
