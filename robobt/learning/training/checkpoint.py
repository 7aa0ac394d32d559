"""Checkpoints: arrays and plain data in one file, written atomically.

The file is a magic word, a checksum and a zip of arrays: nothing in it is code, and
damage is noticed before anything is read from it.
"""

from __future__ import annotations

import hashlib
import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypedDict

import numpy as np
from numpy.typing import NDArray

from robobt.config.atomic import write_atomically
from robobt.config.errors import RobobtError

_CHECKPOINT_MAGIC = b"robobt-checkpoint-2\n"
_DIGEST = 32
_STATE = "state"

Arrays = dict[str, NDArray[np.generic]]


class RunState(TypedDict):
    """The state of a run besides its arrays."""

    steps: int
    rng: Mapping[str, Any]
    validations: list[dict[str, Any]]
    clock: dict[str, float]
    robobt: str
    task_digest: str


class CheckpointError(RobobtError, ValueError):
    """A checkpoint cannot be read; the message is one line that names the file."""


def save(path: Path, arrays: Mapping[str, NDArray[np.generic]], state: RunState) -> None:
    """Write a checkpoint; the one before it is kept beside it as ``*.previous``."""
    text = np.frombuffer(json.dumps(dict(state)).encode(), dtype=np.uint8)
    buffer = io.BytesIO()
    np.savez(buffer, allow_pickle=False, **{_STATE: text}, **arrays)
    payload = buffer.getbuffer()
    digest = hashlib.blake2b(payload, digest_size=_DIGEST).digest()
    if path.exists():
        path.replace(previous(path))
    write_atomically(path, b"".join((_CHECKPOINT_MAGIC, digest, payload)))


def load(path: Path) -> tuple[Arrays, RunState]:
    """Return arrays and plain data of a checkpoint.

    Raises:
        CheckpointError: no such file, or it is cut short, damaged or another kind of file.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise CheckpointError(f"{path}: cannot be read: {error.strerror or error}") from error
    head = len(_CHECKPOINT_MAGIC) + _DIGEST
    if not content.startswith(_CHECKPOINT_MAGIC):
        raise CheckpointError(f"{path}: not a checkpoint of this version of robobt")
    payload = memoryview(content)[head:]
    if hashlib.blake2b(payload, digest_size=_DIGEST).digest() != content[len(_CHECKPOINT_MAGIC) : head]:
        raise CheckpointError(f"{path}: damaged or cut short")
    with np.load(io.BytesIO(payload), allow_pickle=False) as stored:
        arrays: Arrays = {name: stored[name] for name in stored.files}
    state: RunState = json.loads(arrays.pop(_STATE).tobytes())
    return arrays, state


def load_latest(path: Path) -> tuple[Arrays, RunState, str | None]:
    """Return the checkpoint, or the one before it and why the newest could not be used.

    Raises:
        CheckpointError: neither can be read; the message is about the newest.
    """
    try:
        return *load(path), None
    except CheckpointError as error:
        try:
            return *load(previous(path)), str(error)
        except CheckpointError:
            raise error from None


def previous(path: Path) -> Path:
    """Return the path of the checkpoint before the newest."""
    return path.with_name(f"{path.name}.previous")


def digest_of(arrays: Arrays) -> str:
    """Return a hash of arrays and their names."""
    digest = hashlib.blake2b(digest_size=16)
    for name in sorted(arrays):
        digest.update(name.encode())
        digest.update(arrays[name].tobytes())
    return digest.hexdigest()
