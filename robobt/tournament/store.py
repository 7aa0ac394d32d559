"""The store of a tournament: one SQLite file, one row a match, that several programs may write at once.

Tables: ``tournament`` (what is played: field, value), ``entrants`` (name, digest, source) and ``matches``,
one row a match by ``blue``, ``yellow`` and ``round``; ``definitions`` holds, as JSON, the scenario and the
entrants in full, from which matches are played again. Its other columns are the fields of
:class:`~robobt.tournament.played.PlayedMatch` and, behind ``blue_`` and ``yellow_``, those of its
sides. Rows are only ever added: triggers refuse all other changes. Two stores of one tournament hold the same
rows, except for ``wall_time`` and ``finished``, in any order of playing.
"""

from __future__ import annotations

import os
import sqlite3
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import fields
from pathlib import Path

from robobt.config.closing import Closing
from robobt.config.errors import RobobtError, one_line, short_repr
from robobt.tournament.entrants import Entrant
from robobt.tournament.fixtures import Fixture
from robobt.tournament.played import MATCH_COLUMNS, PLAIN, PlayedMatch, SideResult

TOURNAMENT_FORMAT = "robobt-tournament 1"

_LOCK_TIMEOUT = 60.0
"""Longest wait for another writer [s]."""

_LOCK_TRIES = 600
"""How often it is looked whether another program has let go in that time."""


class StoreError(RobobtError, ValueError):
    """A store cannot be used; the message is one line that names the file and the field."""

    def __init__(self, path: Path, problem: str, field: str = "") -> None:
        super().__init__(": ".join([one_line(part) for part in (str(path), field, problem) if part]))


_SQL_TYPES = {
    "int": "INTEGER NOT NULL",
    "float": "REAL NOT NULL",
    "str": "TEXT NOT NULL",
    "str | None": "TEXT",
}


def _kinds() -> Iterator[str]:
    kinds = {part.name: str(part.type) for part in (*fields(PlayedMatch), *fields(SideResult))}
    for name in MATCH_COLUMNS:
        plain = name if name in PLAIN else name.partition("_")[2]
        yield f"{name} {_SQL_TYPES[kinds[plain]]}"


_ADDED = "events"
"""The column that stores of earlier versions lack."""

_DEFINITIONS = "CREATE TABLE IF NOT EXISTS definitions (name TEXT PRIMARY KEY, value TEXT NOT NULL)"

_SCHEMA = f"""
CREATE TABLE tournament (field TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE entrants (name TEXT PRIMARY KEY, digest TEXT NOT NULL, source TEXT NOT NULL);
CREATE TABLE matches ({", ".join(_kinds())}, PRIMARY KEY (blue, yellow, round));
""" + "".join(
    f"CREATE TRIGGER no_{verb}_of_{table} BEFORE {verb} ON {table}\n"
    "BEGIN SELECT RAISE(ABORT, 'rows of a tournament are only ever added'); END;\n"
    for table in ("tournament", "entrants", "matches")
    for verb in ("update", "delete")
)


