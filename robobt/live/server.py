"""Serves the live page to browsers, in a thread of its own.

The match never waits for it: it puts ticks into a queue of its stream and takes what viewers
ask for from ``inbox``. WebSockets by `websockets`, which answers the few plain requests for files
as well: they need no framework beside it.
"""

from __future__ import annotations

import asyncio
import gc
import socket
import sys
import threading
from collections.abc import Iterable, Mapping
from contextlib import suppress
from http import HTTPStatus
from typing import TYPE_CHECKING, Any

from robobt.config.errors import RobobtError
from robobt.config.extras import MissingExtraError
from robobt.live.audience import MOST_VIEWERS, Audience
from robobt.live.http import (
    LOOPBACK_HOSTS,
    RECORDING_TYPE,
    Access,
    PageConnection,
    file_response,
    response,
    without_body,
)
from robobt.live.messages import MOST_MESSAGE_BYTES
from robobt.live.stream import Stream
from robobt.world.state import RobotId

if TYPE_CHECKING:
    from robobt.world.delay import MeasuredDelay

try:
    from websockets.asyncio.server import Server as SocketServer
    from websockets.asyncio.server import ServerConnection, serve
    from websockets.http11 import Request, Response
except ModuleNotFoundError as error:
    raise MissingExtraError("websockets", "live") from error

_BEAT = 1.0 / 60.0
"""Longest interval for checking new ticks while there are viewers [s]."""

_IDLE_BEAT = 0.5
"""Interval for checking new ticks without viewers [s]."""

_AFTER = 0.002
"""Delay after a tick's expected time before checking for it, when the match sleeps [s]."""

_KEPT_BY_SYSTEM = 2**17
"""Largest send buffer of the system per viewer [bytes]."""

_SWITCH = 0.0005
"""Longest time for which this thread may delay the match's thread [s]."""


class LiveError(RobobtError, OSError):
    """The live page cannot be served."""


class Server:
    """Serves the page of a stream. A context manager.

    Args:
        host: address to listen at; only this machine's own by default.
        port: by default a free one.
        names: further names or addresses by which browsers may call this machine.

    Attributes:
        url: where the page is, once it is served.
        audience: the viewers.
        inbox: the steering viewer's requests to the match, with their times of arrival (perf_counter) [s].
        refused: how many requests and messages were refused, by reason.
        situation: the scenario that was last made of the present situation, as YAML.

    Raises:
        LiveError: the address cannot be listened at.
    """

    def __init__(self, host: str = "127.0.0.1", port: int = 0, names: Iterable[str] = ()) -> None:
        self._host, self._port, self._names = host, port, (*LOOPBACK_HOSTS, *names)
        self.url = ""
        self.situation = ""
        self._said = self._forms = 0
        self.audience = Audience(self._look_now)
        self.inbox, self.refused = self.audience.inbox, self.audience.refused
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
        gc.unfreeze()
        sys.setswitchinterval(self._usual_switch)

    def show(self, stream: Stream) -> None:
        """Serve another match from now on, that of ``stream``."""
        self.audience.stream = stream

    def tell(self, **state: Any) -> None:
        """Send changes of the match's state to the viewers, as JSON data."""
        known = self.audience.state
        if any(known.get(name, self) != value for name, value in state.items()):
            self.audience.state = {**known, **state}

    def tell_delays(self, delays: Mapping[RobotId, MeasuredDelay | None]) -> None:
        """Send each robot's delay and half its 95 % interval [s]; if ``delays`` is empty, nothing."""
        if delays:
            told = {
                str(robot): None if it is None else [round(it.seconds, 4), round(it.high - it.seconds, 4)]
                for robot, it in delays.items()
            }
            self.tell(delays=told)

    def say(self, text: str) -> None:
        """Show the viewers a ``text`` for a moment."""
        self._said += 1
        self.tell(said=[self._said, text])

    def show_form(self, **form: Any) -> None:
        """Show a form: counted, so that a page sees one that is asked for again, in another match too."""
        self._forms += 1
        self.tell(form={"number": self._forms, **form})

    @property
    def layers(self) -> frozenset[str]:
        """Drawing layers that viewers watch."""
        return self.audience.layers

    @property
    def viewers(self) -> int:
        """Number of viewers."""
        return len(self.audience.viewers)

    def _run(self) -> None:
        try:
            asyncio.run(self._main())
        finally:
            # Waiting threads are notified in every case.
            self._ready.set()

    async def _main(self) -> None:
        self._loop, self._end, self._wake = asyncio.get_running_loop(), asyncio.Event(), asyncio.Event()
        self._saving = asyncio.Lock()
        serving = serve(
            self.audience.meet,
            self._host,
            self._port,
            process_request=self._answer,
            process_response=without_body,
            create_connection=PageConnection,
            max_size=MOST_MESSAGE_BYTES,
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
                for viewer in self.audience.viewers.values():
                    viewer.socket.transport.abort()
        except OSError as error:
            if self._ready.is_set():
                raise
            self._problem = error
            self._ready.set()

    def _listen(self, server: SocketServer) -> None:
        port = next(iter(server.sockets)).getsockname()[1]
        self._access = Access.new(self._names, port)
        shown = self._names[len(LOOPBACK_HOSTS)] if len(self._names) > len(LOOPBACK_HOSTS) else "127.0.0.1"
        self.url = f"http://{shown}:{port}/{self._access.token}/"

    def _look_now(self) -> None:
        assert self._wake is not None
        self._wake.set()

    async def _beat(self) -> None:
        """Encode new ticks and wake the viewers."""
        assert self._loop is not None
        assert self._wake is not None
        audience = self.audience
        before: tuple[object, ...] = ()
        while True:
            stream, fresh = audience.stream, False
            while stream is not None and stream.advance():
                fresh = True
                await asyncio.sleep(0)
            now = (stream, audience.state, audience.steerer, len(audience.viewers))
            if fresh or now != before:
                before = now
                audience.wake()
            waking = self._loop.call_later(self._pause(stream), self._wake.set)
            await self._wake.wait()
            waking.cancel()
            self._wake.clear()

    def _pause(self, stream: Stream | None) -> float:
        """Return in how long to look for new ticks again [s]."""
        if not self.audience.viewers:
            return _IDLE_BEAT
        due = -1.0 if stream is None else stream.until_next + _AFTER
        # Where none has come for long, the match is paused or over.
        return _BEAT if due < -_BEAT else min(_BEAT, max(_AFTER, due))

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
            if len(self.audience.viewers) < MOST_VIEWERS:
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
        if self.audience.stream is None or self._saving.locked():
            return response(HTTPStatus.SERVICE_UNAVAILABLE, b"Nothing to save now; try again.\n", host)
        async with self._saving:
            body = self.audience.stream.recording()
            return response(HTTPStatus.OK, body, host, RECORDING_TYPE, "live.robobt.arrows")
