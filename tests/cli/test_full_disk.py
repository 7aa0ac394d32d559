"""A command that cannot write its file to the end leaves nothing of it."""

from __future__ import annotations

import resource
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from typer.testing import CliRunner

from robobt.cli import app
from tests.match.recording.made_recording import record

pytestmark = pytest.mark.integration

MATCH = ["match", "striker_vs_goalkeeper", "-n", "1", "--set", "ends.time_limit=2", "--record"]
OUTPUTS = [
    ([*MATCH, "{}/a.html"], 50_000),
    ([*MATCH, "{}/a.robobt.arrows"], 5_000),
    (["show", "attack_main", "--out", "{}/a.svg"], 1000),
    (["show", "attack_main", "--out", "{}/a.xml"], 1000),
    (["show", "{recording}", "--out", "{}/a.gif"], 1000),
    (["show", "{recording}", "--out", "{}/a.html"], 1000),
    (["record", "export", "{recording}", "--robot", "blue 1", "--out", "{}/a.btlog"], 200),
]


@contextmanager
def files_no_longer_than(size: int) -> Iterator[None]:
    """Fail writes beyond this size, in the middle of a file, as a full disk does [bytes].

    Python itself would keep the cut bytecode of a module that is imported meanwhile.
    """
    bytecode, sys.dont_write_bytecode = sys.dont_write_bytecode, True
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
        sys.dont_write_bytecode = bytecode


@pytest.mark.parametrize(("arguments", "size"), OUTPUTS)
def test_a_full_disk_leaves_no_piece_of_a_file(arguments: list[str], size: int, tmp_path: Path) -> None:
    recording, folder, roomy = tmp_path / "made.robobt.arrows", tmp_path / "out", tmp_path / "roomy"
    record(recording)
    folder.mkdir()
    # Once with room enough: compiled code is kept in files too, and has to be there.
    written = CliRunner().invoke(app, [text.format(roomy, recording=recording) for text in arguments])
    assert written.exit_code == 0, written.output
    given = [text.format(folder, recording=recording) for text in arguments]
    with files_no_longer_than(size):
        ended = CliRunner().invoke(app, given)
    assert ended.exit_code == 1
    assert "File too large" in " ".join(ended.output.split())
    assert list(folder.iterdir()) == []