class MatchStore(Closing):
    """An open store. A context manager.

    Args:
        path: the file; created if missing and ``played`` is given. Without ``played`` a store in a read-only
            file or folder can be read.
        played: description of the tournament, by field; None opens any existing store.

    Attributes:
        played: what is played, by field.

    Raises:
        StoreError: the file is no store, or one of another tournament.
        OSError: it cannot be read.
    """

    def __init__(self, path: str | Path, played: Mapping[str, object] | None = None) -> None:
        self.path = Path(path)
        if self.path.exists() and not self.path.is_file():
            raise StoreError(self.path, "is not an ordinary file")
        if played is None and not self.path.exists():
            raise StoreError(self.path, "there is no such file")
        if not self.path.parent.is_dir():
            self.path.parent.mkdir(parents=True)
        self._read_only = played is None and not all(
            os.access(path, os.W_OK) for path in (self.path, self.path.parent)
        )
        with self._naming():
            self._connection = sqlite3.connect(
                self._uri(), timeout=_LOCK_TIMEOUT, isolation_level=None, uri=True
            )
            self._connection.row_factory = sqlite3.Row
        try:
            with self._naming():
                self._open(played)
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """Close the file."""
        self._connection.close()

    def enter(self, entrants: Iterable[Entrant]) -> None:
        """Add the entrants, and their definitions.

        Raises:
            StoreError: the store knows another team by that name.
        """
        with self._writing():
            for entrant in entrants:
                self._enter(entrant.name, entrant.digest(), entrant.source)
                self._define(f"entrant {entrant.name}", entrant.to_json())

    def define(self, name: str, value: str) -> None:
        """Keep a definition, as JSON, unless there is one of that name."""
        with self._writing():
            self._define(name, value)

    def definitions(self) -> dict[str, str]:
        """Return the definitions, as JSON, by their names: "scenario", and "entrant NAME" for each entrant.

        Stores of earlier versions have none.
        """
        there = self._all("SELECT name FROM sqlite_master WHERE name = 'definitions'")
        rows = self._all("SELECT * FROM definitions ORDER BY rowid") if there else []
        return {row["name"]: row["value"] for row in rows}

    def entrants(self) -> dict[str, str]:
        """Return the entrants' digests by name, in the order in which they were entered."""
        return {row["name"]: row["digest"] for row in self._all("SELECT * FROM entrants ORDER BY rowid")}

    def add(self, match: PlayedMatch) -> bool:
        """Add a match, unless it is there already; return whether it was added. It is on disk then."""
        with self._writing():
            return self._add([match]) == 1

    def match(self, fixture: Fixture) -> PlayedMatch | None:
        """Return a match, or None if it has not been played."""
        found = self._all("SELECT * FROM matches WHERE blue = ? AND yellow = ? AND round = ?", fixture)
        return PlayedMatch.of_row(dict(found[0])) if found else None

    def matches(self, names: Sequence[str] | None = None) -> list[PlayedMatch]:
        """Return the matches, in the order of rounds and names.

        Args:
            names: those among whom they were played; by default all.
        """
        rows = self._all("SELECT * FROM matches ORDER BY round, blue, yellow")
        played = [PlayedMatch.of_row(dict(row)) for row in rows]
        return [match for match in played if names is None or {match.blue, match.yellow} <= {*names}]

    def merge(self, other: MatchStore) -> int:
        """Copy the matches of another store for this tournament; return how many matches were new.

        Raises:
            StoreError: the other is of another tournament, knows another team by one of the names,
                or a match has gone another way there.
        """
        self._check(other.played, other.path)
        known = {match.fixture: match for match in self.matches()}
        new = []
        for match in other.matches():
            here = known.get(match.fixture)
            if here is None:
                new.append(match)
            elif here.course != match.course:
                raise StoreError(
                    other.path,
                    f"went another way than in {self.path}; was it played by other code?",
                    f"matches: {match.fixture}",
                )
        with self._writing():
            for row in other._all("SELECT * FROM entrants ORDER BY rowid"):
                self._enter(row["name"], row["digest"], row["source"])
            for name, value in other.definitions().items():
                self._define(name, value)
            return self._add(new)

    def _add(self, matches: Sequence[PlayedMatch]) -> int:
        before = self._connection.total_changes
        names = ", ".join(MATCH_COLUMNS)
        places = ", ".join([f":{name}" for name in MATCH_COLUMNS])
        # Not OR IGNORE, which would also pass over a row that is not whole.
        self._connection.executemany(
            f"INSERT INTO matches ({names}) VALUES ({places}) ON CONFLICT (blue, yellow, round) DO NOTHING",
            [match.row() for match in matches],
        )
        return self._connection.total_changes - before

    def _enter(self, name: str, digest: str, source: str) -> None:
        there = self._connection.execute("SELECT digest FROM entrants WHERE name = ?", [name]).fetchone()
        if there is None:
            self._connection.execute("INSERT INTO entrants VALUES (?, ?, ?)", [name, digest, source])
        elif there[0] != digest:
            raise StoreError(
                self.path,
                "is another team in this store; rename the entrant, or use another file",
                f"entrants: {short_repr(name)}",
            )

    def _define(self, name: str, value: str) -> None:
        self._connection.execute(_DEFINITIONS)
        self._connection.execute(
            "INSERT INTO definitions VALUES (?, ?) ON CONFLICT (name) DO NOTHING", [name, value]
        )

    def _open(self, played: Mapping[str, object] | None) -> None:
        # Nothing is lost when this process is killed; a machine that loses power loses the last rows at most.
        # Waiting for the disk after each row would cost more than the rest of the driver.
        for tries in range(_LOCK_TRIES):
            try:
                # Looked at before: another program's database stays as it is, down to its journal.
                self._is_new(played)
                if not self._read_only:
                    self._connection.execute("PRAGMA journal_mode = WAL")
                break
            except sqlite3.OperationalError:
                # Another program is making the same change, for which SQLite does not wait by itself.
                if self._read_only or tries == _LOCK_TRIES - 1:
                    raise
                time.sleep(_LOCK_TIMEOUT / _LOCK_TRIES)
        self._connection.execute("PRAGMA synchronous = NORMAL")
        with self._naming() if self._read_only else self._writing():
            if played is not None and self._is_new(played):
                for statement in filter(str.strip, _SCHEMA.split(";\n")):
                    self._connection.execute(f"{statement};")
                says = {"format": TOURNAMENT_FORMAT, **{name: str(value) for name, value in played.items()}}
                self._connection.executemany("INSERT INTO tournament VALUES (?, ?)", says.items())
            held = self._connection.execute("SELECT field, value FROM tournament ORDER BY rowid")
            self.played = {row[0]: row[1] for row in held}
            columns = {row["name"] for row in self._connection.execute("PRAGMA table_info(matches)")}
            if {*MATCH_COLUMNS} - columns == {_ADDED}:
                if not self._read_only:
                    self._connection.execute(
                        f"ALTER TABLE matches ADD COLUMN {_ADDED} TEXT NOT NULL DEFAULT ''"
                    )
                columns.add(_ADDED)
        if self.played.get("format") != TOURNAMENT_FORMAT:
            raise StoreError(
                self.path, f"is {self.played.get('format')!r}, not {TOURNAMENT_FORMAT!r}", "format"
            )
        if played is not None:
            self._check({name: str(value) for name, value in played.items()}, None)
        if other := columns ^ {*MATCH_COLUMNS}:
            missing, unknown = sorted(other - columns), sorted(other & columns)
            what = f"lacks {', '.join(missing)}" if missing else f"has {', '.join(unknown)} besides"
            raise StoreError(self.path, f"{what}; read it with the version of robobt that made it", "matches")

    def _uri(self) -> str:
        """Return how SQLite is to open it: where nothing can be written there is no place for its locks."""
        uri = self.path.absolute().as_uri()
        if not self._read_only:
            return uri
        # Unless its writer has left something beside it, which has to be read too.
        beside = self.path.with_name(f"{self.path.name}-wal").exists()
        return f"{uri}?mode=ro" if beside else f"{uri}?mode=ro&immutable=1"

    def _is_new(self, played: Mapping[str, object] | None) -> bool:
        """Return whether there is nothing in the file yet, and it may be made a store."""
        tables = {row[0] for row in self._connection.execute("SELECT name FROM sqlite_master")}
        new = not tables and played is not None
        if not new and not {"tournament", "entrants", "matches"} <= tables:
            raise StoreError(self.path, "is no store of a tournament; give another name")
        return new

    def _check(self, played: Mapping[str, str], other: Path | None) -> None:
        for name, value in played.items():
            held = self.played.get(name)
            if held != value:
                what = f"the store holds a tournament of {short_repr(held)}, not of {short_repr(value)}"
                if held is None:
                    what = "the store says nothing of that, it is another command's"
                elif name == "digest":
                    what = "the store holds a tournament of another version of the scenario"
                raise StoreError(
                    self.path, f"{what}{f' as {other}' if other else ''}; give another file", name
                )

    def _all(self, statement: str, values: Sequence[object] = ()) -> list[sqlite3.Row]:
        with self._naming():
            return self._connection.execute(statement, values).fetchall()

    @contextmanager
    def _writing(self) -> Iterator[None]:
        """Write in one transaction, begun as a writer's: two begun as readers would block each other."""
        with self._naming():
            self._connection.execute("BEGIN IMMEDIATE")
            try:
                yield
            except BaseException:
                with suppress(sqlite3.Error):
                    self._connection.execute("ROLLBACK")
                raise
            self._connection.execute("COMMIT")

    @contextmanager
    def _naming(self) -> Iterator[None]:
        try:
            yield
        except sqlite3.Error as error:
            raise StoreError(self.path, f"cannot be used: {error}") from error
