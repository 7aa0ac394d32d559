"""One viewer: sends new messages, or the present state if the viewer cannot keep up."""

from __future__ import annotations

import asyncio
import json
from typing import Any

from websockets.asyncio.server import ServerConnection

from robobt.live.messages import Allowance
from robobt.live.stream import Stream

_MOST_MESSAGES_BEHIND = 30
"""Number of messages by which a viewer may be behind before it gets the present state instead."""

_BYTES_AT_ONCE = 2**16
"""Bytes sent at once."""

_PAST_AT_ONCE = 2**14
"""Bytes of the past sent at once, which must not delay the present."""


class Viewer:
    """A viewer and how much of the match it has seen.

    Sending waits until the viewer reads, so that nothing accumulates for a viewer that does not.

    Attributes:
        number: number of the viewer, in order of arrival.
        news: event set when there may be something new to send.
        layers: drawing layers that it watches.
        refused: number of refused messages.
        told_off: why its last message was refused, until that has been sent; "" for nothing to send.
        skipped: number of times it could not keep up and got the present state instead.
    """

    def __init__(self, number: int, socket: ServerConnection, now: float) -> None:
        self.number, self.socket = number, socket
        self.news = asyncio.Event()
        self.allowance = Allowance(now)
        self.layers: frozenset[str] = frozenset()
        self.refused = self.skipped = 0
        self.told_off = ""
        self._stream: Stream | None = None
        self._told: dict[str, Any] = {}
        self._next = self._moves = 0
        # Numbers of the next message of the past and of the one after its last; the page asks for it.
        self._past, self._past_end = 0, 0
        self._joined = 0

    def ask_past(self) -> None:
        """Send the messages stored before this viewer came."""
        if self._stream is not None:
            self._past, self._past_end = self._stream.first, self._joined
        self.news.set()

    async def answer(self) -> None:
        """Say why a message was refused; of several that came at once only the last is answered."""
        if self.told_off:
            said, self.told_off = self.told_off, ""
            await self._json({"kind": "refused", "said": said})

    async def send(self, stream: Stream, state: dict[str, Any]) -> None:
        """Send all new messages, and wait until they are on their way."""
        if stream is not self._stream:
            await self._begin(stream)
        if state != self._told:
            self._told = state
            await self._json({"kind": "state", **state})
        if self._next < stream.end:
            await self._send_new(stream)
        if self._next == stream.end and stream.stands and self._moves != stream.moves:
            await self._send_present(stream)
        if self._past < self._past_end:
            found, self._past = stream.messages(self._past, _PAST_AT_ONCE)
            # Where the viewer came in, its own present begins.
            found = found[: len(found) - max(0, self._past - self._past_end)]
            done = self._past >= self._past_end
            await self._chunks("past", found, done)
            self.news.set()

    async def _begin(self, stream: Stream) -> None:
        self._stream, self._told = stream, {}
        self._past = self._past_end = 0
        self._next = self._joined = stream.end
        await self._json({"kind": "hello", "past": stream.end > stream.first, **stream.header})
        await self._send_present(stream)

    async def _send_present(self, stream: Stream) -> None:
        self._moves = stream.moves
        present = stream.present()
        if present is not None:
            await self._chunks("now", [present])

    async def _send_new(self, stream: Stream) -> None:
        if stream.end - self._next > _MOST_MESSAGES_BEHIND:
            self.skipped += 1
            self._next, present = stream.end, stream.present()
            found = [] if present is None else [present]
        else:
            found, self._next = stream.messages(self._next, _BYTES_AT_ONCE)
        if self._next < stream.end:
            self.news.set()
        await self._chunks("now", found)

    async def _chunks(self, kind: str, chunks: list[bytes], done: bool = False) -> None:
        start = f'{{"kind":"{kind}","done":{str(done).lower()},"chunks":['.encode()
        await self.socket.send(start + b",".join(chunks) + b"]}", text=True)

    async def _json(self, data: dict[str, Any]) -> None:
        await self.socket.send(json.dumps(data, separators=(",", ":"), allow_nan=False))
