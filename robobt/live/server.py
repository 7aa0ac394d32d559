"""Serves the live page to browsers, in a thread of its own.

The match never waits for it: it puts ticks into a queue of its stream and takes what viewers
ask for from ``inbox``. WebSockets by `websockets`, which answers the few plain requests for files
as well: they need no framework beside it.
"""

from __future__ import annotations

import asyncio
import socket
import sys
import threading
from collections import Counter
from collections.abc import Iterable
from contextlib import suppress
from http import HTTPStatus
from queue import SimpleQueue
from time import monotonic, perf_counter
from typing import Any

from websockets.asyncio.server import Server as SocketServer
from websockets.asyncio.server import ServerConnection, serve
from websockets.exceptions import ConnectionClosed
from websockets.frames import CloseCode
from websockets.http11 import Request, Response

from robobt.config.errors import RobobtError
from robobt.live.access import LOOPBACK, Access
from robobt.live.http import RECORDING_TYPE, file_response, response
from robobt.live.messages import MOST_BYTES, MOST_REFUSED, Act, Layers, Past, Rest, Steer, read
from robobt.live.stream import Stream
from robobt.live.viewer import Viewer

MOST_VIEWERS = 50

_BEAT = 1.0 / 60.0
"""How often new ticks are looked for while somebody watches [s]."""

_IDLE_BEAT = 0.5
"""The same while nobody does [s]."""

_MOST_WAITING = 1000
"""Messages that wait for the match; more are refused."""


_KEPT_BY_SYSTEM = 2**17
"""What the system keeps for a viewer at most [bytes]."""

_SWITCH = 0.0005
"""How long this thread may keep the match's from going on [s]."""


class LiveError(RobobtError, OSError):
    """The live page cannot be served."""


