"""The consoles that commands print on, how wide they are, and tables that fit them."""

from __future__ import annotations

import os
import re
import sys
from collections.abc import MutableMapping, Sequence
from pathlib import Path
from typing import Any

from rich.cells import cell_len
from rich.console import Console, ConsoleOptions, RenderResult
from rich.table import Column, Table
from rich.text import Text

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
# No emoji: a play of a user's file is called "my_team.py:boom", and rich draws what ":boom:" names.
console = _Console(highlight=False, emoji=False)
errors = _Console(stderr=True, highlight=False, emoji=False)


class FittedTable(Table):
    """A table without lines that breaks its cells between words where the screen is too narrow for it.

    Where even words do not fit side by side, they are broken after ``_``, ``/`` and the like, and anywhere
    only where that is not enough either. Columns that are ``no_wrap`` stay whole as long as that is possible.

    Args:
        columns: the headings.
    """

    def __init__(self, *columns: str) -> None:
        super().__init__(*[Column(name, overflow="fold") for name in columns], **_NO_LINES)

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Yield the table with widths for its columns."""
        cells = [[_text(console, cell) for cell in (column.header, *column.cells)] for column in self.columns]
        room = options.max_width - _BETWEEN * (len(cells) - 1)
        widths = None
        for whole, kept in ((_LINE, _WORD), (_LINE, _PART), (_PART, _PART)):
            least = [
                max([_longest(text, whole if column.no_wrap else kept) for text in texts])
                for column, texts in zip(self.columns, cells, strict=True)
            ]
            if sum(least) <= room:
                most = [max([_longest(text, _LINE) for text in texts]) for texts in cells]
                widths = _shared_out(room, least, most)
                break
        given: Sequence[int | None] = widths or [None] * len(cells)
        columns = [
            Column(column.header, overflow="fold", width=width)
            for column, width in zip(self.columns, given, strict=True)
        ]
        if widths is not None:
            cells = [
                [_broken(text, width) for text in texts] for texts, width in zip(cells, widths, strict=True)
            ]
        fitted = Table(*columns, **_NO_LINES)
        for column, texts in zip(columns, cells, strict=True):
            column.header = texts[0]
        for row in zip(*[texts[1:] for texts in cells], strict=True):
            fitted.add_row(*row)
        yield from fitted.__rich_console__(console, options)


_BETWEEN = 2
_NO_LINES: dict[str, Any] = {"box": None, "padding": (0, _BETWEEN, 0, 0), "pad_edge": False}
_LINE, _WORD = re.compile(r"[^\n]+"), re.compile(r"\S+")
_PART = re.compile(r"(?:[^\s_:,/|=.]|\.(?![a-z]))*(?:[_:,/|=]|\.(?=[a-z]))*")
"""What stays on one line: all of a line, words, and parts of names. A number is not broken at its point."""


def _text(console: Console, cell: object) -> Text:
    return cell if isinstance(cell, Text) else console.render_str(str(cell))


def _longest(text: Text, pattern: re.Pattern[str]) -> int:
    return max(map(cell_len, pattern.findall(text.plain)), default=0)


def _shared_out(room: int, least: Sequence[int], most: Sequence[int]) -> list[int]:
    """Return widths between the least and the most; what is left goes first to columns that lack little."""
    widths, left = list(least), room - sum(least)
    order = sorted(range(len(widths)), key=lambda place: most[place] - least[place])
    for done, place in enumerate(order):
        more = min(most[place] - least[place], left // (len(order) - done))
        widths[place] += more
        left -= more
    return widths


def _broken(text: Text, width: int) -> Text:
    """Return a text with words that are wider than ``width`` broken between their parts."""
    breaks = []
    for word in _WORD.finditer(text.plain):
        reached = word.start()
        if cell_len(word[0]) <= width:
            continue
        for part in _PART.finditer(text.plain, word.start(), word.end()):
            if part.start() > reached and cell_len(text.plain[reached : part.end()]) > width:
                breaks.append(part.start())
                reached = part.start()
    return Text("\n").join(text.divide(breaks)) if breaks else text
