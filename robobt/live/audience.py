"""Those who watch, one of whom steers: what each asks for is done, refused or put before the match."""

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

from robobt.live.messages import MOST_REFUSED, Act, Layers, Past, Rest, Steer, read
from robobt.live.stream import Stream
from robobt.live.viewer import Viewer

MOST_VIEWERS = 50

_MOST_WAITING = 1000
"""Messages that wait for the match; more are refused."""


class Audience:
    """The viewers of a server; all but reading its attributes is for the server's thread.

    Args:
        changed: is called when there may be something else to send.

    Attributes:
        viewers: by their numbers.
        steerer: the one who steers.
        inbox: what that one asks for, for the match, and when it came (perf_counter) [s].
        refused: how many requests and messages were refused, by reason.
        layers: what viewers want skills to draw.
        stream, state: what they are shown, and how that goes.
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
        """Let every viewer be sent what is new."""
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
        """Let another steer; what is driven stops."""
        if self.steerer is not viewer:
            self.inbox.put((Rest(do="rest"), perf_counter()))
        self.steerer = viewer
        self._changed()

    def _look(self) -> None:
        """Tell the match what is looked at."""
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
                viewer.refused += reason != "not steering"
                if viewer.refused >= MOST_REFUSED:
                    await viewer.socket.close(CloseCode.POLICY_VIOLATION, "too many messages that are none")
                    return
        except ConnectionClosed:
            pass
        finally:
            viewer.news.set()

    def _obey(self, viewer: Viewer, data: str | bytes) -> str | None:
        """Do what a message asks for; return why not, None where it was done."""
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
        elif self.inbox.qsize() >= _MOST_WAITING:
            return "too many"
        else:
            self.inbox.put((message, perf_counter()))
        return None
