"""One writer for a file: a second process that would write it too is refused."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

from robobt.config.closing import Closing

try:
    import fcntl
except ImportError:  # Windows has no such locks; there nobody is refused.
    fcntl = None  # type: ignore[assignment]


class OnlyWriter(Closing):
    """The right to write a file, until it is closed or the process ends, even if it is killed.

    The lock is a file of its own, ``.NAME.lock`` beside the other, because that one may be replaced. It is
    removed at the end. Where the file system has no locks, or no file can be made, nobody is refused.

    Args:
        path: the file; its folder has to be there.
        refusal: error to raise for a file that is being written.

    Raises:
        ValueError: ``refusal``, because another process, or this one, is writing the file.
    """

    def __init__(self, path: Path, refusal: type[ValueError]) -> None:
        self._lock = path.with_name(f".{path.name}.lock")
        self._handle: int | None = None
        while fcntl is not None:
            try:
                handle = os.open(self._lock, os.O_RDWR | os.O_CREAT, 0o666)
            except OSError:
                return
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
                # A writer that has just ended has removed the file that it locked.
                if self._is(handle):
                    self._handle = handle
                    return
            except BlockingIOError as error:
                os.close(handle)
                said = "is being written by another run; wait for it, or give another name"
                raise refusal(f"{path}: {said}") from error
            except OSError:
                os.close(handle)
                return
            os.close(handle)

    def close(self) -> None:
        """Let others write the file."""
        if self._handle is not None:
            with suppress(OSError):
                self._lock.unlink()
            os.close(self._handle)
            self._handle = None

    def _is(self, handle: int) -> bool:
        """Return whether the file that ``handle`` opened is still the lock's."""
        try:
            return os.path.samestat(os.fstat(handle), self._lock.stat())
        except FileNotFoundError:
            return False
