"""The league's log files: read, written, and made recordings that ``robobt replay`` shows.

Source of the format: ssl-logtools. A header of 12 bytes ``SSL_LOG_FILE`` and an
int32 version, then records of an int64 receiver time [ns], an int32 type, an
int32 size and the packet, all big-endian; ``.gz`` files are the same compressed.
"""

from __future__ import annotations

import gzip
import logging
import struct
import zlib
from collections.abc import Iterator
from enum import IntEnum
from pathlib import Path
from types import TracebackType
from typing import IO, NamedTuple, Self, cast

from robobt.config.errors import RobobtError

_log = logging.getLogger(__name__)

_MAGIC = b"SSL_LOG_FILE"
_VERSION = 1
_HEADER = struct.Struct(">12si")
_RECORD = struct.Struct(">qii")

_MOST_BYTES = 1 << 20
"""No record is longer; a size beyond it is none. Those of other kinds than ours may exceed our packets."""


class LogError(RobobtError, ValueError):
    """Something is wrong with a log; the message is one line that names the file."""


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
    """One record: when it was received [ns], its kind's number and the packet as it came."""

    time: int
    kind: int
    data: bytes


class LogWriter:
    """Writes a log. A context manager.

    What is written before the process dies can be read, but for the last moments.

    Args:
        path: file to write, replaced when it exists; a name that ends in ``.gz`` is compressed.

    Raises:
        OSError: the file cannot be written.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self._file = _open(self.path, "wb")
        self._file.write(_HEADER.pack(_MAGIC, _VERSION))
        self._since = 0

    def write(self, time: int, kind: LogKind, data: bytes) -> None:
        """Add a record.

        Args:
            time: when the packet was received [ns].

        Raises:
            OSError: the disk is full.
        """
        self._file.write(_RECORD.pack(time, kind, len(data)) + data)
        self._since += 1
        if self._since >= _FLUSH_EVERY:
            self._file.flush()
            self._since = 0

    def close(self) -> None:
        """Finish the file."""
        self._file.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()


_FLUSH_EVERY = 600
"""Records from one flush to the next: some seconds of a match."""


def read_log(path: str | Path) -> Iterator[LogRecord]:
    """The records of a log, in their order; records of unknown kinds are among them.

    A log whose end is cut off, as a killed recorder leaves it, ends with its
    last whole record and a warning.

    Raises:
        LogError: the file is no log, or goes on with what is no record.
        OSError: the file cannot be read.
    """
    where = Path(path)
    with _open(where, "rb") as file:
        try:
            header = file.read(_HEADER.size)
        except (gzip.BadGzipFile, zlib.error, EOFError) as error:
            raise LogError(f"{where}: is no log: {error}") from error
        if len(header) < _HEADER.size or not header.startswith(_MAGIC):
            raise LogError(f"{where}: is no log: it does not begin with {_MAGIC.decode()}")
        version = _HEADER.unpack(header)[1]
        if version != _VERSION:
            raise LogError(f"{where}: version {version} of the format is unknown; there is {_VERSION}")
        number = 0
        while True:
            record = _read_record(file, where, number)
            if record is None:
                return
            yield record
            number += 1


def _read_record(file: IO[bytes], where: Path, number: int) -> LogRecord | None:
    try:
        head = file.read(_RECORD.size)
        if not head:
            return None
        if len(head) == _RECORD.size:
            time, kind, size = _RECORD.unpack(head)
            if not 0 <= size <= _MOST_BYTES:
                raise LogError(f"{where}: record {number}: {size} bytes is no size of a packet")
            data = file.read(size)
            if len(data) == size:
                return LogRecord(time, kind, data)
    except EOFError:
        pass
    except (gzip.BadGzipFile, zlib.error) as error:
        raise LogError(f"{where}: record {number}: {error}") from error
    _log.warning("%s: ends in the middle of record %d", where, number)
    return None


def _open(path: Path, mode: str) -> IO[bytes]:
    if path.suffix.lower() == ".gz":
        return cast(IO[bytes], gzip.open(path, mode))
    return cast(IO[bytes], path.open(mode))


def is_log(path: str | Path) -> bool:
    """Whether a file is called as a league log is."""
    name = Path(path).name.lower()
    return name.endswith((".log", ".log.gz"))


__all__ = ["LogError", "LogKind", "LogRecord", "LogWriter", "is_log", "read_log"]
