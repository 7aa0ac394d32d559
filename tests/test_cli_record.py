from pathlib import Path

import pytest
from typer.testing import CliRunner

from robobt.cli import app
from tests.match.made_recording import record


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    path = tmp_path / "made.robobt.jsonl"
    record(path)
    return path


def test_a_log_is_written_beside_the_recording_and_a_robot_without_a_tree_is_refused(recording: Path) -> None:
    done = CliRunner().invoke(app, ["record", "export", "--btlog", str(recording), "--robot", "blue 1"])
    assert done.exit_code == 0
    assert (recording.parent / "made-blue-1.btlog").read_bytes().startswith(b"BTCPP4-FileLogger2\x01")
    assert CliRunner().invoke(app, ["record", "export", "--btlog", str(recording)]).exit_code == 2
    refused = CliRunner().invoke(app, ["record", "export", "--btlog", str(recording), "--robot", "blue 4"])
    assert refused.exit_code == 2


def test_a_tick_that_cannot_be_a_case_is_one_line_on_stderr(recording: Path) -> None:
    out = recording.parent / "case.yaml"
    given = ["record", "case", str(recording), "--tick", "3", "--robot", "blue 1", "--out", str(out)]
    refused = CliRunner().invoke(app, given)
    assert refused.exit_code == 1
    assert not out.exists()
