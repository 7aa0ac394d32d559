"""What only some operating systems can do, and how one that cannot says so."""

from __future__ import annotations

import os

from robobt.config.errors import RobobtError


class SystemUnfitError(RobobtError, OSError):
    """Something that this operating system cannot do; the message says which ones can."""


def need_posix(what: str) -> None:
    """Check that processes can be grouped and stopped with signals, which ``what`` needs.

    Raises:
        SystemUnfitError: they cannot, as on Windows.
    """
    if os.name != "posix":
        raise SystemUnfitError(f"{what} needs Linux or macOS; on Windows run robobt in WSL for that")
