"""A file that is written atomically is the old or the new one."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from robobt.config.atomic import replacing, write_atomically


def test_the_new_content_takes_the_place_of_the_old(tmp_path: Path) -> None:
    path = tmp_path / "file.json"
    write_atomically(path, b"old")
    write_atomically(path, "né")
    assert path.read_bytes() == "né".encode()
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("failing", ["fsync", "replace"])
def test_a_failure_leaves_the_old_file_alone_and_names_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, failing: str
) -> None:
    def full(*_: object) -> None:
        raise OSError(28, "No space left on device")

    path = tmp_path / "file.json"
    write_atomically(path, "old")
    monkeypatch.setattr(*((os, "fsync") if failing == "fsync" else (Path, "replace")), full)
    with pytest.raises(OSError, match="No space left") as caught:
        write_atomically(path, "new")
    assert caught.value.filename == str(path)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_block_that_raises_leaves_the_old_file_alone(tmp_path: Path) -> None:
    path = tmp_path / "plot.png"

    def draw() -> None:
        with replacing(path) as temporary:
            assert temporary.name.endswith(path.name)
            temporary.write_text("half")
            raise ValueError("no plot")

    with pytest.raises(ValueError, match="no plot"):
        draw()
    assert list(tmp_path.iterdir()) == []


def test_a_link_stays_and_what_it_leads_to_is_replaced(tmp_path: Path) -> None:
    path, target = tmp_path / "link.json", tmp_path / "there" / "file.json"
    target.parent.mkdir()
    path.symlink_to(target)
    for content in ("old", "new"):
        write_atomically(path, content)
        assert target.read_text() == content
    assert path.is_symlink()
    assert list(target.parent.iterdir()) == [target]


def test_a_pipe_is_written_to_as_it_is(tmp_path: Path) -> None:
    path = tmp_path / "pipe"
    os.mkfifo(path)
    reader = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
    write_atomically(path, "said")
    assert os.read(reader, 100) == b"said"
    os.close(reader)
    assert path.is_fifo()
