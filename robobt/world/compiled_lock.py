"""Lets one process compile at a time what several need: the others load what it has kept."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

try:
    import fcntl
except ImportError:  # Windows has none, and every process compiles for itself there.
    fcntl = None  # type: ignore[assignment]


class CompilingTurn:
    """This process's turn to compile: a lock on the folder in which compiled code is kept.

    One function is compiled within another that calls it, so that only the outermost takes a turn: nobody
    waits who holds one. The lock ends with the process.

    Attributes:
        of: the function whose compilation began the turn; None outside of a turn.
    """

    def __init__(self) -> None:
        self.of: object = None
        self._folder = -1

    def begin(self, of: object, folder: str | Path) -> bool:
        """Wait for the turn, and return whether it has begun; False within a turn, or where none is given.

        Args:
            of: the function that is compiled.
            folder: where its compiled code is kept.
        """
        if fcntl is None or self.of is not None:
            return False
        # A folder that cannot be locked, as on some network drives, is used without.
        with suppress(OSError):
            Path(folder).mkdir(parents=True, exist_ok=True)
            self._folder = os.open(folder, os.O_RDONLY)
            try:
                fcntl.flock(self._folder, fcntl.LOCK_EX)
            except BaseException:
                os.close(self._folder)
                raise
            self.of = of
            return True
        return False

    def end(self, of: object) -> None:
        """End the turn if it is that of the function ``of``."""
        if self.of is of is not None:
            self.of = None
            os.close(self._folder)
