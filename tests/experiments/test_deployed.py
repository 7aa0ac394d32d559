import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from robobt.cli import app
from robobt.experiments.deployed import PLAYED, deployed, deployed_scenario, judged_goal_line
from robobt.experiments.goal_map import draw_goal_map, goal_map
from robobt.match.scenario.scenario import load_scenario
from robobt.worlds import sim_world

PNG = b"\x89PNG"


@pytest.mark.integration
def test_every_play_is_judged_on_the_same_starts_beside_the_papers_figures():
    ticks = []
    result = deployed(3, seed=11, speeds=("half",), progress=lambda: ticks.append(1))
    plays = result["speeds"]["half"]
    assert tuple(plays) == PLAYED
    assert len(ticks) == 9
    assert plays["attack_main"]["paper"] == {"goals": 28, "shots": 100}
    assert plays["attack_main"]["waiting"] == 0.0
    assert plays["attack_main"]["mcnemar"] is None
    for one in plays.values():
        assert one["low"] <= one["rate"] == one["goals"] / 3 <= one["high"]
        assert sum(one["outcomes"].values()) == 3
    assert plays["attack_nn"]["waiting"] > 0.0


@pytest.mark.parametrize(("speed", "factor"), [("half", 0.5), ("full", 1.0)])
def test_the_goalkeeper_is_that_of_the_collection_scenario(speed: str, factor: float):
    keeper = deployed_scenario(speed, "attack_nn").robots.yellow[0]
    collected = load_scenario(f"attack_vs_goalkeeper_motion_{speed}").robots.yellow[0]
    assert keeper.limits == collected.limits
    assert keeper.limits is not None
    assert keeper.limits.max_speed == 2.25
    assert keeper.params["speed"] == collected.params["speed"] == factor
    assert sim_world(deployed_scenario(speed, "attack_nn")).settings.kicker.max_speed == 7.5


@pytest.mark.integration
def test_it_is_printed_as_tables_and_as_json(tmp_path: Path):
    picture = tmp_path / "line.png"
    options = ["paper", "deployed", "--shots", "1", "-w", "1", "--seed", "3"]
    shown = CliRunner().invoke(app, [*options, "--picture", str(picture)])
    assert shown.exit_code == 0, shown.output
    assert "28 / 100" in shown.output
    assert "attack_expected" in shown.output
    assert picture.read_bytes()[:4] == PNG
    said = json.loads(CliRunner().invoke(app, [*options, "--json"]).output)
    assert set(said["speeds"]) == {"half", "full"}


@pytest.mark.integration
def test_the_judged_goal_line_is_a_picture(tmp_path: Path):
    judged_goal_line("half", 3, tmp_path / "line.png")
    assert (tmp_path / "line.png").read_bytes()[:4] == PNG


def test_the_map_is_symmetric_and_near_places_are_better_than_far_ones(tmp_path: Path):
    found = goal_map(spacing=0.5)
    assert np.allclose(found.probability, found.probability[::-1], atol=1e-4, equal_nan=True)
    middle = found.probability[len(found.y) // 2]
    assert middle[list(found.x).index(3.0)] > 0.9 > 0.1 > middle[0]
    draw_goal_map(found, tmp_path / "map.png")
    assert (tmp_path / "map.png").read_bytes()[:4] == PNG
    assert np.isnan(found.probability).any()
