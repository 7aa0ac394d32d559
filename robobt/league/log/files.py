"""The league's log files, read and written.

Source of the format: ssl-logtools. A header of 12 bytes ``SSL_LOG_FILE`` and an
int32 version, then records of an int64 timestamp of reception [ns], an int32 type, an
int32 size and the packet, all big-endian; ``.gz`` files are the same, compressed.
"""

from __future__ import annotations

import gzip
import logging
import select
import struct
import time
import zlib
from collections.abc import Iterator
from contextlib import ExitStack, suppress
from enum import IntEnum
from pathlib import Path
from typing import IO, NamedTuple, Self, cast

from robobt.config.errors import RobobtError
from robobt.league.wire.endpoints import Endpoints
from robobt.league.wire.sockets import Receiver
from robobt.signals import Terminated, check, uninterrupted

_log = logging.getLogger(__name__)

_LOG_MAGIC = b"SSL_LOG_FILE"
_LOG_VERSION = 1
_LOG_HEADER = struct.Struct(">12si")
_RECORD = struct.Struct(">qii")

_MAX_RECORD = 1 << 20
"""Longest record that is kept [bytes]; no packet is longer, but the index of a log may be."""

_PIECE = 1 << 16
"""Bytes of a longer record that are read at a time."""

_FLUSH_EVERY = 600
"""Records from one flush to the next: some seconds of a match."""


class LogError(RobobtError, ValueError):
    """A problem with a log; the message is one line that names the file."""


class LogKind(IntEnum):
    """What a record holds, by the numbers of the format."""

    BLANK = 0
    UNKNOWN = 1
    VISION_2010 = 2
    REFEREE = 3
    VISION = 4
    TRACKER = 5
    INDEX = 6


class LogRecord(NamedTuple):
    """One record: timestamp of reception [ns], number of its kind, and the packet."""

    time: int
    kind: int
    data: bytes


class LogWriter:
    """Writes a log in place of one that is there, compressed if its name ends in ``.gz``. A context manager.

    If the process dies, the log can be read up to its last moments.
    """

    def __init__(self, path: str | Path) -> None:
        self._file = _open(Path(path), "wb")
        self._file.write(_LOG_HEADER.pack(_LOG_MAGIC, _LOG_VERSION))
        self._unflushed = 0

    def write(self, time: int, kind: LogKind, data: bytes) -> None:
        """Add a packet that was received at a time [ns]."""
        with uninterrupted:
            self._file.write(_RECORD.pack(time, kind, len(data)) + data)
            self._unflushed += 1
            if self._unflushed >= _FLUSH_EVERY:
                self._file.flush()
                self._unflushed = 0

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        with uninterrupted:
            self._file.close()


_PACKETS = frozenset({LogKind.VISION_2010, LogKind.REFEREE, LogKind.VISION, LogKind.TRACKER})
"""Kinds of records that hold a packet."""


def read_log(path: str | Path) -> Iterator[LogRecord]:
    """Yield the records of a log in their order, those of unknown kinds included.

    Records that hold no packet, as an index, are left out where they are longer than any packet.

    A truncated log, as a killed recorder leaves it, ends with its last complete
    record and a warning.

    Raises:
        LogError: the file is not a log, or is corrupt.
        OSError: the file cannot be read.
    """
    where = Path(path)
    with _open(where, "rb") as file:
        try:
            header = file.read(_LOG_HEADER.size)
        except (gzip.BadGzipFile, zlib.error, EOFError) as error:
            raise LogError(f"{where}: is not a log: {error}") from error
        if len(header) < _LOG_HEADER.size or not header.startswith(_LOG_MAGIC):
            raise LogError(f"{where}: is not a log: it does not begin with {_LOG_MAGIC.decode()}")
        version = _LOG_HEADER.unpack(header)[1]
        if version != _LOG_VERSION:
            raise LogError(f"{where}: has version {version} of the format; only {_LOG_VERSION} can be read")
        number = 0
        while (record := _read_record(file, where, number)) is not None:
            if record is not _SKIPPED:
                yield record
            number += 1


_SKIPPED = LogRecord(0, LogKind.BLANK, b"")


def _read_record(file: IO[bytes], where: Path, number: int) -> LogRecord | None:
    try:
        head = file.read(_RECORD.size)
        if not head:
            return None
        if len(head) == _RECORD.size:
            time, kind, size = _RECORD.unpack(head)
            if size < 0 or (size > _MAX_RECORD and kind in _PACKETS):
                raise LogError(f"{where}: record {number}: impossible size of {size} bytes")
            if size > _MAX_RECORD:
                if _skip(file, size):
                    return _SKIPPED
            elif len(data := file.read(size)) == size:
                return LogRecord(time, kind, data)
    except EOFError:
        pass
    except (gzip.BadGzipFile, zlib.error) as error:
        raise LogError(f"{where}: record {number}: {error}") from error
    _log.warning("%s: ends in the middle of record %d", where, number)
    return None


def _skip(file: IO[bytes], size: int) -> bool:
    """Skip this many bytes; return whether all were there."""
    while size > 0:
        read = len(file.read(min(size, _PIECE)))
        if not read:
            return False
        size -= read
    return True


def _open(path: Path, mode: str) -> IO[bytes]:
    if path.suffix.lower() == ".gz":
        return cast(IO[bytes], gzip.open(path, mode))
    return cast(IO[bytes], path.open(mode))


def log_field(
    path: str | Path, endpoints: Endpoints, interface: str | None = None, seconds: float | None = None
) -> dict[LogKind, int]:
    """Log the packets of vision, tracker and game controller, until interrupted or for ``seconds``.

    Return the number of packets of each kind that were written.

    Args:
        path: the log; compressed when the name ends in ``.gz``.
        endpoints: where to listen.
        interface: own address of the interface to listen on; none: this machine's packets only.
        seconds: how long [s]; None until interrupted.
    """
    sources = {
        LogKind.VISION: endpoints.vision,
        LogKind.TRACKER: endpoints.tracker,
        LogKind.REFEREE: endpoints.referee,
    }
    written = dict.fromkeys(sources, 0)
    with ExitStack() as opened:
        receivers = {
            opened.enter_context(Receiver(*endpoint, interface)): kind for kind, endpoint in sources.items()
        }
        log = opened.enter_context(LogWriter(path))
        end = None if seconds is None else time.monotonic() + seconds
        # A signal is how one stops listening.
        with suppress(KeyboardInterrupt, Terminated):
            while end is None or time.monotonic() < end:
                check()
                for receiver in select.select(list(receivers), [], [], 0.1)[0]:
                    for packet in receiver.receive():
                        with uninterrupted:  # so that the count is that of the file
                            log.write(time.time_ns(), receivers[receiver], packet.data)
                            written[receivers[receiver]] += 1
    return written
