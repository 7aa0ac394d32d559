"""Writes a match to a file, tick by tick.

The file is a stream of Arrow record batches, one a second of play, and is only ever
appended to: a match that was killed leaves a file that can be read up to its last whole
batch. :mod:`robobt.match.recording.stream` has the columns. Ticks are cheap because many are encoded at once,
when they are written.
"""

from __future__ import annotations

import atexit
from collections.abc import Container, Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from types import TracebackType
from typing import Self

from robobt.config.errors import naming
from robobt.match.recording.capture import Capture, CapturedTick
from robobt.match.recording.encoder import TickEncoder
from robobt.match.recording.header import RecordingHeader
from robobt.match.recording.stores import plain
from robobt.match.recording.stream import new_stream
from robobt.skills.store import Store
from robobt.tree import TreeRunner
from robobt.world.state import RobotId

_FLUSH_PERIOD = 1.0
"""Longest play that a killed match loses [s]."""

_WRITE_BUFFER = 2**20
"""Buffer that joins the many small writes of an Arrow batch [bytes]."""


class Recorder:
    """Writes one match to a file, tick by tick. A context manager.

    Args:
        path: file to write, replaced when it exists.
        header: the constant part of the recording, or the capture of a match that has it.
        runners: the runner of each robot whose tree is recorded; not used with a capture.
        stores: the store of each robot whose skills' writes are recorded; not used with a capture.
        layers: drawing layers of skills to record.

    Attributes:
        capture: the capture that is recorded.
        tick: see :meth:`Capture.tick`.
        event: see :meth:`Capture.event`.
    """

    def __init__(
        self,
        path: str | Path,
        header: RecordingHeader | Capture,
        runners: Mapping[RobotId, TreeRunner] | None = None,
        stores: Mapping[RobotId, Store] | None = None,
        layers: Container[str] = (),
    ) -> None:
        self.path = Path(path)
        self.capture = header if isinstance(header, Capture) else Capture(header, runners, stores)
        self.header = self.capture.header
        self.tick, self.event = self.capture.tick, self.capture.event
        self._encoder = TickEncoder(self.capture, layers)
        self.capture.look(self, layers)
        # Ticks still to be written.
        self._ticks: list[CapturedTick] = []
        # One batch a second keeps writes few, and a killed match loses no more than that.
        self._most_ticks = max(1, round(_FLUSH_PERIOD / self.header.period))
        self.path.parent.mkdir(parents=True, exist_ok=True)
        with naming(self.path):
            self._file = self.path.open("wb", _WRITE_BUFFER)
            try:
                self._writer = new_stream(self._file, self.header)
                self._file.flush()
            except BaseException:
                self._discard()
                raise
        self.capture.takers.append(self._take)
        # For a process that ends without closing it.
        atexit.register(self._release)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._release()

    def close(self, outcome: Mapping[str, object]) -> None:
        """Write the outcome, any mapping that JSON can hold, and close the file.

        The outcome belongs to the last tick; a recording without an outcome stays incomplete.
        """
        self._add_to_last({"outcome": plain(outcome)})
        self._release()

    def _take(self, tick: CapturedTick) -> None:
        if len(self._ticks) == self._most_ticks:
            self._flush()
        self._ticks.append(tick)

    def _add_to_last(self, changes: dict[str, object]) -> None:
        if self._ticks:
            last = self._ticks[-1]
            # Other takers may hold this tick as well.
            self._ticks[-1] = replace(last, changes={**last.changes, **changes})

    def _flush(self) -> None:
        """Write the waiting ticks."""
        if not self._ticks:
            return
        batch = self._encoder.encode(self._ticks).batch()
        self._ticks = []
        with naming(self.path):
            try:
                self._writer.write_batch(batch)
                self._file.flush()
            except OSError:
                self._discard()
                raise

    def _release(self) -> None:
        if self._file.closed:
            return
        atexit.unregister(self._release)
        try:
            with naming(self.path), self._file:
                if self._ticks and (left := self.capture.events_left()):
                    self._add_to_last({"events": [*self._ticks[-1].changes.get("events", ()), *left]})
                self._flush()
                self._writer.close()
        except OSError:
            self._discard()
            raise

    def _discard(self) -> None:
        """Close a file that cannot be written, and remove its incomplete part."""
        atexit.unregister(self._release)
        # What is buffered cannot be written either.
        with suppress(OSError):
            self._file.close()
        if self.path.is_file():
            self.path.unlink()
