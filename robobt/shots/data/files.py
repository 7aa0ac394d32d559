"""Shots in files: Parquet and CSV in this package's table, and the author's CSV."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc
import pyarrow.parquet as pq

from robobt.config.atomic import replacing
from robobt.shots.data.author_data import author_table
from robobt.shots.data.cells import Cells, Problems, read_cells, refuse
from robobt.shots.data.schema import (
    LATER_COLUMNS,
    SCHEMA,
    SHOT_COLUMNS,
    SHOTS_VERSION,
    UNKNOWN,
    Row,
    ShotDataError,
)

_SEPARATOR = ";"
"""Between the numbers of a list in a cell of a CSV file."""


@dataclass(frozen=True)
class ReadShots:
    """Shots of a file of which some may be wrong.

    Attributes:
        file: the file.
        table: the shots that can be used, in :data:`SCHEMA`.
        rows: the row of each (a spreadsheet's: the header is row 1).
        problems: what is wrong with the others, by row.
    """

    file: Path
    table: pa.Table
    rows: list[int]
    problems: Problems

    def without(self, lacking: Mapping[int, str]) -> ReadShots:
        """Leave further shots out, each with the reason, by their places in the table."""
        kept = [i for i in range(len(self.rows)) if i not in lacking]
        more = {self.rows[i]: f"row {self.rows[i]}: {reason}" for i, reason in lacking.items()}
        problems = dict(sorted({**more, **self.problems}.items()))
        if not kept and problems:
            first = next(iter(problems.values()))
            raise ShotDataError(f"{self.file}: none of its {len(problems)} shots can be used; {first}")
        return ReadShots(self.file, self.table.take(kept), [self.rows[i] for i in kept], problems)


def read_shots(path: str | Path) -> pa.Table:
    """Read the shots of the file ``path`` into the package's table (:data:`SCHEMA`, SI units).

    A ``.parquet`` file and a CSV file with a column ``schema_version`` hold that
    table. Any other CSV file is read as the author's (:mod:`.author_data`):
    millimetres, success as 1 and 0 or YES and NO.

    Raises:
        ShotDataError: the file cannot be read, or a cell is wrong; the message
            names the file, the row (a spreadsheet's: the header is row 1) and the column.
    """
    return _read(Path(path), None).table


def read_usable_shots(path: str | Path) -> ReadShots:
    """Read the shots of a file as :func:`read_shots` does, and leave out those with something wrong.

    Raises:
        ShotDataError: the file cannot be read, lacks a column, or holds no shot that can be used.
    """
    problems: Problems = {}
    found = _read(Path(path), problems)
    return found.without({i: "" for i, row in enumerate(found.rows) if row in problems})


def _read(file: Path, problems: Problems | None) -> ReadShots:
    try:
        if file.suffix == ".parquet":
            read = pq.read_table(file)
            rows = list(range(2, 2 + read.num_rows))
            table = _checked(read, file, rows, problems)
        else:
            cells = read_cells(file, problems)
            rows = cells.rows
            own = "schema_version" in cells.columns
            table = _checked(_own_table(cells), file, rows, problems) if own else author_table(cells)
    except (OSError, UnicodeDecodeError, csv.Error, pa.ArrowException) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        if isinstance(error, FileNotFoundError):
            # pyarrow's message is the path alone.
            reason = "No such file or directory"
        raise ShotDataError(f"{file}: {' '.join(reason.split())}") from error
    if table.num_rows == 0 and not problems:
        raise ShotDataError(f"{file}: holds no shots")
    return ReadShots(file, table, rows, problems or {})


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
        if name not in cells.columns and name not in LATER_COLUMNS:
            raise ShotDataError(f"{cells.file}: has no column {name!r}")
    values = {
        column.name: cells.convert(column.name, _PARSERS[column.type], UNKNOWN[column.type])
        if column.name in cells.columns
        else [UNKNOWN[column.type]] * len(cells.rows)
        for column in SHOT_COLUMNS
    }
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


_PLACES = ("robot_x", "robot_y", "ball_x", "ball_y", "target_x", "target_y", "distance_to_goal")
_ANGLES = ("robot_heading", "angle_to_goal")
_PLACE_LIMIT = 30.0
"""Farther than anything on the largest field; in other units shots are [m]."""


def _within(table: pa.Table, name: str, most: float) -> pa.ChunkedArray:
    """Return which values of a column are at most this large; a value that is not known is."""
    column = table.column(name)
    return pc.fill_null(pc.or_(pc.is_nan(column), pc.less_equal(pc.abs(column), most)), True)


def _checked(table: pa.Table, file: Path, rows: list[int], problems: Problems | None) -> pa.Table:
    """Return a table in :data:`SCHEMA`, its columns in order, after a look at what must not be missing."""
    for column in SHOT_COLUMNS:
        if column.name in LATER_COLUMNS and column.name not in table.schema.names:
            unknown = pa.array([UNKNOWN[column.type]] * len(table), SCHEMA.field(column.name).type)
            table = table.append_column(column.name, unknown)
        if column.name not in table.schema.names:
            raise ShotDataError(f"{file}: has no column {column.name!r}")
        try:
            table.column(column.name).cast(SCHEMA.field(column.name).type)
        except pa.ArrowException as error:
            raise ShotDataError(f"{file}: column {column.name!r} holds no {column.type}") from error
    table = table.select(SCHEMA.names).cast(SCHEMA)
    success, distance = table.column("success"), table.column("distance_to_goal")
    for name, right, problem in (
        (
            "schema_version",
            pc.equal(table.column("schema_version"), SHOTS_VERSION),
            f"is not version {SHOTS_VERSION}",
        ),
        ("success", pc.is_in(success, pa.array([0, 1])), "is neither 1 nor 0"),
        ("distance_to_goal", pc.and_(pc.greater(distance, 0.0), pc.is_finite(distance)), "is not a distance"),
        *[
            (name, _within(table, name, _PLACE_LIMIT), "is no place on a field, in metres")
            for name in _PLACES
        ],
        *[(name, _within(table, name, math.tau), "is no angle, in radians") for name in _ANGLES],
    ):
        for i in np.flatnonzero(~pc.fill_null(right, False).to_numpy()):
            value = table.column(name)[int(i)].as_py()
            refuse(file, rows[i], f", column {name!r}: {value} {problem}", problems)
    return table
