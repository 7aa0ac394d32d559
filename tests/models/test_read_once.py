"""A model file is read and hashed once between the file and the leaf."""

from __future__ import annotations

import os
import shutil
import time
from pathlib import Path

import pytest

from robobt.models import file as model_file
from robobt.models.file import MANIFEST, ModelError, read_model_file
from robobt.models.find import find_model
from robobt.skills import GoToBall

OLD = time.time() - 10.0


@pytest.fixture
def model(tmp_path: Path) -> Path:
    path = Path(shutil.copy(find_model("go_to_ball_ddpg"), tmp_path / "mine.pt"))
    os.utime(path, (OLD, OLD))
    return path


@pytest.fixture
def read(monkeypatch: pytest.MonkeyPatch) -> list[Path]:
    """The files that are read, in their order; every file looks as if it had been changed long ago."""
    found: list[Path] = []
    reading = model_file._read

    def noted(path: Path) -> bytes:
        found.append(path)
        return reading(path)

    monkeypatch.setattr(model_file, "_read", noted)
    monkeypatch.setattr(model_file, "_RECENT", 0)
    return found


def test_two_leaves_with_the_network_read_their_file_once(model: Path, read: list[Path]) -> None:
    GoToBall(policy=str(model))
    GoToBall(policy=str(model))
    assert read == [model]


def test_a_file_that_changes_is_read_again(model: Path, read: list[Path]) -> None:
    read_model_file(model)
    content = model.read_bytes()
    model.write_bytes(content[:-1] + bytes([content[-1] ^ 1]))
    with pytest.raises(ModelError, match="has been altered"):
        read_model_file(model)


def test_a_manifest_that_changes_is_read_again(model: Path, read: list[Path]) -> None:
    checksum = read_model_file(model).sha256
    (model.parent / MANIFEST).write_text(f"{checksum[::-1]}  {model.name}\n")
    with pytest.raises(ModelError, match="its checksum is not the one"):
        read_model_file(model)


def test_a_file_that_has_just_changed_is_always_read(model: Path, read: list[Path], monkeypatch) -> None:
    monkeypatch.setattr(model_file, "_RECENT", 10**18)
    read_model_file(model)
    read_model_file(model)
    assert read == [model, model]
