"""The paper's plays on another world than the built-in simulator."""

from __future__ import annotations

import json

import pytest
from typer.testing import CliRunner

from paper.__main__ import application
from paper.deployed import SITUATIONS, deployed, deployed_scenario
from paper.table4 import COMBINATIONS, Conditions, table4, table4_scenario
from robobt.league.serve.served_field import served_scenario
from robobt.league.wire.endpoints import Endpoints
from robobt.match.scenario.scenario import Scenario
from robobt.worlds import world_from
from tests.league.served import free_endpoints, served


def address(endpoints: Endpoints, speed: float) -> str:
    ports = ("grsim", "control", "blue", "yellow", "blue_status", "yellow_status")
    options = [f"{name}={getattr(endpoints, name)}" for name in ports]
    options += [f"vision={endpoints.vision.address}:{endpoints.vision.port}", f"speed={speed}"]
    return "league://grsim?" + "&".join(options)


@pytest.mark.integration
def test_table_4_is_played_on_a_served_field() -> None:
    scenario: Scenario = table4_scenario("1", COMBINATIONS["geometric, kick"])
    endpoints = free_endpoints()
    with served(served_scenario(scenario), endpoints, speed=2.0):
        result = table4(
            1,
            combinations=("geometric, kick",),
            conditions=Conditions(limits=("own",), starts="paper"),
            trials=("1",),
            world=world_from(address(endpoints, 2.0)),
        )
    row = result["limits"]["own"]["1"]["rows"]["geometric, kick"]
    assert row["reached"].count == row["shots"].count == 1
    assert row["ball_ratio"] > 0.9


@pytest.mark.slow
def test_the_deployed_attackers_play_on_a_served_field() -> None:
    endpoints = free_endpoints()
    situation = SITUATIONS[0]
    with served(served_scenario(deployed_scenario(situation, "attack_main")), endpoints, speed=2.0):
        result = deployed(
            1,
            situations=[situation],
            attackers=["attack_main"],
            world=world_from(address(endpoints, 2.0)),
        )
    assert result["cells"][0]["attackers"]["attack_main"]["attempts"] == 1


def test_over_the_network_there_is_one_worker() -> None:
    shown = CliRunner().invoke(application(), ["deployed", "-n", "1", "-w", "2", "--world", "league://grsim"])
    assert shown.exit_code == 2
    assert "must be 1 to play over" in " ".join(shown.output.split())


@pytest.mark.parametrize("table", ["table4", "deployed"])
def test_a_world_that_is_none_is_one_line(table: str) -> None:
    shown = CliRunner().invoke(application(), [table, "--world", "league://elsewhere", "--json"])
    assert shown.exit_code == 1
    assert "league://elsewhere" in shown.output
    with pytest.raises(json.JSONDecodeError):
        json.loads(shown.output)
