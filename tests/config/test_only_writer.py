"""A file has one writer at a time."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from robobt.config.only_writer import OnlyWriter

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="there are no such locks")


def test_a_second_writer_is_refused_until_the_first_has_ended(tmp_path: Path) -> None:
    path = tmp_path / "results.jsonl"
    with OnlyWriter(path, ValueError), pytest.raises(ValueError, match=r"results\.jsonl: is being written"):
        OnlyWriter(path, ValueError)
    with OnlyWriter(path, ValueError):
        pass
    assert list(tmp_path.iterdir()) == []


def test_another_file_of_the_folder_is_free(tmp_path: Path) -> None:
    with OnlyWriter(tmp_path / "one", ValueError), OnlyWriter(tmp_path / "other", ValueError):
        pass


def test_a_killed_writer_keeps_nobody_out(tmp_path: Path) -> None:
    path = tmp_path / "results.jsonl"
    script = (
        "import os, signal, sys; from pathlib import Path; from robobt.config.only_writer import OnlyWriter\n"
        "lock = OnlyWriter(Path(sys.argv[1]), ValueError); os.kill(os.getpid(), signal.SIGKILL)"
    )
    subprocess.run([sys.executable, "-c", script, str(path)], check=False)
    assert [left.name for left in tmp_path.iterdir()] == [".results.jsonl.lock"]
    with OnlyWriter(path, ValueError):
        pass
    assert list(tmp_path.iterdir()) == []


def test_where_no_lock_can_be_made_nobody_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "results.jsonl"
    os.mkdir(tmp_path / ".results.jsonl.lock")
    with OnlyWriter(path, ValueError), OnlyWriter(path, ValueError):
        pass
