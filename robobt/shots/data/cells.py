"""CSV files as text by column, with errors that name file, row and column."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

from robobt.shots.data.problems import ShotDataError

T = TypeVar("T")


@dataclass(frozen=True)
class Cells:
    """The cells of a CSV file.

    ``rows`` tells the row of a spreadsheet that each is in (the header is row 1), ``columns`` has the cells
    of each column by its title.
    """

    file: Path
    rows: list[int]
    columns: dict[str, list[str]]

    def convert(self, title: str, parse: Callable[[str], T]) -> list[T]:
        """Return the values of a column.

        ``parse`` makes a value of a cell; a ValueError says what is wrong with it.
        """
        values = []
        for row, cell in zip(self.rows, self.columns[title], strict=True):
            try:
                values.append(parse(cell))
            except ValueError as error:
                raise ShotDataError(f"{self.file}: row {row}, column {title!r}: {error}") from None
        return values


def read_cells(file: Path) -> Cells:
    """Read a CSV file with commas, semicolons or tabs between its cells.

    Raises:
        ShotDataError: it has no header, a column twice or rows of different length.
        OSError, UnicodeDecodeError, csv.Error: it cannot be read.
    """
    text = file.read_text(encoding="utf-8-sig")
    separator = max(",;\t", key=text.partition("\n")[0].count)
    reader = csv.reader(io.StringIO(text), delimiter=separator, strict=True)
    header = [title.strip() for title in next(reader, [])]
    if not any(header):
        raise ShotDataError(f"{file}: is empty")
    for title in header:
        if header.count(title) > 1:
            raise ShotDataError(f"{file}: has column {title!r} twice")
    rows, lines = [], []
    for cells in reader:
        if not any(cell.strip() for cell in cells):
            continue
        if len(cells) != len(header):
            raise ShotDataError(
                f"{file}: row {reader.line_num} has {len(cells)} cells, the header {len(header)}"
            )
        rows.append(reader.line_num)
        lines.append([cell.strip() for cell in cells])
    return Cells(file, rows, {title: [cells[i] for cells in lines] for i, title in enumerate(header)})
