"""A recording shown in the live page, as if it were played now: for files too large for a page."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from queue import Empty

from robobt.live.controls import IDLE_POLL, Controls
from robobt.live.messages import Act, Reset, Seek
from robobt.live.server import Server
from robobt.live.stream import Stream
from robobt.match.recording import RecordingHeader
from robobt.match.recording.encoder import EncodedTicks
from robobt.match.recording.stream import TickChanges, open_stream, read_bytes
from robobt.signals import check


class RecordingPlayback:
    """Shows a recording at the viewers' pace, from a start time.

    Args:
        server: where it is watched.
        path: the recording.
        start: from where on [s]; what was before is not shown.
        speed: factor on real time.
        clock: the time in seconds.

    Raises:
        RecordingError: the file is no recording.
    """

    def __init__(
        self,
        server: Server,
        path: str | Path,
        start: float = 0.0,
        speed: float = 1.0,
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        self._server, self._path = server, Path(path)
        self._start = self._first = start
        self._controls = Controls(server, speed)
        self._clock = clock
        self._again = self._ended = False
        self._data = read_bytes(self._path)
        _, batches = open_stream(self._data, self._path)
        ends = [(each.column(0)[0].as_py(), each.column(0)[-1].as_py()) for each in batches if len(each)]
        self._span = [ends[0][0], ends[-1][1]] if ends else None

    def end(self) -> None:
        """End it; may be called by any thread."""
        self._ended = True

    def show(self) -> None:
        """Show it, and again at a viewer's request, until :meth:`end`."""
        while not self._ended:
            self._again = False
            self._once()
            self._server.tell(over="the recording's end")
            while not (self._again or self._ended):
                self._idle()

    def _once(self) -> None:
        header, ticks = self._ticks()
        stream = Stream(header)
        self._server.show(stream)
        self._server.tell(
            over=None, movable=False, orders=False, plays=[], form=None, driven=None, span=self._span
        )
        self._controls.tell()
        due, before = self._clock(), self._start
        for tick in ticks:
            if tick.times[0] < self._start:
                # As a tick before all: what holds from then on.
                stream.remember(tick)
                continue
            due += max(0.0, tick.times[0] - before) / self._controls.speed
            before = tick.times[0]
            while self._controls.wait and not (self._again or self._ended):
                self._idle()
                due = self._clock()
            while not self._server.inbox.empty():
                self._do(self._server.inbox.get_nowait()[0])
            if self._again or self._ended:
                return
            ahead = due - self._clock()
            if ahead > 0.0:
                time.sleep(ahead)
            elif ahead < -1.0:
                due = self._clock()
            self._controls.ticked()
            stream.add(tick)

    def _ticks(self) -> tuple[RecordingHeader, Iterator[EncodedTicks]]:
        header, batches = open_stream(self._data, self._path)

        def ticks() -> Iterator[EncodedTicks]:
            for batch in batches:
                times, truth, observed, commands, changes, detections = batch.columns
                if observed.null_count:
                    observed = truth
                texts = changes.to_pylist()
                for i, time_ in enumerate(times.to_pylist()):
                    shown = truth[i : i + 1]
                    yield EncodedTicks(
                        [time_],
                        shown,
                        shown if observed is truth else observed[i : i + 1],
                        commands[i : i + 1],
                        [_changes(texts[i])],
                        detections[i : i + 1],
                    )

        return header, ticks()

    def _idle(self) -> None:
        check()
        with suppress(Empty):
            self._do(self._server.inbox.get(timeout=IDLE_POLL)[0])

    def _do(self, act: Act) -> None:
        match act:
            case Reset():
                self._start, self._again = self._first, True
            case Seek(time=time):
                self._start, self._again = time, True
            case _:
                self._controls.take(act)


def _changes(text: str | None) -> dict[str, object]:
    """Return what changed at a tick as encoders give it."""
    if text is None:
        return {}
    changes = TickChanges.model_validate_json(text)
    return {name: getattr(changes, name) for name in changes.model_fields_set if name != "outcome"}
