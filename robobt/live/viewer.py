"""One viewer: sends it what is new, or the present where it cannot keep up."""

from __future__ import annotations

import asyncio
import json
from typing import Any

from websockets.asyncio.server import ServerConnection

from robobt.live.messages import Allowance
from robobt.live.stream import Stream

_BEHIND = 30
"""Messages by which a viewer may be behind before it is sent the present instead."""

_AT_ONCE = 2**16
"""What it is sent at once [bytes]."""

_PAST_AT_ONCE = 2**14
"""The same of the past, which must not hold up the present [bytes]."""


class Viewer:
    """A viewer and how much of the match it has seen.

    What it is sent waits for it to read: nothing is piled up for one that does not.

    Attributes:
        number: in the order in which viewers came.
        news: set whenever there may be something new to send.
        layers: what it wants skills to draw.
        refused: messages of it that were refused.
        skipped: how often it could not keep up and was sent the present instead.
    """

    def __init__(self, number: int, socket: ServerConnection, now: float) -> None:
        self.number, self.socket = number, socket
        self.news = asyncio.Event()
        self.allowance = Allowance(now)
        self.layers: frozenset[str] = frozenset()
        self.refused = self.skipped = 0
        self._stream: Stream | None = None
        self._told: dict[str, Any] = {}
        self._next = 0
        # Numbers of the next message of the past and of the one after its last; the page asks for it.
        self._past, self._past_end = 0, 0
        self._joined = 0

    def ask_past(self) -> None:
        """Send what was kept before this viewer came."""
        if self._stream is not None:
            self._past, self._past_end = self._stream.first, self._joined
        self.news.set()

    async def send(self, stream: Stream, state: dict[str, Any]) -> None:
        """Send what there is to send now, and wait until it is on its way."""
        if stream is not self._stream:
            await self._begin(stream)
        if state != self._told:
            self._told = state
            await self._json({"kind": "state", **state})
        if self._next < stream.end:
            await self._send_new(stream)
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
        present = stream.present()
        if present is not None:
            await self._chunks("now", [present])

    async def _send_new(self, stream: Stream) -> None:
        if stream.end - self._next > _BEHIND:
            self.skipped += 1
            self._next, present = stream.end, stream.present()
            found = [] if present is None else [present]
        else:
            found, self._next = stream.messages(self._next, _AT_ONCE)
        if self._next < stream.end:
            self.news.set()
        await self._chunks("now", found)

    async def _chunks(self, kind: str, chunks: list[bytes], done: bool = False) -> None:
        start = f'{{"kind":"{kind}","done":{str(done).lower()},"chunks":['.encode()
        await self.socket.send(start + b",".join(chunks) + b"]}", text=True)

    async def _json(self, data: dict[str, Any]) -> None:
        await self.socket.send(json.dumps(data, separators=(",", ":"), allow_nan=False))
