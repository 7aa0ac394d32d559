"""Atomic file writes: readers find the complete old or new file, even after a crash."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from robobt.config.errors import naming


def write_atomically(path: Path, content: bytes | str) -> None:
    """Replace a file by this content; text is written as UTF-8.

    Raises:
        OSError: the file cannot be written; the error names ``path``.
    """
    with replacing(path) as temporary, naming(path):
        temporary.write_bytes(content.encode() if isinstance(content, str) else content)


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yield the path of a temporary file that replaces ``path`` when the block ends.

    The temporary file is in the same folder and its name ends like that of ``path``. It is removed if the
    block raises. A link stays, and its target is replaced. A device or a pipe, such as ``/dev/stdout``, is
    written to directly.

    Raises:
        OSError: the file cannot be put in place; the error names ``path``.
    """
    if path.exists() and not (path.is_file() or path.is_dir()):
        yield path
        return
    target = path.resolve()
    temporary = target.with_name(f".{os.getpid()}.{target.name}")
    try:
        yield temporary
        with naming(path):
            _sync(temporary, os.O_RDWR)
            temporary.replace(target)
            # A rename is on disk once its folder is; some systems cannot open folders.
            if hasattr(os, "O_DIRECTORY"):
                _sync(target.parent, os.O_RDONLY | os.O_DIRECTORY)
    finally:
        temporary.unlink(missing_ok=True)


def _sync(path: Path, flags: int) -> None:
    handle = os.open(path, flags)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
