"""Features that only some operating systems have, and the error for the others."""

from __future__ import annotations

import os

from robobt.config.errors import RobobtError


class SystemUnfitError(RobobtError, OSError):
    """This operating system lacks a feature; the message says which ones have it."""


def need_posix(what: str) -> None:
    """Check that processes can be grouped and stopped with signals, which ``what`` needs.

    Raises:
        SystemUnfitError: they cannot, as on Windows.
    """
    if os.name != "posix":
        raise SystemUnfitError(f"{what} needs Linux or macOS; on Windows run robobt in WSL for that")
