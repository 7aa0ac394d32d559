"""A live match in a thread of the test's process, and clients of its page."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from time import monotonic, perf_counter
from typing import Any

from websockets.sync.client import ClientConnection, connect

from robobt.live.messages import Act
from robobt.live.server import Server
from robobt.live.session import Live
from robobt.match import MatchLoop
from robobt.match.scenario.scenario import Scenario, load_scenario
from robobt.worlds import sim_world
from tests.waiting import LIMIT, soon


@dataclass(slots=True)
class Session:
    """What is being played, and where it is shown."""

    server: Server
    live: Live
    matches: list[MatchLoop]

    @property
    def match(self) -> MatchLoop:
        return self.matches[-1]

    def act(self, act: Act) -> None:
        """Do what the viewer that steers might ask for."""
        self.server.inbox.put((act, perf_counter()))

    @property
    def ticks(self) -> int:
        return self.match.measures.ticks


@contextmanager
def playing(scenario: str | Scenario = "striker_vs_goalkeeper", **settings: Any) -> Iterator[Session]:
    """Play a scenario live, for ever, until the end of the block."""
    loaded = load_scenario(scenario) if isinstance(scenario, str) else scenario
    matches: list[MatchLoop] = []

    def make(trial: int) -> MatchLoop:
        matches.append(MatchLoop(loaded, 7 + trial, sim_world, trial=trial))
        return matches[-1]

    with Server() as server:
        live = Live(server, **settings)
        problems: list[BaseException] = []

        def run() -> None:
            try:
                live.play_on(make)
            except BaseException as error:
                problems.append(error)

        thread = threading.Thread(target=run)
        thread.start()
        try:
            soon(lambda: matches or problems)
            yield Session(server, live, matches)
        finally:
            live.end()
            thread.join()
        if problems:
            raise problems[0]


class Client:
    """A viewer without a page: what it was sent, by kind."""

    def __init__(self, url: str) -> None:
        host = url.split("/")[2]
        address = url.replace("http", "ws") + "socket"
        self._connecting = connect(address, origin=f"http://{host}", max_size=None)  # type: ignore[arg-type]
        self.socket: ClientConnection
        self.state: dict[str, Any] = {}
        self.hello: dict[str, Any] = {}
        self.chunks: list[dict[str, Any]] = []
        self.past: list[dict[str, Any]] | None = None
        self.refused: list[str] = []

    def __enter__(self) -> Client:
        self.socket = self._connecting.__enter__()
        return self

    def __exit__(self, *_: object) -> None:
        self._connecting.__exit__(None, None, None)

    def ask(self, **message: Any) -> None:
        self.socket.send(json.dumps(message))

    def read(self, until: Callable[[Client], Any]) -> Any:
        """Read what comes until something is true."""
        end = monotonic() + LIMIT
        while monotonic() < end:
            found = until(self)
            if found:
                return found
            try:
                message = json.loads(self.socket.recv(timeout=0.5))
            except TimeoutError:
                continue
            self._take(message)
        raise AssertionError(f"did not come true within {LIMIT:g} s")

    def _take(self, message: dict[str, Any]) -> None:
        match message["kind"]:
            case "hello":
                self.hello, self.chunks = message, []
            case "state":
                self.state = message
            case "now":
                self.chunks += message["chunks"]
            case "refused":
                self.refused.append(message["said"])
            case "past":
                self.past = (self.past or []) + message["chunks"]
