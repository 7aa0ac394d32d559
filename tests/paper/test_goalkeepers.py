import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from paper.__main__ import application
from robobt.shots.data.files import write_shots
from robobt.shots.keepers.population import read_population
from tests.shots.made_up import made_up_table


@pytest.fixture
def shots(tmp_path: Path) -> str:
    write_shots(made_up_table(60), tmp_path / "shots.parquet")
    return str(tmp_path / "shots.parquet")


@pytest.mark.integration
def test_fitted_goalkeepers_are_written_so_that_shots_can_be_collected_against_them(
    shots: str, tmp_path: Path
):
    out = tmp_path / "fitted" / "mine.yaml"
    result = CliRunner().invoke(application(), ["goalkeepers", "--data", shots, "--out", str(out), "--json"])
    assert result.exit_code == 0
    found = json.loads(result.stdout)
    assert read_population(out).model_dump() == pytest.approx(found["population"], rel=1e-2)
    assert found["shots"] == sum(one["shots"] for one in found["by_distance"]) == 60
    assert found["base_rate"] * 60 == pytest.approx(sum(one["goals"] for one in found["by_distance"]))


def test_a_file_that_is_there_is_kept(shots: str, tmp_path: Path):
    there = tmp_path / "mine.yaml"
    there.write_text("mine")
    result = CliRunner().invoke(application(), ["goalkeepers", "--data", shots, "--out", str(there)])
    assert result.exit_code != 0
    assert "--force" in result.output
    assert there.read_text() == "mine"
