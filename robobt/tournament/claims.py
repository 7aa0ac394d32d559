"""Claims of matches, so that two programs with one store never play the same match.

A claim is a locked byte of a file beside the store. The system releases it when its program ends, even if it
is killed.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Hashable
from pathlib import Path
from typing import Self

try:
    import fcntl
except ImportError:  # Windows has no such locks; there two programs may play a match twice, and keep one.
    fcntl = None  # type: ignore[assignment]


class Claims:
    """Claims beside a file. A context manager that releases all claims at its end."""

    def __init__(self, path: Path) -> None:
        self._path = path.with_name(f".{path.name}.claims")
        self._file = os.open(self._path, os.O_RDWR | os.O_CREAT, 0o666)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        os.close(self._file)

    def take(self, what: Hashable) -> bool:
        """Claim a match; return False if another program has claimed it.

        Raises:
            OSError: the file system has no locks.
        """
        if fcntl is None:
            return True
        try:
            fcntl.lockf(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB, 1, _place(what))
        except (BlockingIOError, PermissionError):
            return False
        except OSError as error:
            # Taken for another program's claim this would be waited for, for ever.
            raise OSError(error.errno, f"cannot be locked: {error.strerror}", str(self._path)) from error
        return True

    def release(self, what: Hashable) -> None:
        """Release a claim."""
        if fcntl is not None:
            fcntl.lockf(self._file, fcntl.LOCK_UN, 1, _place(what))


def _place(what: Hashable) -> int:
    digest = hashlib.blake2b(repr(what).encode(), digest_size=7).digest()
    return int.from_bytes(digest, "big")
