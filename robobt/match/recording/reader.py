"""Reads a recording, or says in one line what is wrong with the file."""

from __future__ import annotations

import json
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from robobt import __version__
from robobt.match.recording.header import FORMAT, VERSION, Event, RecordingError, RecordingHeader, RobotFlag
from robobt.match.recording.numbers import BALL, POSE, SENT, UNKNOWN, Columns
from robobt.match.recording.recording import Poses, Recording
from robobt.world.game import GameState, RefereeCommand, Restart, Stage, Team
from robobt.world.state import RobotId

MOST_BYTES = 2**29
"""The longest text that is read, unpacked: hours of play."""

MOST_NUMBERS = 2**27
"""The most numbers that are read of all ticks together."""

_LONGEST = 1e9


def load_recording(path: str | Path) -> Recording:
    """Read a recording, plain or compressed; one that was cut off, up to its last whole line.

    Raises:
        RecordingError: the file cannot be read, is no recording, or a line of it is not what
            it should be; the message names the file, the line and the field.
    """
    path = Path(path)
    return _read(path, recording_lines(path))


def parse_recording(text: bytes, path: Path) -> Recording:
    """The recording that is in a text; ``path`` is what messages call it.

    Raises:
        RecordingError: as by :func:`load_recording`.
    """
    return _read(path, _split(path, text))


def _read(path: Path, lines: list[bytes]) -> Recording:
    header = _read_header(path, lines[0])
    reader = _Reader(path, header)
    for number, line in enumerate(lines[1:], start=2):
        reader.read(number, line)
    return reader.recording()


def recording_lines(path: Path) -> list[bytes]:
    """The whole lines of a recording's file, unpacked, at least one.

    Raises:
        RecordingError: it cannot be read, or has no line.
    """
    try:
        with path.open("rb") as file:
            data = file.read(MOST_BYTES + 1)
        if data.startswith(b"\x1f\x8b"):
            # Unlike gzip.open, this gives what there is of a stream that was cut off.
            data = zlib.decompressobj(wbits=31).decompress(data, MOST_BYTES + 1)
    except OSError as error:
        raise RecordingError(path, error.strerror or str(error)) from None
    except zlib.error as error:
        raise RecordingError(path, f"its compressed data are damaged ({error})") from None
    return _split(path, data)


def _split(path: Path, data: bytes) -> list[bytes]:
    if not data:
        raise RecordingError(path, "is empty")
    if len(data) > MOST_BYTES:
        raise RecordingError(path, f"is longer than {MOST_BYTES >> 20} MiB, as no match is")
    lines = data.split(b"\n")
    last = lines.pop()
    if not lines:
        if FORMAT.encode() in last[:100]:
            raise RecordingError(path, "is cut off inside its header", 1)
        raise RecordingError(path, "is not a robobt recording", 1)
    return lines


def _object(path: Path, number: int, line: bytes) -> dict[str, Any]:
    try:
        entry = json.loads(line)
    except (ValueError, RecursionError):
        raise RecordingError(path, "is not a JSON object", number) from None
    if not isinstance(entry, dict):
        raise RecordingError(path, "is not a JSON object", number)
    return entry


def _read_header(path: Path, line: bytes) -> RecordingHeader:
    try:
        entry = _object(path, 1, line)
    except RecordingError:
        raise RecordingError(path, "is not a robobt recording", 1) from None
    if entry.pop("format", None) != FORMAT:
        raise RecordingError(path, f"must be {FORMAT!r}: this is not a robobt recording", 1, "format")
    version = entry.pop("version", None)
    if version != VERSION:
        problem = f"{version!r} cannot be read by robobt {__version__}, which reads {VERSION}"
        raise RecordingError(path, problem, 1, "version")
    try:
        return RecordingHeader.model_validate(entry)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(part) for part in first["loc"])
        raise RecordingError(path, first["msg"], 1, place or None) from None


