"""A field that others run is identified while it is watched, or played on."""

from __future__ import annotations

import json
from contextlib import nullcontext
from pathlib import Path

import pytest
from typer.testing import CliRunner

from robobt.cli import app
from robobt.cli import match as cli_match
from robobt.league.serve.served_field import served_scenario
from robobt.league.serve.server import SimServer
from robobt.match import load_scenario
from robobt.match.recording import load_recording
from robobt.match.scenario.scenario import Scenario
from robobt.sim import settings_from
from robobt.sim.realism import RealismSettings
from robobt.sim.settings import preset
from tests.league.lockstep import LockstepWorld
from tests.league.served import free_endpoints, served

pytestmark = pytest.mark.integration

OFFSET, NOISE = 0.02, 0.001


def erring(seconds: float = 12.0) -> Scenario:
    """Three against three on a field with cameras that err."""
    realism = RealismSettings(
        ball_noise=NOISE, robot_noise=NOISE, heading_noise=0.004, object_offset=OFFSET, camera_overlap=1.5
    )
    scenario = load_scenario("three_v_three").lasting(seconds)
    return scenario.model_copy(
        update={"simulator": {"preset": "default", "realism": realism.model_dump()}, "period": 1 / 60}
    )


def robobt(*arguments: object, code: int = 0) -> str:
    done = CliRunner().invoke(app, [str(argument) for argument in arguments])
    assert done.exit_code == code, done.output
    return done.stdout if code == 0 else done.output


def test_a_field_is_identified_while_it_is_watched(tmp_path: Path) -> None:
    out, endpoints = tmp_path / "field.yaml", free_endpoints()
    address = f"league://observer?vision={endpoints.vision}"
    with served(served_scenario(erring()), endpoints, 4.0, cameras=4):
        told = robobt("record", "identify", address, "--seconds", 3, "--out", out, "--json")
    figures = json.loads(told)["figures"]
    assert figures["noise.robot_noise"]["value"] == pytest.approx(NOISE, rel=0.1)
    assert figures["noise.object_offset"]["value"] == pytest.approx(OFFSET, abs=0.002)
    assert not figures["delay"]["seen"]
    assert preset(str(out)).realism.object_offset == pytest.approx(OFFSET, abs=0.002)


def test_a_field_that_sends_nothing_is_named() -> None:
    address = f"league://observer?vision={free_endpoints().vision}"
    told = robobt("record", "identify", address, "--seconds", 1, code=1)
    assert f"{address}: nothing came from the vision" in "".join(told.splitlines())


def test_a_match_identifies_the_field_on_which_it_was_played(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scenario, endpoints = erring(7.0), free_endpoints()
    settings = settings_from(scenario.simulator)
    robots = {robot: setup.limits_over(settings.limits) for robot, setup in scenario.robots}
    expected = {"field": scenario.field, "robots": robots, "settings": settings, "period": scenario.period}
    there = {"simulator": "grsim", "endpoints": endpoints}
    with (
        SimServer(served_scenario(scenario), endpoints, cameras=4) as server,
        LockstepWorld(server, **expected, **there) as world,
    ):
        monkeypatch.setattr(cli_match, "world_of", lambda *_: nullcontext(lambda _: world))
        out, file = tmp_path / "field.yaml", tmp_path / "match.robobt.arrows"
        short = ["three_v_three", "--set", "ends.time_limit=7", "--trials", 1]
        told = json.loads(robobt("match", *short, "--record", file, "--identify", out, "--json"))
    assert told["identified"] == str(out)
    # The recording holds where the cameras are, which a flying ball is seen from.
    assert sorted(load_recording(file).cameras) == [0, 1, 2, 3]
    realism = preset(str(out)).realism
    assert realism.robot_noise == pytest.approx(NOISE, rel=0.1)
    assert realism.object_offset == pytest.approx(OFFSET, abs=0.002)
    assert "# delay: not seen enough" not in out.read_text()


def test_a_match_that_is_not_recorded_is_identified_too(tmp_path: Path) -> None:
    out = tmp_path / "field.yaml"
    told = robobt("match", "three_v_three", "--set", "ends.time_limit=3", "--trials", 1, "--identify", out)
    assert f"Preset file: {out}" in " ".join(told.split())
    assert [it.name for it in tmp_path.iterdir()] == ["field.yaml"]


def test_results_are_printed_before_the_error_that_there_was_too_little_to_identify(tmp_path: Path) -> None:
    out = tmp_path / "field.yaml"
    short = ["match", "three_v_three", "--set", "ends.time_limit=0.5", "--trials", 1, "--identify", out]
    told = robobt(*short, code=1)
    assert "too few to identify anything" in " ".join(told.split())
    assert "three_v_three" in told
    assert not out.exists()


def test_seconds_are_for_a_field_that_is_watched(tmp_path: Path) -> None:
    told = robobt("record", "identify", tmp_path / "match.robobt.arrows", "--seconds", 3, code=2)
    assert "--seconds" in told
