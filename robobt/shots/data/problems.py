"""Errors in shot data."""

from __future__ import annotations

from robobt.config.errors import RobobtError


class ShotDataError(RobobtError, ValueError):
    """A file of shots is invalid; the message names the file, the row and the column."""
