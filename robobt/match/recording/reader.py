"""Reads a recording, or says in one line what is wrong with the file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray
from pydantic import JsonValue, ValidationError

from robobt.match.recording.capture import FIELD_SKETCHES
from robobt.match.recording.header import Event, RecordedNode, RecordingError, RecordingHeader, RobotFlag
from robobt.match.recording.numbers import (
    BALL_NUMBERS,
    COMMAND_NUMBERS,
    DETECTED_POSE,
    DETECTION_HEAD,
    POSE,
    numbers_of,
)
from robobt.match.recording.recording import Poses, Recording, SeenPictures, Timeline
from robobt.match.recording.stream import TickChanges, invalid, open_stream, read_bytes, too_large
from robobt.world.game import GameState, Team
from robobt.world.sketch import Shape
from robobt.world.state import RobotId

MOST_TEXT = 32 * 2**20
"""Largest text that is read, because Python's objects take many times its size [bytes]."""

_FEW_VALUES, _BYTES_PER_VALUE = 100_000, 8
"""Values of text that any file may hold, and bytes of the file per further value; robobt writes about 30."""

_LATEST_TIME = 1e9
"""Latest time allowed [s]."""

_FARTHEST = 1e4
"""Values of pictures beyond this are unknown."""


def load_recording(path: str | Path) -> Recording:
    """Read the recording in the file ``path``; a truncated file is read up to its last complete batch.

    Raises:
        RecordingError: the file cannot be read, is no recording, or has an invalid part; the message names
        the file, the tick and the field.
    """
    path = Path(path)
    return parse_recording(read_bytes(path), path)


