"""What is wrong with shot data."""

from __future__ import annotations

from robobt.config.errors import RobobtError


class ShotDataError(RobobtError, ValueError):
    """A file of shots is not what it should be; the message names the file, the row and the column."""
