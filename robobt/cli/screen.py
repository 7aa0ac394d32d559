"""The consoles that commands print on, and how wide they are."""

from __future__ import annotations

import os
import sys
from collections.abc import MutableMapping
from pathlib import Path

from rich.console import Console

_NARROWEST_SCREEN, _WIDEST_SCREEN = 40, 1000
"""Widths from which a table loses text, and beyond which padding takes megabytes [columns]."""


def drop_odd_sizes(environment: MutableMapping[str, str]) -> None:
    """Remove sizes of the screen that make no sense, so that the terminal's own or 80 columns count.

    Rich prints nothing in 0 columns, and raises for digits that int() does not read.
    """
    for name, least, most in (("COLUMNS", _NARROWEST_SCREEN, _WIDEST_SCREEN), ("LINES", 1, _WIDEST_SCREEN)):
        given = environment.get(name, "")
        # The length first: int() refuses thousands of digits.
        if not (given.isdecimal() and len(given) <= len(str(most)) and least <= int(given) <= most):
            environment.pop(name, None)


class _Console(Console):
    """A console that leaves it to the command what happens when nobody reads on."""

    def on_broken_pipe(self) -> None:
        raise BrokenPipeError


for _name in ("stdout", "stderr"):
    if getattr(sys, _name) is None:
        # The process was started with it closed: nobody wants to read it.
        setattr(sys, _name, Path(os.devnull).open("w", encoding="utf-8"))  # noqa: SIM115

drop_odd_sizes(os.environ)
console = _Console(highlight=False)
errors = _Console(stderr=True, highlight=False)
