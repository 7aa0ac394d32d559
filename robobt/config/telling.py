"""The log messages for users."""

from __future__ import annotations

import logging

OFTEN = ("robobt.tree.runner", "robobt.match.players")
"""Loggers that repeat a message in every tick while a tree raises."""


def tell_warnings(debug: bool = False) -> None:
    """Show warnings, as for a program; show all messages with ``debug``.

    Exceptions of trees are counted in the results; a line on stderr in each tick would not help.
    """
    logging.getLogger("robobt").setLevel(logging.DEBUG if debug else logging.WARNING)
    for often in OFTEN:
        logging.getLogger(often).setLevel(logging.NOTSET if debug else logging.ERROR)
