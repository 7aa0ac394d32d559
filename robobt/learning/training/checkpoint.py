"""Checkpoints: arrays and plain data in one file that is whole or not there.

The file is a magic word, a checksum and a zip of arrays, so that nothing in it
is code and damage is noticed before anything is taken from it.
"""

from __future__ import annotations

import hashlib
import io
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robobt.config.atomic import write_atomically
from robobt.config.errors import RobobtError

_MAGIC = b"robobt-checkpoint-1\n"
_DIGEST = 32
_PLAIN = "plain"

Arrays = dict[str, NDArray[np.generic]]


class CheckpointError(RobobtError, ValueError):
    """A checkpoint cannot be read; the message is one line that names the file."""


def save(path: Path, arrays: Mapping[str, NDArray[np.generic]], plain: Mapping[str, Any]) -> None:
    """Write a checkpoint; the one before it is kept beside it as ``*.previous``.

    Args:
        path: the file.
        arrays: by name.
        plain: what JSON holds.
    """
    text = np.frombuffer(json.dumps(dict(plain)).encode(), dtype=np.uint8)
    buffer = io.BytesIO()
    np.savez(buffer, allow_pickle=False, **{_PLAIN: text}, **arrays)
    payload = buffer.getbuffer()
    digest = hashlib.blake2b(payload, digest_size=_DIGEST).digest()
    if path.exists():
        path.replace(previous(path))
    write_atomically(path, b"".join((_MAGIC, digest, payload)))


def load(path: Path) -> tuple[Arrays, dict[str, Any]]:
    """Arrays and plain data of a checkpoint.

    Raises:
        CheckpointError: no such file, or it is cut short, damaged or another kind of file.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise CheckpointError(f"{path}: cannot be read: {error.strerror or error}") from error
    head = len(_MAGIC) + _DIGEST
    if not content.startswith(_MAGIC):
        raise CheckpointError(f"{path}: not a checkpoint of robobt")
    payload = memoryview(content)[head:]
    if hashlib.blake2b(payload, digest_size=_DIGEST).digest() != content[len(_MAGIC) : head]:
        raise CheckpointError(f"{path}: damaged or cut short")
    with np.load(io.BytesIO(payload), allow_pickle=False) as stored:
        arrays: Arrays = {name: stored[name] for name in stored.files}
    plain: dict[str, Any] = json.loads(arrays.pop(_PLAIN).tobytes())
    return arrays, plain


def load_latest(path: Path) -> tuple[Arrays, dict[str, Any], str | None]:
    """The checkpoint, or the one before it where this one is missing or damaged.

    Returns:
        Arrays, plain data, and why the newest could not be used (None where it was).

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
    """Where the checkpoint before the newest lies."""
    return path.with_name(f"{path.name}.previous")
