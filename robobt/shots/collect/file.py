"""A collection of shots on disk while it grows: a row is there as soon as its shot is over.

Rows are appended to a CSV file, the last of which may be cut short by a kill and
is then dropped. Beside it lies a description: what was asked for, and what each
column means. Once all shots are there they are put in order and written to the
file asked for, whole or not at all.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import TextIO

import pyarrow as pa

from robobt import __version__
from robobt.config.atomic import write_atomically
from robobt.config.only_writer import OnlyWriter
from robobt.shots.collect.plan import CollectionSettings
from robobt.shots.data.files import csv_text, read_shots, write_shots
from robobt.shots.data.schema import SCHEMA, SHOT_COLUMNS, SHOTS_VERSION, Row, ShotDataError

SHOTS_FORMAT = "robobt-shots"


class CollectionFile:
    """A file of shots that can be taken up again. A context manager.

    ``shots.csv`` grows itself; ``shots.parquet`` is written at the end and grows as
    ``shots.parquet.csv``. ``shots.csv.json`` describes either.

    Args:
        out: the file, ``.csv`` or ``.parquet``.
        settings: of the collection.

    Attributes:
        rows: shots there already.
        complete: whether they are all that was asked for the last time.

    Raises:
        ShotDataError: the file holds something else, or another run is writing it.
        OSError: it cannot be read or written.
    """

    def __init__(self, out: str | Path, settings: CollectionSettings) -> None:
        self.out = Path(out)
        if self.out.suffix not in {".csv", ".parquet"}:
            raise ShotDataError(f"{self.out}: shots are written to .csv or .parquet")
        self._settings = settings
        self.description = self.out.with_name(self.out.name + ".json")
        self.growing = self.out if self.out.suffix == ".csv" else self.out.with_name(self.out.name + ".csv")
        self.out.parent.mkdir(parents=True, exist_ok=True)
        self._lock = OnlyWriter(self.out, ShotDataError)
        try:
            self.complete = self._known()
            self.rows = self._read()
            self._file = None if self.complete else self._open()
        except BaseException:
            self._lock.close()
            raise

    def __enter__(self) -> CollectionFile:
        return self

    def __exit__(self, *_: object) -> None:
        with self._lock:
            self._close()

    def _close(self) -> None:
        if self._file is not None:
            self._file.close()
            self._file = None

    def add(self, row: Row) -> None:
        """Append a shot; it is on disk when this returns."""
        if self._file is None:
            # All that was asked for before was there, and more is asked for now.
            self._file = self._open()
        self._file.write(csv_text([row], header=False))
        self._file.flush()

    def finish(self, rows: list[Row]) -> None:
        """Write these rows, in their order, as the whole collection."""
        self._close()
        write_shots(pa.Table.from_pylist(rows, schema=SCHEMA), self.out)
        if self.growing != self.out:
            self.growing.unlink(missing_ok=True)
        self.complete = True
        self._describe()

    def _known(self) -> bool:
        """Return whether the file holds all that was asked for; raise when it holds something else."""
        if not self.description.exists():
            for file in {self.out, self.growing}:
                if file.exists():
                    raise ShotDataError(f"{file}: exists already without its {self.description.name}")
            return False
        try:
            found = json.loads(self.description.read_text(encoding="utf-8"))
        except ValueError as error:
            raise ShotDataError(f"{self.description}: {error}") from error
        if not isinstance(found, dict) or found.get("format") != SHOTS_FORMAT:
            raise ShotDataError(f"{self.description}: not the description of a collection of shots")
        wanted: dict[str, object] = {"robobt": __version__, "schema_version": SHOTS_VERSION}
        for key, value in {**wanted, **self._settings.model_dump()}.items():
            there = found.get(key, found.get("settings", {}).get(key))
            if there != value:
                raise ShotDataError(
                    f"{self.description}: holds shots with {key} {there!r}, not {value!r}; give another name"
                )
        return found.get("complete") is True and self.out.exists()

    def _read(self) -> list[Row]:
        if self.complete:
            rows: list[Row] = read_shots(self.out).to_pylist()
            return rows
        if not self.growing.exists():
            return []
        sound = self.growing.read_bytes()
        kept = sound.rfind(b"\n") + 1
        if kept < len(sound):
            with self.growing.open("r+b") as file:
                file.truncate(kept)
        if sound[:kept].count(b"\n") <= 1:
            return []
        grown: list[Row] = read_shots(self.growing).to_pylist()
        return grown

    def _open(self) -> TextIO:
        self.complete = False
        self._describe()
        if self.rows and not self.growing.exists():
            write_shots(pa.Table.from_pylist(self.rows, schema=SCHEMA), self.growing)
        fresh = not self.growing.exists() or self.growing.stat().st_size == 0
        file = self.growing.open("a", encoding="utf-8", newline="")
        if fresh:
            file.write(csv_text([]))
            file.flush()
        return file

    def _describe(self) -> None:
        text = json.dumps(
            {
                "format": SHOTS_FORMAT,
                "robobt": __version__,
                "schema_version": SHOTS_VERSION,
                "complete": self.complete,
                "settings": self._settings.model_dump(),
                "columns": [column._asdict() for column in SHOT_COLUMNS],
            },
            indent=1,
        )
        write_atomically(self.description, text + "\n")
