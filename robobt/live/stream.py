"""A match as messages for viewers, with its last minutes stored.

Ticks come from the match's thread, which only puts them into a queue; all else is done by the
thread that calls :meth:`Stream.advance`. Each message is one chunk of ticks
(:mod:`robobt.live.page_data`). Every few seconds a chunk is *whole*: it tells at its first tick all
that holds then, so that a viewer can begin there, and the recording that is saved as well.
"""

from __future__ import annotations

import json
import time
from collections import deque
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
from pydantic import JsonValue

from robobt.live.page_data import ChunkEncoder, header_data
from robobt.live.standing import Present, standing
from robobt.match.recording import Recording, RecordingHeader, RobotFlag
from robobt.match.recording.capture import Capture, CapturedTick
from robobt.match.recording.encoder import EncodedTicks, TickEncoder
from robobt.match.recording.numbers import COMMAND_NUMBERS, TickNumbers, numbers_of
from robobt.match.recording.reader import poses_of
from robobt.match.recording.recording import Timeline
from robobt.match.recording.stream import new_stream
from robobt.world.game import GameState
from robobt.world.sketch import Shape

PROTOCOL_VERSION = 1
"""Of the messages between server and page."""

KEPT_TIME = 300.0
"""How far back a viewer can go [s]."""

_SEGMENT = 5.0
"""Time between two whole chunks [s]."""

_MOST_BYTES = 96 * 2**20
"""Largest stored size of a match [bytes]."""

_MOST_WAITING_TICKS = 20_000
"""Largest number of ticks waiting to be encoded, reached only if the server's thread is dead."""

_TICKS_PER_MESSAGE = 60
"""Largest number of ticks in a message."""


@dataclass(slots=True)
class _Segment:
    """Some seconds of a match: the messages, and the rows of its recording."""

    start: float
    messages: list[bytes] = field(default_factory=list)
    batches: list[pa.RecordBatch] = field(default_factory=list)
    closed: pa.RecordBatch | None = None
    size: int = 0

    def rows(self) -> pa.RecordBatch:
        if self.closed is not None:
            return self.closed
        return pa.Table.from_batches(self.batches).combine_chunks().to_batches()[0]

    def close(self) -> None:
        """Keep one batch of all rows, which takes less room."""
        self.closed = self.rows()
        self.batches.clear()
        self.size += self.closed.nbytes


class Stream:
    """The messages of one match.

    Args:
        source: a match that is captured, or the header of ticks that are added.
        after: the stream of the same match until now, with the same robots; its last tick is shown until
            this one has a tick.

    Attributes:
        header: the constant part, as sent to the page.
        first: number of the oldest message that is kept.
        end: number of the next message.
        moves: number of times that :meth:`stand` has changed the present.
    """

    def __init__(self, source: Capture | RecordingHeader, after: Stream | None = None) -> None:
        self._encoder: TickEncoder | None = None
        if isinstance(source, Capture):
            self._encoder = TickEncoder(source)
            source.takers.append(self.take)
        self._header: RecordingHeader = source.header if isinstance(source, Capture) else source
        self._chunks = ChunkEncoder(self._header)
        self._present = Present()
        self._waiting: deque[tuple[float, CapturedTick]] = deque(maxlen=_MOST_WAITING_TICKS)
        self._encoded: deque[tuple[float, EncodedTicks]] = deque(maxlen=_MOST_WAITING_TICKS)
        self._segments: deque[_Segment] = deque()
        self._last: EncodedTicks | None = None if after is None else after._last
        self._numbers = TickNumbers([robot.id for robot in self._header.robots])
        # Where things stand before the next tick: as the match told it, and encoded.
        self._told: bytes | None = None
        self._newest: bytes | None = None if after is None else after._newest
        self._standing: pa.Array | None = None if after is None else after._standing
        if after is not None:
            self._present.follow(after._present.lasting)
        self.header: dict[str, Any] = {"version": PROTOCOL_VERSION, **header_data(self._header, paths=True)}
        self.first = self.end = self.moves = 0
        # When the newest tick came, and how long after the one before [s].
        self._came = self._gap = 0.0

    @property
    def until_next(self) -> float:
        """Expected time until the next tick [s]."""
        return self._came + self._gap - time.time()

    def take(self, tick: CapturedTick) -> None:
        """Take the next tick; called by the match."""
        self._told, self._newest = None, tick.truth
        self._waiting.append((time.time(), tick))

    def stand(self, truth: bytes, before: bytes | None = None) -> None:
        """Show where things are until the next tick, which is no tick itself; called by the match.

        Args:
            truth: the true frame, packed from blue's side.
            before: the one before anything was moved; what has not moved since is shown as at the last tick.
        """
        shown = self._newest
        self._told = truth if before is None or shown is None else standing(shown, before, truth)

    @property
    def stands(self) -> bool:
        """Whether the present is where things stand before the next tick, not the newest tick."""
        return self._standing is not None

    def add(self, ticks: EncodedTicks) -> None:
        """Add ticks that are already encoded."""
        self._encoded.append((time.time(), ticks))

    def remember(self, ticks: EncodedTicks) -> None:
        """Take the state after ticks that are not shown, before any tick is added."""
        for changes in ticks.changes:
            self._present.follow(changes)

    def advance(self) -> bool:
        """Encode the next ticks that wait as one message; whether there were any."""
        found = self._next()
        if found is None:
            return self._stand()
        self._standing = None
        at, ticks = found
        self._gap, self._came = (at - self._came) / len(ticks.times), at
        self._present.follow(ticks.changes[0])
        whole = not self._segments or ticks.times[0] >= self._segments[-1].start + _SEGMENT
        if whole:
            self._begin_segment(ticks)
        for changes in ticks.changes[1:]:
            self._present.follow(changes)
        message = _message(ticks, self._header, self._chunks, whole, at)
        segment = self._segments[-1]
        segment.messages.append(message)
        # At once, and not all of a segment at its end, which would hold up the match as well.
        segment.batches.append(ticks.batch())
        segment.size += len(message)
        self._last = ticks
        self.end += 1
        return True

    def _stand(self) -> bool:
        """Encode where things stand, if the match has told it since."""
        told, self._told = self._told, None
        if told is None:
            return False
        self._standing = self._numbers.poses([told])
        self.moves += 1
        return True

    def _next(self) -> tuple[float, EncodedTicks] | None:
        """Return the ticks of the next message, and when the last of them came [s]."""
        if self._encoder is None:
            return self._encoded.popleft() if self._encoded else None
        waiting = [self._waiting.popleft() for _ in range(min(_TICKS_PER_MESSAGE, len(self._waiting)))]
        return (waiting[-1][0], self._encoder.encode([tick for _, tick in waiting])) if waiting else None

    def messages(self, start: int, most: int) -> tuple[list[bytes], int]:
        """Return kept messages from number ``start`` on and the number of the one after them.

        They take ``most`` bytes, or one message more than that.
        """
        number, found = self.first, []
        start = max(start, number)
        for segment in self._segments:
            for message in islice(segment.messages, max(0, start - number), None):
                found.append(message)
                most -= len(message)
                if most < 0:
                    return found, start + len(found)
            number += len(segment.messages)
        return found, start + len(found)

    def present(self) -> bytes | None:
        """Return the present as a whole chunk of one tick; None before anything can be shown."""
        last, standing = self._last, self._standing
        if last is not None:
            times, commands = last.times[-1:], last.commands[-1:]
            truth = last.truth[-1:] if standing is None else standing
        elif standing is not None:
            times, commands, truth = [0.0], self._numbers.commands([{}]), standing
        else:
            return None
        tick = EncodedTicks(times, truth, truth, commands, [self._present.changes()])
        return _message(tick, self._header, ChunkEncoder(self._header), True, time.time())

    def recording(self) -> bytes:
        """Return the stored part as a recording."""
        sink = pa.BufferOutputStream()
        with new_stream(sink, self._header) as writer:
            for segment in self._segments:
                writer.write_batch(segment.rows())
        return bytes(sink.getvalue())

    def _begin_segment(self, ticks: EncodedTicks) -> None:
        if self._segments:
            self._segments[-1].close()
        # The first tick tells all that holds, and what has happened.
        events = {name: ticks.changes[0][name] for name in ("events",) if name in ticks.changes[0]}
        ticks.changes[0] = {**self._present.changes(), **events}
        self._segments.append(_Segment(ticks.times[0]))
        while len(self._segments) > 2 and (
            self._segments[1].start < ticks.times[0] - KEPT_TIME
            or sum(segment.size for segment in self._segments) > _MOST_BYTES
        ):
            self.first += len(self._segments.popleft().messages)


