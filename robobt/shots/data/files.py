"""Shots in files: Parquet and CSV in this package's table, and the author's CSV."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Callable, Iterable
from pathlib import Path

import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from robobt.config.atomic import replacing
from robobt.shots.data.author_data import author_table
from robobt.shots.data.cells import Cells, read_cells
from robobt.shots.data.problems import ShotDataError
from robobt.shots.data.schema import COLUMNS, SCHEMA, UNKNOWN, VERSION, Row

_SEPARATOR = ";"
"""Between the numbers of a list in a cell of a CSV file."""


def read_shots(path: str | Path) -> pa.Table:
    """Read the shots of the file ``path`` into the package's table (:data:`SCHEMA`, SI units).

    A ``.parquet`` file and a CSV file with a column ``schema_version`` hold that
    table. Any other CSV file is read as the author's (:mod:`.author_data`):
    millimetres, success as 1 and 0 or YES and NO.

    Raises:
        ShotDataError: the file cannot be read, or a cell is wrong; the message
            names the file, the row (a spreadsheet's: the header is row 1) and the column.
    """
    file = Path(path)
    try:
        if file.suffix == ".parquet":
            table = _checked(pq.read_table(file), file)
        else:
            cells = read_cells(file)
            own = "schema_version" in cells.columns
            table = _checked(_own_table(cells), file, cells.rows) if own else author_table(cells)
    except (OSError, UnicodeDecodeError, csv.Error, pa.ArrowException) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise ShotDataError(f"{file}: {' '.join(reason.split())}") from error
    if table.num_rows == 0:
        raise ShotDataError(f"{file}: holds no shots")
    return table


def write_shots(table: pa.Table, path: str | Path) -> None:
    """Write shots to ``path``, a ``.parquet`` or ``.csv`` file, whole or not at all.

    Raises:
        ValueError: another ending, or a table with other columns than :data:`SCHEMA`.
    """
    file = Path(path)
    if table.schema.names != SCHEMA.names:
        raise ValueError("the table's columns are not those of SCHEMA")
    if file.suffix not in {".parquet", ".csv"}:
        raise ValueError(f"{file}: shots are written to .parquet or .csv")
    file.parent.mkdir(parents=True, exist_ok=True)
    with replacing(file) as draft:
        if file.suffix == ".parquet":
            pq.write_table(table, draft, compression="zstd")
        else:
            draft.write_text(csv_text(table.to_pylist()), encoding="utf-8")


def csv_text(rows: Iterable[Row], header: bool = True) -> str:
    """Return rows of the table as lines of a CSV file; what is unknown is an empty cell."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    if header:
        writer.writerow(SCHEMA.names)
    writer.writerows([_cell(row[name]) for name in SCHEMA.names] for row in rows)
    return out.getvalue()


def _cell(value: object) -> str:
    if isinstance(value, list | tuple):
        return _SEPARATOR.join(repr(float(entry)) for entry in value)
    if isinstance(value, float):
        return "" if math.isnan(value) else repr(float(value))
    return str(value)


def _own_table(cells: Cells) -> pa.Table:
    for name in SCHEMA.names:
        if name not in cells.columns:
            raise ShotDataError(f"{cells.file}: has no column {name!r}")
    values = {column.name: cells.convert(column.name, _PARSERS[column.type]) for column in COLUMNS}
    return pa.Table.from_pydict(values, SCHEMA)


def _integer(cell: str) -> int:
    try:
        return int(cell) if cell else int(UNKNOWN["int"])
    except ValueError:
        raise ValueError(f"{cell!r} is not a whole number") from None


def _real(cell: str) -> float:
    try:
        return float(cell) if cell else math.nan
    except ValueError:
        raise ValueError(f"{cell!r} is not a number") from None


def _reals(cell: str) -> list[float]:
    try:
        return [float(entry) for entry in cell.split(_SEPARATOR)] if cell else []
    except ValueError:
        raise ValueError(f"{cell!r} is not a list of numbers") from None


_PARSERS: dict[str, Callable[[str], object]] = {"text": str, "int": _integer, "real": _real, "reals": _reals}


def _checked(table: pa.Table, file: Path, rows: list[int] | None = None) -> pa.Table:
    """Return a table in :data:`SCHEMA`, its columns in order, after a look at what must not be missing."""
    for column in COLUMNS:
        if column.name not in table.schema.names:
            raise ShotDataError(f"{file}: has no column {column.name!r}")
        try:
            table.column(column.name).cast(SCHEMA.field(column.name).type)
        except pa.ArrowException as error:
            raise ShotDataError(f"{file}: column {column.name!r} holds no {column.type}") from error
    table = table.select(SCHEMA.names).cast(SCHEMA)
    success, distance = table.column("success"), table.column("distance_to_goal")
    for name, right, problem in (
        ("schema_version", pc.equal(table.column("schema_version"), VERSION), f"is not version {VERSION}"),
        ("success", pc.is_in(success, pa.array([0, 1])), "is neither 1 nor 0"),
        ("distance_to_goal", pc.and_(pc.greater(distance, 0.0), pc.is_finite(distance)), "is not a distance"),
    ):
        row = pc.index(pc.fill_null(right, False), False).as_py()
        if row >= 0:
            number, value = rows[row] if rows else row + 2, table.column(name)[row].as_py()
            raise ShotDataError(f"{file}: row {number}, column {name!r}: {value} {problem}")
    return table
