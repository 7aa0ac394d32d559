"""What the log tells people."""

from __future__ import annotations

import logging

OFTEN = ("robobt.tree.runner", "robobt.match.players")
"""Loggers that say the same thing every tick while a tree raises."""


def tell_warnings(debug: bool = False) -> None:
    """Let warnings through, as a program does; all there is to say when ``debug``.

    What trees raise is counted in the results; a line on stderr each tick helps nobody.
    """
    logging.getLogger("robobt").setLevel(logging.DEBUG if debug else logging.WARNING)
    for often in OFTEN:
        logging.getLogger(often).setLevel(logging.NOTSET if debug else logging.ERROR)