class Server:
    """Serves the page of whatever stream it is given. A context manager.

    Args:
        host: address to listen at; only this machine's own by default.
        port: by default a free one.
        names: further names or addresses by which browsers may call this machine.

    Attributes:
        url: where the page is, once it is served.
        inbox: what the viewer that steers asks for, for the match, and when that came (perf_counter) [s].
        refused: how many requests and messages were refused, by reason.
        layers: what viewers want skills to draw.
        situation: the scenario that was last made of the present situation, as YAML.

    Raises:
        LiveError: the address cannot be listened at.
    """

    def __init__(self, host: str = "127.0.0.1", port: int = 0, names: Iterable[str] = ()) -> None:
        self._host, self._port, self._names = host, port, (*LOOPBACK, *names)
        self.url = ""
        self.inbox: SimpleQueue[tuple[Act, float]] = SimpleQueue()
        self.refused: Counter[str] = Counter()
        self.layers: frozenset[str] = frozenset()
        self.situation = ""
        self._viewers: dict[int, Viewer] = {}
        self._count = 0
        self._steerer: Viewer | None = None
        self._stream: Stream | None = None
        self._state: dict[str, Any] = {}
        self._thread = threading.Thread(target=self._run, name="robobt live", daemon=True)
        self._ready = threading.Event()
        self._problem: OSError | None = None
        self._loop: asyncio.AbstractEventLoop | None = None
        self._end: asyncio.Event | None = None
        self._wake: asyncio.Event | None = None
        self._saving: asyncio.Lock | None = None

    def __enter__(self) -> Server:
        self._usual_switch = sys.getswitchinterval()
        sys.setswitchinterval(_SWITCH)
        self._thread.start()
        self._ready.wait()
        if self._problem is not None:
            reason = self._problem.strerror or str(self._problem)
            raise LiveError(f"cannot serve at {self._host}, port {self._port}: {reason}")
        return self

    def __exit__(self, *_: object) -> None:
        if self._loop is not None and self._end is not None:
            with suppress(RuntimeError):
                self._loop.call_soon_threadsafe(self._end.set)
        self._thread.join(timeout=5.0)
        sys.setswitchinterval(self._usual_switch)

    def show(self, stream: Stream) -> None:
        """Serve another match from now on."""
        self._stream = stream

    def tell(self, **state: Any) -> None:
        """Tell the viewers how the match goes: what changes of its state, as JSON can hold it."""
        if any(self._state.get(name, self) != value for name, value in state.items()):
            self._state = {**self._state, **state}

    @property
    def viewers(self) -> int:
        """How many watch."""
        return len(self._viewers)

    def _run(self) -> None:
        try:
            asyncio.run(self._main())
        finally:
            # Whoever waits for it is told, whatever has happened.
            self._ready.set()

    async def _main(self) -> None:
        self._loop, self._end, self._wake = asyncio.get_running_loop(), asyncio.Event(), asyncio.Event()
        self._saving = asyncio.Lock()
        serving = serve(
            self._meet,
            self._host,
            self._port,
            process_request=self._answer,
            max_size=MOST_BYTES,
            max_queue=16,
            write_limit=2**16,
            compression=None,
            server_header=None,
            # A browser that is busy for a minute is still there.
            ping_interval=30.0,
            ping_timeout=90.0,
            open_timeout=5.0,
            close_timeout=1.0,
        )
        try:
            async with serving as server:
                for listening in server.sockets:
                    # The system would keep megabytes for a viewer that reads nothing, who then sees the past.
                    listening.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, _KEPT_BY_SYSTEM)
                self._listen(server)
                self._ready.set()
                beat = asyncio.create_task(self._beat())
                await self._end.wait()
                beat.cancel()
                for viewer in self._viewers.values():
                    viewer.socket.transport.abort()
        except OSError as error:
            if self._ready.is_set():
                raise
            self._problem = error
            self._ready.set()

    def _listen(self, server: SocketServer) -> None:
        port = next(iter(server.sockets)).getsockname()[1]
        self._access = Access.new(self._names, port)
        shown = self._names[len(LOOPBACK)] if len(self._names) > len(LOOPBACK) else "127.0.0.1"
        self.url = f"http://{shown}:{port}/{self._access.token}/"

    async def _beat(self) -> None:
        """Encode what is new and wake the viewers."""
        assert self._wake is not None
        before: tuple[object, ...] = ()
        while True:
            stream, fresh = self._stream, False
            while stream is not None and stream.advance():
                fresh = True
                await asyncio.sleep(0)
            now = (stream, self._state, self._steerer, len(self._viewers))
            if fresh or now != before:
                before = now
                for viewer in self._viewers.values():
                    viewer.news.set()
            with suppress(TimeoutError):
                await asyncio.wait_for(self._wake.wait(), _BEAT if self._viewers else _IDLE_BEAT)
            self._wake.clear()

    async def _answer(self, _: ServerConnection, request: Request) -> Response | None:
        """Answer a plain request, or return None for a WebSocket."""
        path = request.path.partition("?")[0]
        wants_socket = path.endswith("/socket")
        headers = request.headers
        origins = headers.get_all("Origin") if wants_socket else None
        problem = self._access.refuses(headers.get_all("Host"), path, origins)
        if problem is not None:
            self.refused[problem] += 1
            return response(HTTPStatus.FORBIDDEN, b"This address is not served.\n", "127.0.0.1")
        host = headers["Host"].lower()
        if wants_socket:
            if len(self._viewers) < MOST_VIEWERS:
                return None
            self.refused["viewers"] += 1
            return response(HTTPStatus.SERVICE_UNAVAILABLE, b"Too many watch.\n", host)
        name = path.removeprefix(f"/{self._access.token}").removeprefix("/")
        if name == "situation.yaml" and self.situation:
            return response(HTTPStatus.OK, self.situation.encode(), host, "application/yaml", name)
        if name == "recording.robobt.arrows":
            return await self._recording(host)
        return file_response(name, host)

    async def _recording(self, host: str) -> Response:
        assert self._saving is not None
        if self._stream is None or self._saving.locked():
            return response(HTTPStatus.SERVICE_UNAVAILABLE, b"Nothing to save now; try again.\n", host)
        async with self._saving:
            body = self._stream.recording()
            return response(HTTPStatus.OK, body, host, RECORDING_TYPE, "live.robobt.arrows")

    async def _meet(self, connection: ServerConnection) -> None:
        """Serve one viewer until it leaves."""
        assert self._wake is not None
        self._count += 1
        viewer = Viewer(self._count, connection, monotonic())
        self._viewers[viewer.number] = viewer
        if self._steerer is None:
            self._steerer = viewer
        viewer.news.set()
        self._wake.set()
        reading = asyncio.create_task(self._read(viewer))
        try:
            while not reading.done():
                await viewer.news.wait()
                viewer.news.clear()
                if self._stream is not None:
                    await viewer.send(self._stream, self._state_for(viewer))
        except ConnectionClosed:
            pass
        finally:
            reading.cancel()
            said = connection.protocol.close_sent
            self.refused["too long"] += said is not None and said.code == CloseCode.MESSAGE_TOO_BIG
            del self._viewers[viewer.number]
            self._look()
            if self._steerer is viewer:
                self.inbox.put((Rest(do="rest"), perf_counter()))
                self._steerer = next(iter(self._viewers.values()), None)
            self._wake.set()

    def _look(self) -> None:
        """Tell the match what is looked at."""
        self.layers = frozenset[str]().union(*[viewer.layers for viewer in self._viewers.values()])

    def _state_for(self, viewer: Viewer) -> dict[str, Any]:
        return {**self._state, "steers": viewer is self._steerer, "viewers": len(self._viewers)}

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
            if self._steerer is not viewer:
                self.inbox.put((Rest(do="rest"), perf_counter()))
            self._steerer = viewer
            assert self._wake is not None
            self._wake.set()
        elif isinstance(message, Past):
            viewer.ask_past()
        elif isinstance(message, Layers):
            viewer.layers = frozenset(message.shown)
            self._look()
        elif viewer is not self._steerer:
            return "not steering"
        elif self.inbox.qsize() >= _MOST_WAITING:
            return "too many"
        else:
            self.inbox.put((message, perf_counter()))
        return None
