"""Results on disk: one line per trial, appended when it finishes, so that a run can be continued.

The first line describes the run; the others are :meth:`MatchResult.to_json`.
"""

from __future__ import annotations

import hashlib
import json
import logging
from pathlib import Path
from typing import Generic, Protocol, TextIO, TypeVar

from pydantic import TypeAdapter

from robobt import __version__
from robobt.config.atomic import write_atomically
from robobt.config.closing import Closing
from robobt.config.errors import RobobtError, naming
from robobt.config.only_writer import OnlyWriter
from robobt.match.results.results import MatchResult, result_from
from robobt.match.scenario.scenario import Scenario
from robobt.plays.files import contents_of

RESULTS_FORMAT = "robobt-results"

_log = logging.getLogger(__name__)


class ResultsFileError(RobobtError, ValueError):
    """A results file cannot be continued; the message is one line that names it."""


class TrialResult(Protocol):
    """One trial's result: a dataclass of plain data."""

    @property
    def trial(self) -> int:
        """Number of the trial, from 0."""

    def to_json(self) -> dict[str, object]:
        """Return plain data; the keys are the attributes' names."""


R = TypeVar("R", bound=TrialResult)


class TrialsFile(Closing, Generic[R]):
    """A file of results of one kind that is open for appending. A context manager.

    A file that exists is continued when it holds the same scenario, seed, world, referee and
    version; damaged lines are dropped, and their trials played again.

    Args:
        kind: class of the results.
        path: the file.
        scenario: the scenario that is played.
        seed: seed of the run.
        world: address of the world; None for the built-in simulator.
        referee: name of the referee; None for the scenario's own.

    Attributes:
        done: results that the file already held, by trial.

    Raises:
        ResultsFileError: the file holds results of another run or other data, or another run is writing it.
        OSError: it cannot be read or written.
    """

    def __init__(
        self,
        kind: type[R],
        path: str | Path,
        scenario: Scenario,
        seed: int,
        world: str | None = None,
        referee: str | None = None,
    ) -> None:
        self.path = Path(path)
        self.done: dict[int, R] = {}
        self._kind = TypeAdapter(kind)
        head: dict[str, object] = {
            "format": RESULTS_FORMAT,
            "scenario": scenario.name,
            "digest": scenario_digest(scenario),
            "seed": seed,
            "robobt": __version__,
        }
        if world is not None:
            head["world"] = world
        if referee is not None:
            head["referee"] = referee
        self.path.parent.mkdir(parents=True, exist_ok=True)
        # Reading a pipe or a device would never end.
        if self.path.exists() and not (self.path.is_file() or self.path.is_dir()):
            raise ResultsFileError(f"{self.path}: not an ordinary file, so it holds nothing to go on from")
        self._lock = OnlyWriter(self.path, ResultsFileError)
        try:
            kept = self._read(head) if self.path.exists() else 0
            if kept:
                with self.path.open("r+b") as file:
                    file.truncate(kept)
            self._file: TextIO = self.path.open("a" if kept else "w", encoding="utf-8")
        except BaseException:
            self._lock.close()
            raise
        if not kept:
            try:
                self._write(head)
            except OSError:
                self.close()
                raise

    def close(self) -> None:
        """Close the file."""
        with self._lock, naming(self.path):
            self._file.close()

    def add(self, result: R) -> None:
        """Append a result, flushed to disk."""
        self._write(result.to_json())

    def _write(self, line: dict[str, object]) -> None:
        with naming(self.path):
            self._file.write(json.dumps(line, separators=(",", ":")) + "\n")
            self._file.flush()

    def _read(self, head: dict[str, object]) -> int:
        """Read the results in the file and return the size of its valid part [bytes].

        Damaged lines followed by valid ones are removed from the file.
        """
        sound: list[bytes] = []
        read = kept = good_until = 0
        for number, line in enumerate(self.path.read_bytes().splitlines(keepends=True), start=1):
            read += len(line)
            try:
                data = json.loads(line) if line.endswith(b"\n") else None
            except (ValueError, RecursionError):
                data = None
            if number == 1:
                self._check_head(data, head)
            elif data is None:
                _log.warning("%s: line %d is damaged; its trial is played again", self.path, number)
                continue
            else:
                try:
                    result = result_from(self._kind, data)
                except ValueError as error:
                    raise ResultsFileError(f"{self.path}: line {number}: {error}") from error
                self.done[result.trial] = result
            sound.append(line)
            kept += len(line)
            good_until = read
        if sound and good_until != kept:
            write_atomically(self.path, b"".join(sound))
        return kept

    def _check_head(self, found: object, head: dict[str, object]) -> None:
        if not isinstance(found, dict) or found.get("format") != RESULTS_FORMAT:
            raise ResultsFileError(f"{self.path}: not a file of results; give another name")
        for key in dict.fromkeys([*head, "world", "referee"]):
            if found.get(key) != head.get(key):
                there = found.get(key, {"world": "sim", "referee": "own"}.get(key))
                what = "another version of the scenario" if key == "digest" else f"{key} {there!r}"
                raise ResultsFileError(f"{self.path}: holds results of {what}; give another name")


class ResultsFile(TrialsFile[MatchResult]):
    """A file of :class:`MatchResult`; the arguments are those of :class:`TrialsFile` after ``kind``."""

    def __init__(
        self,
        path: str | Path,
        scenario: Scenario,
        seed: int,
        world: str | None = None,
        referee: str | None = None,
    ) -> None:
        super().__init__(MatchResult, path, scenario, seed, world, referee)


def scenario_digest(scenario: Scenario) -> str:
    """Hash everything that decides a match; trials and seed are left out."""
    text = scenario.model_dump_json(exclude={"trials", "seed", "description", "on_error"})
    digest = hashlib.blake2b(text.encode(), digest_size=16)
    for _, setup in scenario.robots:
        # File contents count, not only names, because an edited tree makes another match.
        for part in contents_of(setup.play):
            digest.update(part)
        if isinstance(setup.substitute, str):
            digest.update(Path(setup.substitute).read_bytes())
    return digest.hexdigest()
