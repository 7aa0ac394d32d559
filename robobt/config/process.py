"""Protects this process from users' code that changes the working folder or forks."""

from __future__ import annotations

import logging
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress

_log = logging.getLogger(__name__)


class OwnProcess:
    """Detects that code run since its creation has changed the working folder or forked the process."""

    def __init__(self) -> None:
        self._number, self._folder = os.getpid(), _working_folder()

    def hold(self) -> bool:
        """Put the working folder back; return whether it had been changed.

        A copy of the process that has been forked ends here, at once. It has the same files open, so what it
        wrote would end up in the middle of what this process writes.
        """
        if os.getpid() != self._number:
            _end_copy()
        if _working_folder() == self._folder or self._folder is None:
            return False
        with suppress(OSError):
            os.chdir(self._folder)
        return True


@contextmanager
def users_code(whose: str) -> Iterator[None]:
    """Keep the process as it is while users' code runs; ``whose`` names it in a warning."""
    process = OwnProcess()
    try:
        yield
    finally:
        if process.hold():
            _log.warning(
                "%s changes the working folder, which was put back; name files by whole paths", whose
            )


def _working_folder() -> str | None:
    try:
        return os.getcwd()
    except OSError:
        # The folder has been removed.
        return None


def _end_copy() -> None:
    """End a forked copy with the exit status that it would have had, without finishing any file."""
    error = sys.exception()
    status = 0 if error is None else 1
    if isinstance(error, SystemExit):
        status = error.code if isinstance(error.code, int) else int(error.code is not None)
    os._exit(status & 0xFF)
