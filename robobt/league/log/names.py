"""Which files are league logs, by their names; without the extra that reads them."""

from __future__ import annotations

from pathlib import Path

LOGS = (".log", ".log.gz")
"""How the names of league logs end."""


def is_log(path: str | Path) -> bool:
    """Return whether a file is named as a league log."""
    return Path(path).name.lower().endswith(LOGS)
