import json
import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from paper.__main__ import application
from robobt.shots.data.files import write_shots
from tests.shots.made_up import made_up_table, train_quickly


@pytest.fixture
def shots(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    train_quickly(monkeypatch)
    write_shots(made_up_table(160, split=True), tmp_path / "shots.parquet")
    return str(tmp_path / "shots.parquet")


@pytest.mark.integration
def test_table_3_is_printed_as_a_table_and_as_json(shots: str, tmp_path: Path):
    options = [
        "--data",
        shots,
        "--seeds",
        "2",
        "--repeats",
        "1",
        "--model",
        "table_one",
        "--model",
        "logistic",
    ]
    picture = tmp_path / "diagram.png"
    shown = CliRunner().invoke(application(), ["table3", *options, "--picture", str(picture)])
    assert shown.exit_code == 0
    assert "102, 20" in shown.output
    assert "85.07 %" in shown.output
    assert picture.is_file()
    said = json.loads(CliRunner().invoke(application(), ["table3", *options, "--json"]).output)
    assert said["test"]["shots"] == 40
    assert len(said["models"]["logistic"]["confusion"]) == 2


@pytest.mark.integration
def test_table_2_is_printed_as_json(shots: str, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("paper.table2.REPEATS", 1)
    monkeypatch.setattr("paper.table2.HOLD_OUTS", (0.33,))
    options = ["table2", "--data", shots, "--replications", "1"]
    said = json.loads(CliRunner().invoke(application(), [*options, "--json"]).output)
    assert said["hold_outs"]["33%"]["paper"]["t"] == 1.9666


@pytest.mark.parametrize(
    ("options", "word"),
    [(["--data", "nowhere.csv"], "nowhere.csv"), (["--model", "crystal_ball"], "crystal_ball")],
)
def test_what_is_wrong_is_said_in_one_line(options: list[str], word: str):
    result = CliRunner().invoke(application(), ["table3", *options])
    assert result.exit_code != 0
    assert word in result.output
    assert "Traceback" not in result.output


def test_help_needs_nothing_heavy():
    code = (
        "import sys; from paper.__main__ import application; application()\n"
        "print({'numpy', 'numba', 'torch', 'scipy', 'sklearn', 'pydantic'} & set(sys.modules))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"
