"""Warnings that a user gets once, however often their cause returns."""

from __future__ import annotations

import logging

_log = logging.getLogger(__name__)


class Notices:
    """Gives each warning once."""

    def __init__(self) -> None:
        self._told: set[str] = set()

    def tell(self, what: str, message: str) -> None:
        """Warn the user of something, once; ``what`` names it."""
        if what not in self._told:
            self._told.add(what)
            _log.warning(message)
