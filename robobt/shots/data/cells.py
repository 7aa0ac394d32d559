"""CSV files as text by column, with errors that name file, row and column."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

from robobt.shots.data.schema import ShotDataError

T = TypeVar("T")


Problems = dict[int, str]
"""What is wrong with rows of a file, by the row's number in a spreadsheet (the header is row 1)."""


def refuse(file: Path, row: int, problem: str, problems: Problems | None) -> None:
    """Note what is wrong with a row, or raise where ``problems`` is None.

    Raises:
        ShotDataError: the message names file and row.
    """
    if problems is None:
        raise ShotDataError(f"{file}: row {row}{problem}")
    problems.setdefault(row, f"row {row}{problem}")


@dataclass(frozen=True)
class Cells:
    """The cells of a CSV file.

    ``rows`` tells the row of a spreadsheet that each is in, ``columns`` has the cells of each column by its
    title. ``problems`` takes what is wrong with rows; with None that is an error.
    """

    file: Path
    rows: list[int]
    columns: dict[str, list[str]]
    problems: Problems | None = None

    def convert(self, title: str, parse: Callable[[str], T], otherwise: T) -> list[T]:
        """Return the values of a column.

        ``parse`` makes a value of a cell; a ValueError says what is wrong with it, and ``otherwise`` takes
        the cell's place.
        """
        values = []
        for row, cell in zip(self.rows, self.columns[title], strict=True):
            try:
                values.append(parse(cell))
            except ValueError as error:
                refuse(self.file, row, f", column {title!r}: {error}", self.problems)
                values.append(otherwise)
        return values


def read_cells(file: Path, problems: Problems | None = None) -> Cells:
    """Read a CSV file with commas, semicolons or tabs between its cells.

    Args:
        file: the file.
        problems: takes what is wrong with rows, which are left out; with None that is an error.

    Raises:
        ShotDataError: it has no header, a column twice or rows of different length.
        OSError, UnicodeDecodeError, csv.Error: it cannot be read.
    """
    text = file.read_text(encoding="utf-8-sig", errors="strict" if problems is None else "replace")
    separator = max(",;\t", key=text.partition("\n")[0].count)
    reader = csv.reader(io.StringIO(text), delimiter=separator, strict=True)
    header = [title.strip() for title in next(reader, [])]
    if not any(header):
        raise ShotDataError(f"{file}: is empty")
    for title in header:
        if header.count(title) > 1:
            raise ShotDataError(f"{file}: has column {title!r} twice")
    rows, lines = [], []
    for row, cells in _rows(reader, file, problems):
        if not any(cell.strip() for cell in cells):
            continue
        if len(cells) != len(header):
            refuse(file, row, f" has {len(cells)} cells, the header {len(header)}", problems)
            continue
        rows.append(row)
        lines.append([cell.strip() for cell in cells])
    columns = {title: [cells[i] for cells in lines] for i, title in enumerate(header)}
    return Cells(file, rows, columns, problems)


def _rows(reader: Any, file: Path, problems: Problems | None) -> Iterator[tuple[int, list[str]]]:
    """Yield the number and the cells of each row that can be read."""
    while True:
        first = reader.line_num + 1
        try:
            cells = next(reader)
        except StopIteration:
            return
        except csv.Error as error:
            # A quote that is not closed takes all that follows with it.
            for row in range(first, reader.line_num + 1):
                refuse(file, row, f": {error}", problems)
            continue
        yield reader.line_num, cells