def _message(
    ticks: EncodedTicks, header: RecordingHeader, encoder: ChunkEncoder, whole: bool, at: float
) -> bytes:
    """Return a chunk as the page is sent it; ``at`` is the wall clock's time of its last tick [s]."""
    piece = _as_recording(ticks, header)
    chunk: dict[str, Any] = encoder.chunk(piece, piece.statuses, piece.feedback)
    chunk["robots"] = [{name: told for name, told in robot.items() if told} for robot in chunk["robots"]]
    chunk |= {"whole": whole, "at": round(1000.0 * at, 1)}
    return json.dumps(chunk, separators=(",", ":"), allow_nan=False).encode()


def _as_recording(ticks: EncodedTicks, header: RecordingHeader) -> Recording:
    """Return ticks as what would be read of their recording."""
    slots = {str(robot.id): slot for slot, robot in enumerate(header.robots)}
    truth = poses_of([numbers_of(ticks.truth)], len(slots))
    commands = numbers_of(ticks.commands).reshape(len(ticks.times), len(slots), COMMAND_NUMBERS)
    letters: list[Timeline[str]] = [[] for _ in slots]
    feedback: list[Timeline[dict[int, str]]] = [[] for _ in slots]
    written: dict[str, Timeline[dict[str, JsonValue]]] = {}
    drawn: dict[str, Timeline[list[Shape]]] = {}
    games: Timeline[GameState] = []
    events = []
    for tick, changes in enumerate(ticks.changes):
        for robot, statuses in changes.get("statuses", {}).items():
            letters[slots[robot]].append((tick, statuses))
        for robot, said in changes.get("feedback", {}).items():
            feedback[slots[robot]].append((tick, said))
        for owner, values in changes.get("written", {}).items():
            written.setdefault(owner, []).append((tick, values))
        for owner, shapes in changes.get("drawn", {}).items():
            drawn.setdefault(owner, []).append((tick, shapes))
        if "game" in changes:
            games.append((tick, changes["game"]))
        events += changes.get("events", ())
    return Recording(
        path=Path("live"),
        header=header,
        times=np.array(ticks.times),
        truth=truth,
        observed=None,
        flags=commands[:, :, -1].astype(np.uint8) | truth.contact * np.uint8(RobotFlag.BALL_CONTACT),
        commands=commands[:, :, :-1],
        letters=letters,
        feedback=feedback,
        written=written,
        drawn=drawn,
        games=games,
        touches=[],
        events=events,
        outcome=None,
    )
