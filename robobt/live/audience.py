"""The viewers, one of whom steers: each request is carried out, refused or passed to the match."""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Callable
from queue import SimpleQueue
from time import monotonic, perf_counter
from typing import Any

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed
from websockets.frames import CloseCode

from robobt.live.messages import MOST_REFUSED, RATE, Act, Layers, Past, Rest, Steer, read
from robobt.live.refusals import problem_with
from robobt.live.stream import Stream
from robobt.live.viewer import Viewer

MOST_VIEWERS = 50

_MOST_WAITING_MESSAGES = 1000
"""Largest number of messages waiting for the match; further ones are refused."""


_REASONS = {
    "not steering": 'Another viewer steers; {"do": "steer"} takes over.',
    "too many": f"A page may send {RATE:g} messages a second; this one was left out.",
}
"""Answers to refused messages, by the reason for which they are refused."""


class Audience:
    """The viewers of a server. Other threads may only read its attributes.

    Args:
        changed: called when there may be something new to send.

    Attributes:
        viewers: by their numbers.
        steerer: the viewer who steers.
        inbox: that viewer's requests to the match, with their times of arrival (perf_counter) [s].
        refused: how many requests and messages were refused, by reason.
        layers: drawing layers that viewers watch.
        stream, state: the stream shown to them, and the state of the match.
    """

    def __init__(self, changed: Callable[[], None]) -> None:
        self._changed = changed
        self._count = 0
        self.viewers: dict[int, Viewer] = {}
        self.steerer: Viewer | None = None
        self.inbox: SimpleQueue[tuple[Act, float]] = SimpleQueue()
        self.refused: Counter[str] = Counter()
        self.layers: frozenset[str] = frozenset()
        self.stream: Stream | None = None
        self.state: dict[str, Any] = {}

    def wake(self) -> None:
        """Wake all viewers to send what is new."""
        for viewer in self.viewers.values():
            viewer.news.set()

    async def meet(self, connection: ServerConnection) -> None:
        """Serve one viewer until it leaves."""
        self._count += 1
        viewer = Viewer(self._count, connection, monotonic())
        self.viewers[viewer.number] = viewer
        if self.steerer is None:
            self.steerer = viewer
        viewer.news.set()
        self._changed()
        reading = asyncio.create_task(self._read(viewer))
        try:
            while not reading.done():
                await viewer.news.wait()
                viewer.news.clear()
                await viewer.answer()
                if self.stream is not None:
                    await viewer.send(self.stream, self._state_for(viewer))
        except ConnectionClosed:
            pass
        finally:
            reading.cancel()
            said = connection.protocol.close_sent
            self.refused["too long"] += said is not None and said.code == CloseCode.MESSAGE_TOO_BIG
            del self.viewers[viewer.number]
            self._look()
            if self.steerer is viewer:
                self._steer(next(iter(self.viewers.values()), None))
            self._changed()

    def _steer(self, viewer: Viewer | None) -> None:
        """Let another viewer steer; a driven robot stops."""
        if self.steerer is not viewer:
            self.inbox.put((Rest(do="rest"), perf_counter()))
        self.steerer = viewer
        self._changed()

    def _look(self) -> None:
        """Send the watched layers to the match."""
        self.layers = frozenset[str]().union(*[viewer.layers for viewer in self.viewers.values()])

    def _state_for(self, viewer: Viewer) -> dict[str, Any]:
        return {**self.state, "steers": viewer is self.steerer, "viewers": len(self.viewers)}

    async def _read(self, viewer: Viewer) -> None:
        try:
            async for data in viewer.socket:
                reason = self._obey(viewer, data)
                if reason is None:
                    continue
                self.refused[reason] += 1
                viewer.told_off = _REASONS.get(reason) or problem_with(data)
                viewer.news.set()
                viewer.refused += reason != "not steering"
                if viewer.refused >= MOST_REFUSED:
                    await viewer.socket.close(CloseCode.POLICY_VIOLATION, "too many messages that are none")
                    return
        except ConnectionClosed:
            pass
        finally:
            viewer.news.set()

    def _obey(self, viewer: Viewer, data: str | bytes) -> str | None:
        """Carry out a message; return why it was refused, or None."""
        if not viewer.allowance.take(monotonic()):
            return "too many"
        message = read(data)
        if message is None:
            return "no message"
        if isinstance(message, Steer):
            self._steer(viewer)
        elif isinstance(message, Past):
            viewer.ask_past()
        elif isinstance(message, Layers):
            viewer.layers = frozenset(message.shown)
            self._look()
        elif viewer is not self.steerer:
            return "not steering"
        elif self.inbox.qsize() >= _MOST_WAITING_MESSAGES:
            return "too many"
        else:
            self.inbox.put((message, perf_counter()))
        return None
