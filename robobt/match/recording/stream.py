"""The table of a recording: one row per tick, as a stream of Arrow record batches.

| column | holds |
| --- | --- |
| ``time`` | [s] |
| ``truth`` | ball x, y, vx, vy, z, vz; each robot's x, y, heading, vx, vy, omega, ball contact |
| ``observed`` | the same as the trees were shown it, null where that is the truth |
| ``commands`` | each robot's vx, vy, omega, kick speed, kick angle, :class:`RobotFlag` |
| ``changes`` | what else changed: :class:`TickChanges` as JSON, null for nothing |
| ``detections`` | pictures since the last tick as cameras saw them: camera, age, ball and robots; or null |

Numbers are in SI units and world coordinates; NaN means unknown. The header is JSON in the schema's
metadata.
"""

from __future__ import annotations

import os
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, BinaryIO

import pyarrow as pa
import pyarrow.ipc
from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    FiniteFloat,
    JsonValue,
    StringConstraints,
    ValidationError,
)

from robobt import __version__
from robobt.match.recording.header import (
    RECORDING_FORMAT,
    RECORDING_VERSION,
    Event,
    RecordingError,
    RecordingHeader,
)
from robobt.match.recording.numbers import BALL_NUMBERS, COMMAND_NUMBERS, DETECTIONS_TYPE, POSE
from robobt.match.recording.version_3 import BALL_3, COMMAND_3, from_version_3
from robobt.world.game import GameState
from robobt.world.sketch import MOST_SHAPES, check_shape
from robobt.world.state import RobotId

RECORDING_COLUMNS = ("time", "truth", "observed", "commands", "changes", "detections")
_FORMAT_KEY, _VERSION_KEY, _HEADER_KEY = b"format", b"version", b"header"

MOST_RECORDING_BYTES = 200 * 2**20
"""Largest unpacked size that is read: an hour of play with six robots a side."""

_SMALL, _RATIO = 24 * 2**20, 10
"""Unpacked size allowed for any file [bytes], and as a multiple of its size; robobt packs to a third."""

_NO_RECORDING = "is not a robobt recording"

_STREAM, _END = b"\xff\xff\xff\xff", b"\xff\xff\xff\xff\x00\x00\x00\x00"
_READ = ("3", "4", str(RECORDING_VERSION))
_OLD = (b"\x1f\x8b", b'{"format":"robobt-recording"')
"""How recordings of versions 1 and 2 begin, packed by gzip or plain."""

_Shape = Annotated[list[JsonValue], AfterValidator(check_shape)]
_Letters = Annotated[str, StringConstraints(pattern="^[SFRsfr-]*$")]


class TickChanges(BaseModel):
    """Changes and events at one tick; robots are named "blue 3"."""

    model_config = ConfigDict(extra="forbid")

    statuses: dict[str, _Letters] = Field(
        {},
        description="by robot, one letter per node: S, F, R if it was ticked, s, f, r if it kept an earlier "
        "status, - without a status",
    )
    feedback: dict[str, dict[int, str]] = Field(
        {}, description="by robot and place of the node; valid while the node has a status"
    )
    written: dict[str, dict[str, JsonValue]] = Field(
        {}, description='values that skills wrote, by robot, or "blue" and "yellow", and entry'
    )
    drawn: dict[str, Annotated[list[_Shape], Field(max_length=10 * MOST_SHAPES)]] = Field(
        {},
        description="drawings from this tick on, by robot, in its team's view: each a layer's name, line, "
        'point, circle, text or number, and its numbers [m] and text; "field" is the world\'s drawing',
    )
    game: GameState | None = Field(None, description="the referee's state, in blue's coordinates")
    touch: RobotId | None = Field(None, description="the robot that touched the ball last")
    cameras: dict[int, tuple[FiniteFloat, FiniteFloat, FiniteFloat]] = Field(
        {},
        description="where cameras are, by number, whenever that changed: x, y, height above the ground [m]",
    )
    events: list[Event] = []
    outcome: dict[str, JsonValue] | None = Field(None, description="how the match ended, at its last tick")


def _schema_of(header: RecordingHeader, version: str = str(RECORDING_VERSION)) -> pa.Schema:
    """Return the schema of a recording with this header, by default in the current version."""
    ball, command = (BALL_3, COMMAND_3) if version == "3" else (BALL_NUMBERS, COMMAND_NUMBERS)
    poses = pa.list_(pa.float32(), ball + POSE * len(header.robots))
    commands = pa.list_(pa.float32(), command * len(header.robots))
    types = (pa.float64(), poses, poses, commands, pa.string(), DETECTIONS_TYPE)
    columns = list(zip(RECORDING_COLUMNS, types, strict=True))
    if version in ("3", "4"):
        columns.pop()
    metadata = {_FORMAT_KEY: RECORDING_FORMAT, _VERSION_KEY: version, _HEADER_KEY: header.model_dump_json()}
    return pa.schema(columns, metadata=metadata)


def new_stream(sink: BinaryIO | pa.NativeFile, header: RecordingHeader) -> pa.ipc.RecordBatchStreamWriter:
    """Start a recording with this header; every batch has its schema and is compressed."""
    schema = _schema_of(header)
    # A second of play is too little to be shared out between threads.
    options = pa.ipc.IpcWriteOptions(compression="zstd", use_threads=False)
    writer = pa.ipc.new_stream(sink, schema, options=options)
    # Arrow writes the schema with the first batch.
    writer.write_batch(pa.RecordBatch.from_pylist([], schema))
    return writer