class _Reader:
    """Takes the lines after the header one by one."""

    def __init__(self, path: Path, header: RecordingHeader) -> None:
        self.path, self.header = path, header
        self.columns = Columns(len(header.robots))
        self.times: list[float] = []
        self.truth: list[NDArray[np.int32]] = []
        # What was observed, by the number of the block.
        self.observed: dict[int, NDArray[np.int32]] = {}
        self.letters: list[list[tuple[int, str]]] = [[] for _ in header.robots]
        self.feedback: list[list[tuple[int, dict[int, str]]]] = [[] for _ in header.robots]
        self.outputs: list[list[tuple[int, dict[str, Any]]]] = [[] for _ in header.robots]
        self.team_outputs: dict[Team, list[tuple[int, dict[str, Any]]]] = {team: [] for team in Team}
        self.games: list[tuple[int, GameState]] = []
        self.touches: list[tuple[int, RobotId | None]] = []
        self.events: list[Event] = []
        self.outcome: dict[str, Any] | None = None
        self.number = 1

    def read(self, number: int, line: bytes) -> None:
        self.number = number
        if self.outcome is not None:
            raise RecordingError(self.path, "stands after the last line of the recording", number)
        entry = _object(self.path, number, line)
        if "x" in entry:
            self._block(entry)
        elif "e" in entry:
            self._event(entry)
        elif "end" in entry:
            self._need(isinstance(entry["end"], dict), "end", "must be an object")
            self.outcome = entry["end"]
        else:
            raise RecordingError(self.path, "is neither ticks nor an event nor the end", number)

    def recording(self) -> Recording:
        units = self.columns.units
        nothing = [np.zeros((0, self.columns.count), np.int32)]
        table = np.concatenate([*nothing, *self.truth])
        poses, flags, commands = _arrays(table, units)
        observed = None
        if self.observed:
            shown = [self.observed.get(i, block) for i, block in enumerate(self.truth)]
            observed = _arrays(np.concatenate([*nothing, *shown]), units)[0]
        return Recording(
            self.path,
            self.header,
            np.array(self.times, dtype=np.float64),
            poses.ball,
            poses.robots,
            flags,
            commands,
            observed,
            self.letters,
            self.feedback,
            self.outputs,
            self.team_outputs,
            self.games,
            self.touches,
            self.events,
            self.outcome,
        )

    def _block(self, entry: dict[str, Any]) -> None:
        first = len(self.times)
        times = entry.get("t")
        if not isinstance(times, list) or not times or entry.get("n") != len(times):
            raise self._error("t", "must be a list of as many times as n says")
        for time in times:
            self.times.append(self._number(time, "t"))
            self._need(len(self.times) < 2 or self.times[-1] >= self.times[-2], "t", "runs backwards")
        if len(self.times) * self.columns.count > MOST_NUMBERS:
            raise RecordingError(self.path, "holds more ticks than any match has", self.number)
        table = self._table(entry["x"], len(times), "x")
        poses, sent = BALL + POSE - 1, self.columns.poses + SENT - 1
        flags = np.hstack([table[:, poses : self.columns.poses : POSE], table[:, sent::SENT]])
        bad = flags[(flags != UNKNOWN) & ((flags < 0) | (flags > sum(RobotFlag)))]
        self._need(not bad.size, "x", f"{bad[:1].tolist()} are no flags")
        if "o" in entry:
            self.observed[len(self.truth)] = self._table(entry["o"], len(times), "o")
        self.truth.append(table)
        changes = entry.get("c", {})
        self._need(isinstance(changes, dict), "c", "must be an object")
        before = -1
        for key, change in changes.items():
            tick = self._index(key, len(times), "c", "tick")
            self._need(tick > before, "c", "runs backwards")
            self._need(isinstance(change, dict), f"c.{key}", "must be an object")
            before = tick
            self._change(first + tick, change, f"c.{key}")

    def _table(self, text: Any, ticks: int, field: str) -> NDArray[np.int32]:
        self._need(isinstance(text, str), field, "must be a text")
        try:
            return self.columns.unpack(text, ticks)
        except ValueError as error:
            raise self._error(field, str(error)) from None

    def _change(self, tick: int, entry: dict[str, Any], field: str) -> None:
        for slot, letters in self._by_robot(entry.get("s", {}), f"{field}.s"):
            size = len(self.header.robots[slot].tree)
            good = isinstance(letters, str) and len(letters) == size and not letters.strip("SFRsfr-")
            self._need(good, f"{field}.s.{slot}", f"must be {size} letters out of S, F, R, s, f, r, -")
            self.letters[slot].append((tick, letters))
        for slot, messages in self._by_robot(entry.get("f", {}), f"{field}.f"):
            self.feedback[slot].append((tick, self._messages(slot, messages, f"{field}.f.{slot}")))
        written = entry.get("w", {})
        self._need(isinstance(written, dict), f"{field}.w", "must be an object")
        for key, values in written.items():
            self._need(isinstance(values, dict), f"{field}.w.{key}", "must be an object")
            if key in list(Team):
                self.team_outputs[Team(key)].append((tick, values))
            else:
                slot = self._index(key, len(self.header.robots), f"{field}.w", "robot")
                self.outputs[slot].append((tick, values))
        if "g" in entry:
            self.games.append((tick, self._game(entry["g"], f"{field}.g")))
        if "l" in entry:
            touch = entry["l"]
            self.touches.append((tick, None if touch is None else self._robot(touch, f"{field}.l")))

    def _event(self, entry: dict[str, Any]) -> None:
        kind, text = entry["e"], entry.get("text", "")
        self._need(isinstance(kind, str), "e", "must be a word")
        self._need(isinstance(text, str), "text", "must be a text")
        robot = self._robot(entry["robot"], "robot") if "robot" in entry else None
        team = self._team(entry["team"], "team") if "team" in entry else None
        self.events.append(Event(self._number(entry.get("t"), "t"), kind, team, robot, text))

    def _messages(self, slot: int, messages: Any, field: str) -> dict[int, str]:
        self._need(isinstance(messages, dict), field, "must be an object")
        said = {}
        for key, message in messages.items():
            place = self._index(key, len(self.header.robots[slot].tree), field, "node")
            self._need(isinstance(message, str), f"{field}.{key}", "must be a text")
            said[place] = message
        return said

    def _game(self, entry: Any, field: str) -> GameState:
        self._need(isinstance(entry, dict), field, "must be an object")
        try:
            placement = entry["placement"]
            if placement is not None:
                x, y = placement
                placement = (float(x), float(y))
            return GameState(
                RefereeCommand[entry["command"]],
                Stage[entry["stage"]],
                int(entry["blue"]),
                int(entry["yellow"]),
                None if entry["restart"] is None else Restart(entry["restart"]),
                None if entry["team"] is None else Team(entry["team"]),
                bool(entry["may_touch"]),
                placement,
            )
        except KeyError as error:
            raise self._error(field, f"{error.args[0]!r} is missing or unknown") from None
        except (TypeError, ValueError, OverflowError) as error:
            raise self._error(field, str(error)) from None

    def _number(self, value: Any, field: str) -> float:
        if isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < _LONGEST:
            return float(value)
        raise self._error(field, "must be a finite number")

    def _by_robot(self, entry: Any, field: str) -> Iterator[tuple[int, Any]]:
        self._need(isinstance(entry, dict), field, "must be an object")
        for key, value in entry.items():
            yield self._index(key, len(self.header.robots), field, "robot"), value

    def _index(self, key: str, size: int, field: str, what: str) -> int:
        index = int(key) if key.isascii() and key.isdigit() and len(key) < 6 else size
        self._need(index < size, field, f"there is no {what} {key!r}")
        return index

    def _team(self, value: Any, field: str) -> Team:
        try:
            return Team(value)
        except ValueError:
            raise self._error(field, f"{value!r} is not a team") from None

    def _robot(self, value: Any, field: str) -> RobotId:
        good = isinstance(value, list) and len(value) == 2 and type(value[1]) is int
        self._need(good, field, "must be a team and a number")
        return RobotId(self._team(value[0], field), value[1])

    def _need(self, good: bool, field: str, problem: str) -> None:
        if not good:
            raise self._error(field, problem)

    def _error(self, field: str, problem: str) -> RecordingError:
        return RecordingError(self.path, problem, self.number, field)


def _arrays(
    table: NDArray[np.int32], units: NDArray[np.float64]
) -> tuple[Poses, NDArray[np.uint8], NDArray[np.float64]]:
    """Poses, flags and commands of a table of integers."""
    unknown = table == UNKNOWN
    numbers = table * units
    numbers[unknown] = np.nan
    ball = numbers[:, :BALL]
    ball[unknown[:, :BALL].any(axis=1)] = np.nan
    robots = (table.shape[1] - BALL) // (POSE + SENT)
    middle = BALL + POSE * robots
    poses = numbers[:, BALL:middle].reshape(len(table), robots, POSE)
    poses[np.isnan(poses).any(axis=2)] = np.nan
    contact = poses[:, :, -1] == 1.0
    sent = numbers[:, middle:].reshape(len(table), robots, SENT)
    flags = np.nan_to_num(sent[:, :, -1]).astype(np.uint8) | contact.astype(np.uint8)
    return Poses(ball, poses[:, :, :-1], contact), flags, sent[:, :, :-1]
