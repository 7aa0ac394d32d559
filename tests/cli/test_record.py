import json
from dataclasses import asdict
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from robobt.cli import app
from robobt.config.resources import bundled_scenarios
from robobt.config.yaml import parse_marked, write_yaml
from robobt.match import MatchLoop
from robobt.match.regression_cases import check_regression_case
from robobt.match.scenario.scenario import load_scenario
from robobt.plays import PLAYS, python_files
from robobt.plays.python_files import import_file
from robobt.worlds import sim_world
from tests.match.recording.made_recording import record
from tests.registries import temporarily


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    path = tmp_path / "made.robobt.arrows"
    record(path)
    return path


def exported(recording: Path, name: str, *options: str) -> Result:
    out = str(recording.parent / name)
    return CliRunner().invoke(app, ["record", "export", str(recording), "--out", out, *options])


def test_a_log_of_a_robots_tree_is_written_and_a_robot_without_a_tree_is_refused(recording: Path) -> None:
    assert exported(recording, "a.btlog", "--robot", "blue 1").exit_code == 0
    assert (recording.parent / "a.btlog").read_bytes().startswith(b"BTCPP4-FileLogger2\x01")
    assert exported(recording, "b.btlog").exit_code == 2
    assert exported(recording, "b.btlog", "--robot", "blue 4").exit_code == 2
    assert not (recording.parent / "b.btlog").exists()


def test_an_mcap_file_holds_the_whole_match(recording: Path) -> None:
    pytest.importorskip("mcap")
    done = exported(recording, "a.mcap")
    assert done.exit_code == 0, done.stderr
    assert (recording.parent / "a.mcap").read_bytes().startswith(b"\x89MCAP0\r\n")
    assert exported(recording, "b.mcap", "--robot", "blue 1").exit_code == 2


@pytest.mark.parametrize("name", ["a.txt", "made.robobt.arrows"])
def test_the_format_is_in_the_ending(recording: Path, name: str) -> None:
    before = recording.read_bytes()
    done = exported(recording, name)
    assert done.exit_code == 2
    assert "takes a name that ends in .mcap, .parquet, .btlog" in done.output
    assert recording.read_bytes() == before


def test_a_tick_that_cannot_be_a_case_is_one_line_on_stderr(recording: Path) -> None:
    out = recording.parent / "case.yaml"
    given = ["record", "case", str(recording), "--tick", "3", "--robot", "blue 1", "--out", str(out)]
    refused = CliRunner().invoke(app, given)
    assert refused.exit_code == 1
    assert not out.exists()


def test_a_case_of_a_play_from_a_python_file_is_saved_with_that_file(tmp_path: Path) -> None:
    file = tmp_path / "own_play.py"
    file.write_text(
        "from robobt.plays import PLAYS\nfrom robobt.skills import Stop\n"
        "PLAYS.register('stands_still')(lambda: Stop())\n"
    )
    scenario = parse_marked(bundled_scenarios()["striker_vs_goalkeeper"].read_text(), "yaml").plain()
    scenario["robots"]["blue"][0] |= {"play": "stands_still", "params": {}}
    (tmp_path / "still.yaml").write_text(write_yaml(scenario))
    recorded, case = tmp_path / "still.robobt.arrows", tmp_path / "case.yaml"
    with temporarily(PLAYS):
        import_file(file)
        MatchLoop(load_scenario(tmp_path / "still.yaml").lasting(0.3), 3, sim_world, recorded).play()
    wanted = ["record", "case", str(recorded), "--tick", "3", "--robot", "blue 0", "--out", str(case)]
    refused = CliRunner().invoke(app, wanted)
    assert refused.exit_code == 1
    assert "stands_still" in refused.stderr
    python_files._imported.clear()
    with temporarily(PLAYS):
        saved = CliRunner().invoke(app, [*wanted, "--import", str(file)])
        assert saved.exit_code == 0, saved.stderr
        check_regression_case(case)


@pytest.mark.integration
def test_the_statistics_of_a_recording_are_those_of_the_match(tmp_path: Path) -> None:
    path = tmp_path / "match.robobt.arrows"
    with MatchLoop(load_scenario("six_v_six").lasting(8.0), 3, sim_world, path) as match:
        result = match.play()
    done = CliRunner().invoke(app, ["record", "statistics", str(path), "--json"])
    assert done.exit_code == 0, done.output
    counted = json.loads(done.stdout)
    played = {name: asdict(team) for name, team in result.teams.items()}
    assert played["blue"]["distance"] > 1.0
    for name, team in counted.items():
        assert team == pytest.approx(played[name], abs=1e-3)
    assert "passes completed" in CliRunner().invoke(app, ["record", "statistics", str(path)]).stdout


def test_a_recording_without_a_referee_has_no_statistics(tmp_path: Path) -> None:
    path = tmp_path / "free.robobt.arrows"
    with MatchLoop(load_scenario("table4_trial1_own").lasting(0.1), 0, sim_world, path) as match:
        assert match.play().teams == {}
    refused = CliRunner().invoke(app, ["record", "statistics", str(path)])
    assert refused.exit_code == 2
    assert "no referee" in refused.output
