"""Shots in files: Parquet and CSV in this package's table, and the author's CSV."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.csv
import pyarrow.parquet as pq

from robobt.shots.data.author_data import author_columns, author_row
from robobt.shots.data.problems import ShotDataError
from robobt.shots.data.schema import COLUMNS, SCHEMA, UNKNOWN, VERSION, Column

LIST_SEPARATOR = ";"
"""Between the numbers of a list in a cell of a CSV file."""

_VERSION_COLUMN = "schema_version"
_Rows = Iterator[tuple[int, list[str]]]


def read_shots(path: str | Path) -> pa.Table:
    """Shots of a file in the package's table (:data:`SCHEMA`, SI units).

    A ``.parquet`` file and a CSV file with a column ``schema_version`` hold that
    table. Any other CSV file is read as the author's (:mod:`.author_data`):
    millimetres, success as 1 and 0 or YES and NO.

    Raises:
        ShotDataError: the file cannot be read, or a cell is wrong; the message
            names the file, the row (a spreadsheet's: the header is row 1) and the column.
    """
    file = Path(path)
    try:
        table = _read_parquet(file) if file.suffix == ".parquet" else _read_csv(file)
    except (OSError, UnicodeDecodeError, csv.Error, pa.ArrowException) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise ShotDataError(f"{file}: {' '.join(reason.split())}") from error
    if table.num_rows == 0:
        raise ShotDataError(f"{file}: holds no shots")
    return table


def write_shots(table: pa.Table, path: str | Path) -> None:
    """Write shots to a ``.parquet`` or ``.csv`` file, whole or not at all.

    Raises:
        ValueError: another ending, or a table with other columns than :data:`SCHEMA`.
    """
    file = Path(path)
    if table.schema.names != SCHEMA.names:
        raise ValueError("the table's columns are not those of SCHEMA")
    if file.suffix not in {".parquet", ".csv"}:
        raise ValueError(f"{file}: shots are written to .parquet or .csv")
    file.parent.mkdir(parents=True, exist_ok=True)
    draft = file.with_name(f".{file.name}.part")
    try:
        if file.suffix == ".parquet":
            pq.write_table(table, draft, compression="zstd")
        else:
            draft.write_text(csv_text(table.to_pylist()), encoding="utf-8")
        draft.replace(file)
    finally:
        draft.unlink(missing_ok=True)


def csv_text(rows: list[dict[str, Any]], header: bool = True) -> str:
    """Rows of the table as lines of a CSV file; what is unknown is an empty cell."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    if header:
        writer.writerow(column.name for column in COLUMNS)
    for row in rows:
        writer.writerow(_cell(column, row[column.name]) for column in COLUMNS)
    return out.getvalue()


def _cell(column: Column, value: Any) -> str:
    if column.type == "reals":
        return LIST_SEPARATOR.join(repr(float(entry)) for entry in value)
    if column.type == "real":
        return "" if math.isnan(value) else repr(float(value))
    return str(value)


def _read_parquet(file: Path) -> pa.Table:
    table = pq.read_table(file)
    for column in COLUMNS:
        if column.name not in table.schema.names:
            raise ShotDataError(f"{file}: has no column {column.name!r}")
        try:
            table.column(column.name).cast(SCHEMA.field(column.name).type)
        except pa.ArrowException as error:
            raise ShotDataError(f"{file}: column {column.name!r} holds no {column.type}") from error
    table = table.select(SCHEMA.names).cast(SCHEMA)
    for name in ("schema_version", "success", "distance_to_goal"):
        column = _BY_NAME[name]
        for row, value in enumerate(table.column(name).to_pylist(), start=2):
            _check(column, value, f"{file}: row {row}, column {name!r}")
    return table


def _read_csv(file: Path) -> pa.Table:
    with file.open(encoding="utf-8-sig", newline="") as lines:
        text = lines.read()
    header_line = text.partition("\n")[0]
    separator = max(",;\t", key=header_line.count)
    reader = csv.reader(io.StringIO(text), delimiter=separator, strict=True)
    header = [name.strip() for name in next(reader, [])]
    if not any(header):
        raise ShotDataError(f"{file}: is empty")
    if len(set(header)) < len(header):
        twice = next(name for name in header if header.count(name) > 1)
        raise ShotDataError(f"{file}: column {twice!r} is there twice")
    cells = _rows(file, reader, header)
    rows = _own_rows(file, header, cells) if _VERSION_COLUMN in header else _author_rows(file, header, cells)
    return pa.Table.from_pylist(rows, schema=SCHEMA)


def _rows(file: Path, reader: Any, header: list[str]) -> _Rows:
    for cells in reader:
        if not any(cell.strip() for cell in cells):
            continue
        if len(cells) != len(header):
            raise ShotDataError(
                f"{file}: row {reader.line_num} has {len(cells)} cells, the header {len(header)}"
            )
        yield reader.line_num, cells


def _author_rows(file: Path, header: list[str], rows: _Rows) -> list[dict[str, Any]]:
    columns = author_columns(file, header)
    return [author_row(file, number, columns, cells) for number, cells in rows]


def _own_rows(file: Path, header: list[str], rows: _Rows) -> list[dict[str, Any]]:
    for column in COLUMNS:
        if column.name not in header:
            raise ShotDataError(f"{file}: has no column {column.name!r}")
    places = [(column, header.index(column.name)) for column in COLUMNS]
    return [
        {
            column.name: _value(column, cells[place].strip(), f"{file}: row {number}, column {column.name!r}")
            for column, place in places
        }
        for number, cells in rows
    ]


def _value(column: Column, text: str, where: str) -> Any:
    try:
        if column.type == "text":
            return text
        if column.type == "reals":
            return [float(entry) for entry in text.split(LIST_SEPARATOR)] if text else []
        kind = int if column.type == "int" else float
        value = kind(text) if text else UNKNOWN[column.type]
    except ValueError:
        raise ShotDataError(f"{where}: {text!r} is no {_WORDS[column.type]}") from None
    _check(column, value, where)
    return value


def _check(column: Column, value: Any, where: str) -> None:
    if column.name == "schema_version" and value != VERSION:
        raise ShotDataError(f"{where}: version {value} of the table is not the version {VERSION} known here")
    if column.name == "success" and value not in (0, 1):
        raise ShotDataError(f"{where}: {value} is neither 1 nor 0")
    if column.name == "distance_to_goal" and not (value is not None and 0.0 < value < math.inf):
        raise ShotDataError(f"{where}: {value} is no distance")


_WORDS = {"int": "whole number", "real": "number", "reals": "list of numbers"}
_BY_NAME = {column.name: column for column in COLUMNS}