def parse_recording(data: bytes, path: Path) -> Recording:
    """Read a recording in memory; ``path`` is its name in messages."""
    header, batches = open_stream(data, path)
    reader = _BatchReader(path, header, _FEW_VALUES + len(data) // _BYTES_PER_VALUE)
    for batch in batches:
        reader.read(batch)
    return reader.recording()


class _BatchReader:
    """Takes the batches of a recording one by one."""

    def __init__(self, path: Path, header: RecordingHeader, most_values: int) -> None:
        self._path, self._header, self._values_left = path, header, most_values
        self._slots = {str(robot.id): slot for slot, robot in enumerate(header.robots)}
        robots = len(header.robots)
        self._times = [np.zeros(0)]
        self._truth = [np.zeros((0, BALL_NUMBERS + POSE * robots), np.float32)]
        self._observed = self._truth.copy()
        self._commands = [np.zeros((0, COMMAND_NUMBERS * robots), np.float32)]
        self._letters: list[Timeline[str]] = [[] for _ in header.robots]
        self._feedback: list[Timeline[dict[int, str]]] = [[] for _ in header.robots]
        self._written: dict[str, Timeline[dict[str, JsonValue]]] = {
            name: [] for name in (*Team, *self._slots)
        }
        self._drawn: dict[str, Timeline[list[Shape]]] = {}
        self._games: Timeline[GameState] = []
        self._touches: Timeline[RobotId | None] = []
        self._events: list[Event] = []
        self._outcome: dict[str, JsonValue] | None = None
        self._cameras: dict[int, tuple[float, float, float]] = {}
        self._pictures: list[tuple[float, NDArray[np.float32]]] = []
        self._ticks = self._text = 0

    def read(self, batch: pa.RecordBatch) -> None:
        """Take the next ticks."""
        time, truth, observed, commands, changes, detections = batch.columns
        missing = time.null_count or truth.null_count or commands.null_count
        if missing or observed.null_count not in (0, len(batch)):
            raise self._error(self._ticks, None, "lacks numbers")
        self._times.append(time.to_numpy())
        self._truth.append(numbers_of(truth))
        same = observed.null_count == len(batch)  # as in a batch that holds the outcome and no tick
        self._observed.append(self._truth[-1] if same else numbers_of(observed))
        self._commands.append(numbers_of(commands))
        self._read_detections(time, detections)
        self._text += changes.nbytes
        if self._text > MOST_TEXT:
            raise too_large(self._path)
        for tick, text in enumerate(changes.to_pylist(), start=self._ticks):
            if text is not None:
                self._change(tick, text)
        self._ticks += len(batch)

    def _read_detections(self, times: pa.Array, column: pa.Array) -> None:
        if column.null_count == len(column):
            return
        width = DETECTION_HEAD + DETECTED_POSE * len(self._header.robots)
        for tick, (time, numbers) in enumerate(zip(times, column, strict=True), start=self._ticks):
            if not numbers.is_valid:
                continue
            values = numbers.values.to_numpy(zero_copy_only=False)
            if len(values) % width or numbers.values.null_count:
                raise self._error(tick, "detections", "are not whole pictures")
            table = values.reshape(-1, width)
            self._pictures += [(time.as_py() - float(row[1]), row) for row in table]

    def recording(self) -> Recording:
        """Return the whole recording."""
        times = np.concatenate(self._times)
        late = np.flatnonzero(~((times >= np.append(-np.inf, times[:-1])) & (np.abs(times) < _LATEST_TIME)))
        if late.size:
            raise self._error(int(late[0]), "time", "must be finite and not less than the time before")
        robots = len(self._header.robots)
        truth = poses_of(self._truth, robots)
        observed = None
        if any(one is not other for one, other in zip(self._observed, self._truth, strict=True)):
            observed = poses_of(self._observed, robots)
        commands = np.concatenate(self._commands).reshape(len(times), robots, COMMAND_NUMBERS)
        odd = np.flatnonzero(~np.isin(commands[:, :, -1], range(sum(RobotFlag) + 1)).all(axis=1))
        if odd.size:
            raise self._error(int(odd[0]), "commands", "holds flags that are none")
        flags = commands[:, :, -1].astype(np.uint8) | truth.contact * np.uint8(RobotFlag.BALL_CONTACT)
        return Recording(
            path=self._path,
            header=self._header,
            times=times,
            truth=truth,
            observed=observed,
            flags=flags,
            commands=commands[:, :, :-1],
            letters=self._letters,
            feedback=self._feedback,
            written=self._written,
            drawn=self._drawn,
            games=self._games,
            touches=self._touches,
            events=self._events,
            outcome=self._outcome,
            pictures=pictures_of(self._pictures, robots),
            cameras=self._cameras,
        )

    def _change(self, tick: int, text: str) -> None:
        self._values_left -= sum([text.count(sign) for sign in ",[{"])
        if self._values_left < 0:
            raise self._error(tick, None, "holds more values than a match does")
        try:
            changes = TickChanges.model_validate_json(text)
        except ValidationError as error:
            raise invalid(self._path, error, tick) from None
        for robot, letters in changes.statuses.items():
            if len(letters) != len(self._tree(robot, tick, "statuses")):
                raise self._error(tick, f"statuses.{robot}", "must have a letter for each node of the tree")
            self._letters[self._slots[robot]].append((tick, letters))
        for robot, texts in changes.feedback.items():
            if not all(0 <= place < len(self._tree(robot, tick, "feedback")) for place in texts):
                raise self._error(tick, f"feedback.{robot}", "names a node that the tree does not have")
            self._feedback[self._slots[robot]].append((tick, texts))
        for owner, values in changes.written.items():
            if owner not in self._written:
                raise self._error(tick, "written", f"there is no robot or team {owner!r}")
            self._written[owner].append((tick, values))
        for owner, shapes in changes.drawn.items():
            if owner not in self._slots and owner != FIELD_SKETCHES:
                raise self._error(tick, "drawn", f"there is no robot {owner!r}")
            self._drawn.setdefault(owner, []).append((tick, shapes))
        if changes.game is not None:
            self._games.append((tick, changes.game))
        if "touch" in changes.model_fields_set:
            self._touches.append((tick, changes.touch))
        self._cameras |= changes.cameras
        self._events += changes.events
        if changes.outcome is not None:
            self._outcome = changes.outcome

    def _tree(self, robot: str, tick: int, field: str) -> tuple[RecordedNode, ...]:
        if robot not in self._slots:
            raise self._error(tick, field, f"there is no robot {robot!r}")
        return self._header.robots[self._slots[robot]].tree

    def _error(self, tick: int, field: str | None, problem: str) -> RecordingError:
        return RecordingError(self._path, problem, tick, field)


def pictures_of(pictures: list[tuple[float, NDArray[np.float32]]], count: int) -> SeenPictures | None:
    """Return pictures, by the time of each and its numbers, of this many robots; None for none."""
    if not pictures:
        return None
    table = np.stack([row for _, row in pictures])
    table = np.where(np.abs(table) < _FARTHEST, table, np.float32(np.nan))
    robots = table[:, DETECTION_HEAD:].reshape(len(table), count, DETECTED_POSE)
    robots[np.isnan(robots).any(axis=2)] = np.nan
    times = np.array([time for time, _ in pictures])
    cameras = np.nan_to_num(table[:, 0]).astype(np.int64)
    return SeenPictures(times, table[:, 1].astype(np.float64), cameras, table[:, 2:DETECTION_HEAD], robots)


def poses_of(tables: list[NDArray[np.float32]], count: int) -> Poses:
    """Return the poses in tables (ticks, numbers) of this many robots; a partly unknown pose is unknown."""
    table = np.concatenate(tables)
    ball = table[:, :BALL_NUMBERS]
    robots = table[:, BALL_NUMBERS:].reshape(len(table), count, POSE)
    ball[np.isnan(ball).any(axis=1)] = np.nan
    robots[np.isnan(robots).any(axis=2)] = np.nan
    return Poses(ball, robots[:, :, :-1], robots[:, :, -1] == 1.0)
