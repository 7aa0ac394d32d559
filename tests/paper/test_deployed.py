import json
from math import hypot
from pathlib import Path

import pytest
from typer.testing import CliRunner

from paper.__main__ import application
from paper.deployed import (
    ATTACKERS,
    SITUATIONS,
    STARTS,
    Situation,
    deployed,
    deployed_scenario,
)
from robobt.match.loop import MatchLoop
from robobt.match.scenario.scenario import Scenario, load_scenario
from robobt.world.protocol import World
from robobt.worlds import sim_world

PNG = b"\x89PNG"


NEAR = [Situation(speed=speed, starts=STARTS[1]) for speed in ("half", "full")]


@pytest.mark.integration
def test_every_attacker_is_judged_on_the_same_starts_beside_the_papers_figures():
    ticks = []
    played = ("attack_main", "attack_nn")
    result = deployed(3, seed=11, situations=NEAR, attackers=played, progress=lambda: ticks.append(1))
    half, full = (cell["attackers"] for cell in result["cells"])
    assert tuple(half) == tuple(full) == played
    assert len(ticks) == 12
    assert half["attack_main"]["paper"] == {"goals": 28, "shots": 100}
    assert half["attack_main"]["waiting"] == 0.0
    assert half["attack_main"]["against_first"] is None
    assert half["attack_nn"]["against_half_speed"] is None
    for one in (*half.values(), *full.values()):
        assert one["low"] <= one["rate"] == one["goals"] / 3 <= one["high"]
        assert sum(one["outcomes"].values()) == one["distinct"] == 3
    pairs = full["attack_nn"]["against_half_speed"]
    assert pairs["only_this"] - pairs["only_other"] == full["attack_nn"]["goals"] - half["attack_nn"]["goals"]


@pytest.mark.integration
def test_what_was_played_before_a_kill_is_not_played_again(tmp_path: Path):
    situations, attackers = NEAR[:1], ("attack_main", "attack_nn")
    whole = deployed(2, seed=11, situations=situations, attackers=attackers, out=tmp_path)
    kept = sorted(tmp_path.iterdir())
    assert len(kept) == 2
    # As if it had been killed in the first trial of the last attacker.
    kept[1].write_text("".join(kept[1].read_text().splitlines(keepends=True)[:1]))
    made = []

    def counted(scenario: Scenario) -> World:
        made.append(scenario)
        return sim_world(scenario)

    again = deployed(2, seed=11, situations=situations, attackers=attackers, out=tmp_path, world=counted)
    assert again == whole
    assert len(made) == 2


@pytest.mark.parametrize(("speed", "factor"), [("half", 0.5), ("full", 1.0)])
def test_the_goalkeeper_is_that_of_the_collection_scenario(speed: str, factor: float):
    scenario = deployed_scenario(Situation(speed=speed), "attack_nn")
    keeper = scenario.robots.yellow[0]
    collected = load_scenario(f"attack_vs_goalkeeper_motion_{speed}").robots.yellow[0]
    assert keeper.limits == collected.limits
    assert keeper.limits is not None
    assert keeper.limits.max_speed == 2.25
    assert keeper.params["speed_factor"] == collected.params["speed_factor"] == factor
    assert sim_world(scenario).settings.kicker.max_speed == 7.5


def test_attackers_differ_in_what_their_names_say():
    params = {name: deployed_scenario(NEAR[0], name).robots.blue[0].params for name in ATTACKERS}
    assert params["attack_main, wide"]["rater"] == {"name": "segment_clearance", "tolerance": 0.3645}
    assert "rater" not in params["attack_main"]
    assert params["attack_nn, no feint"]["feint"] is False
    assert "feint" not in params["attack_nn"]
    published = deployed_scenario(NEAR[0], "attack_main as published").robots.blue[0]
    assert published.play == "paper/robobulls.py:robobulls_attack_main"
    assert (published.params["shot_speed"], published.params["rater"]["tolerance"]) == (7.5, 0.1965)


def test_every_attacker_can_be_built_in_every_situation():
    for situation in SITUATIONS:
        for name in ATTACKERS:
            for _, setup in deployed_scenario(situation, name).robots:
                setup.build_tree()


@pytest.mark.parametrize("defenders", [1, 2])
def test_hard_situations_have_defenders_and_a_clock(defenders: int):
    scenario = deployed_scenario(Situation(defenders=defenders), "attack_expected")
    assert [robot.play for robot in scenario.robots.yellow] == ["goalkeeper", *["defender"] * defenders]
    assert scenario.ends.time_limit == 10.0


@pytest.mark.parametrize("trial", range(5))
def test_near_starts_are_two_and_a_half_to_four_and_a_half_metres_away(trial: int):
    with MatchLoop(deployed_scenario(NEAR[0], "attack_main"), trial, sim_world) as match:
        me = match.world.truth().own[0]
    assert 2.5 - 0.01 <= hypot(4.5 - me.x, me.y) <= 4.5 + 0.01


@pytest.mark.integration
def test_it_is_printed_as_tables_and_as_json(tmp_path: Path):
    picture = tmp_path / "line.png"
    options = ["deployed", "--shots", "1", "-w", "1", "--seed", "3", "--only", "attack_main"]
    options += ["--goalkeeper", "robobulls", "--starts", STARTS[1]]
    shown = CliRunner().invoke(application(), [*options, "--picture", str(picture)])
    assert shown.exit_code == 0, shown.output
    assert "28 / 100" in shown.output
    assert picture.read_bytes()[:4] == PNG
    said = json.loads(CliRunner().invoke(application(), [*options, "--json"]).output)
    assert [cell["speed"] for cell in said["cells"]] == ["half", "full"]


@pytest.mark.parametrize(
    "wrong", [["--only", "nobody"], ["--goalkeeper", "cat"], ["--starts", "mars"], ["--defenders", "3"]]
)
def test_what_there_is_not_is_refused(wrong: list[str]):
    assert CliRunner().invoke(application(), ["deployed", "-n", "1", *wrong]).exit_code == 2