def read_bytes(path: Path) -> bytes:
    """Return the content of a file."""
    try:
        with path.open("rb") as file:
            # Python allocates memory for everything that a read asks for.
            size = os.fstat(file.fileno()).st_size if path.is_file() else MOST_RECORDING_BYTES
            data = file.read(min(size, MOST_RECORDING_BYTES) + 1)
    except OSError as error:
        raise RecordingError(path, error.strerror or str(error)) from None
    if len(data) > MOST_RECORDING_BYTES:
        raise too_large(path)
    return data


def open_stream(data: bytes, path: Path) -> tuple[RecordingHeader, Iterator[pa.RecordBatch]]:
    """Return the header and an iterator over the batches of ticks.

    Raises:
        RecordingError: the header is invalid or a batch is damaged; a truncated last batch is
            left out.
    """
    if not data:
        raise RecordingError(path, "is empty")
    if data.startswith(_OLD):
        raise RecordingError(
            path,
            f"is a recording in an older format, which robobt {__version__} does not read; "
            "record the match again (robobt match --record) or use the robobt that wrote it",
        )
    source = pa.BufferReader(data)
    try:
        schema = pa.ipc.read_schema(_checked(pa.ipc.read_message(source), "schema"))
        metadata: dict[bytes, bytes] = schema.metadata or {}
    except (pa.ArrowException, OSError, EOFError):
        cut = data.startswith(_STREAM[: len(data)])
        raise RecordingError(
            path, "is cut off inside its header" if cut else "is not a robobt recording"
        ) from None
    if metadata.get(_FORMAT_KEY) != RECORDING_FORMAT.encode():
        raise RecordingError(path, _NO_RECORDING)
    version = metadata.get(_VERSION_KEY, b"").decode("utf-8", "replace")
    if version not in _READ:
        problem = f"{version!r} cannot be read by robobt {__version__}, which reads {' and '.join(_READ)}"
        raise RecordingError(path, problem, field="version")
    try:
        header = RecordingHeader.model_validate_json(metadata.get(_HEADER_KEY, b""))
    except ValidationError as error:
        raise invalid(path, error) from None
    if not schema.equals(_schema_of(header, version)):
        raise RecordingError(path, "its columns are not those of its header's robots")
    batches = _batches(source, schema, path, data.endswith(_END))
    if version == "3":
        batches = (from_version_3(batch, len(header.robots), _schema_of(header, "4")) for batch in batches)
    if version in ("3", "4"):
        now = _schema_of(header)
        batches = (
            pa.RecordBatch.from_arrays([*batch.columns, pa.nulls(len(batch), DETECTIONS_TYPE)], schema=now)
            for batch in batches
        )
    return header, batches


def _batches(source: pa.BufferReader, schema: pa.Schema, path: Path, ended: bool) -> Iterator[pa.RecordBatch]:
    unpacked, most = 0, min(MOST_RECORDING_BYTES, _SMALL + _RATIO * source.size())
    while True:
        start = source.tell()
        try:
            message = pa.ipc.read_message(source)
        except (pa.ArrowException, OSError, EOFError) as error:
            if ended and (source.tell() < source.size() or not isinstance(error, EOFError)):
                raise RecordingError(path, f"is damaged after {start} bytes") from None
            return
        try:
            unpacked += _unpacked_size(_checked(message, "record batch"))
            if unpacked > most:
                raise too_large(path, most)
            batch = pa.ipc.read_record_batch(message, schema)
            batch.validate(full=True)
        except (pa.ArrowException, OSError, struct.error) as error:
            raise RecordingError(path, f"is damaged after {start} bytes ({error})") from None
        yield batch


def _checked(message: pa.Message, kind: str) -> pa.Message:
    # Arrow would read a message of another kind as the requested kind, with unpredictable results.
    if message.type != kind:
        raise pa.ArrowInvalid(f"there is a {message.type} in place of a {kind}")
    return message


def _unpacked_size(message: pa.Message) -> int:
    """Return the unpacked size of a batch [bytes], to check it before Arrow unpacks its buffers."""

    # In a flatbuffer, tables find their fields by a table of offsets in front of them.
    def number(kind: str, at: int, of: pa.Buffer = message.metadata) -> int:
        return int(struct.unpack_from(f"<{kind}", of, at)[0])

    def field(table: int, place: int) -> int:
        at = table + number("H", table - number("i", table) + 4 + 2 * place)
        return at + number("I", at)

    buffers = field(field(number("I", 0), 2), 2)
    total = 0
    for place in range(buffers + 4, buffers + 4 + 16 * number("I", buffers), 16):
        offset, length = number("q", place), number("q", place + 8)
        # Every buffer begins with its size, or -1 if it is not packed.
        total += max(length, number("q", offset, message.body)) if length else 0
    return total


def too_large(path: Path, most: int = MOST_RECORDING_BYTES) -> RecordingError:
    """Return the error for a file larger than any match's recording."""
    return RecordingError(path, f"is larger than {most >> 20} MiB unpacked, as no match is")


def invalid(path: Path, error: ValidationError, tick: int | None = None) -> RecordingError:
    """Return the error for an invalid header or invalid changes of a tick."""
    first = error.errors(include_url=False)[0]
    field = ".".join([str(part) for part in first["loc"]]) or ("header" if tick is None else "changes")
    return RecordingError(path, first["msg"], tick, field)
