"""The viewers, one of whom steers: each request is carried out, refused or passed to the match."""

from __future__ import annotations

import asyncio
from collections import Counter
from collections.abc import Callable
from queue import SimpleQueue
from time import monotonic, perf_counter
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails
from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed
from websockets.frames import CloseCode

from robobt.config.errors import one_line, short_repr
from robobt.live.messages import (
    FORMS,
    MOST_MESSAGE_BYTES,
    MOST_REFUSED,
    RATE,
    READER,
    Act,
    Layers,
    Past,
    Rest,
    Steer,
    read,
)
from robobt.live.stream import Stream
from robobt.live.viewer import Viewer


def problem_with(data: str | bytes) -> str:
    """Return what is wrong with a message that is refused, for whoever sent it.

    Args:
        data: the message, of which :func:`robobt.live.messages.read` returns none.
    """
    if len(data) > MOST_MESSAGE_BYTES:
        return f"A message has at most {MOST_MESSAGE_BYTES} bytes."
    try:
        READER.validate_json(data)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        asked = next(iter(first["loc"]), "")
        if asked in FORMS:
            fields = [name for name in FORMS[str(asked)].model_fields if name != "do"]
            takes = ", ".join(fields) or "nothing"
            return f"{asked}: {_said_of(first)}. The message takes: {takes}."
    return f'A message is a JSON object whose "do" is one of: {", ".join(FORMS)}.'


def _said_of(problem: ErrorDetails) -> str:
    """Return in words which field of a message is wrong, what it may be, and what it is."""
    place = one_line(".".join(map(str, problem["loc"][1:])), 40)
    kind = problem["type"]
    if kind == "missing":
        return f"{place} is missing"
    if kind == "extra_forbidden":
        return f"it has no {place}"
    allowed = _MUST_BE.get(kind, "something else").format(**problem.get("ctx", {}))
    return f"{place} must be {one_line(allowed, 200)}, not {short_repr(problem['input'])}"


_MUST_BE = {
    **dict.fromkeys(("bool_type", "bool_parsing"), "true or false"),
    **dict.fromkeys(("int_type", "int_parsing", "int_parsing_size", "int_from_float"), "a whole number"),
    **dict.fromkeys(("float_type", "float_parsing", "finite_number"), "a number"),
    "greater_than_equal": "at least {ge:g}",
    "less_than_equal": "at most {le:g}",
    "string_type": "a text",
    "string_too_long": "at most {max_length} characters long",
    "string_pattern_mismatch": 'a robot, such as "blue 1"',
    "enum": "{expected}",
    "literal_error": "{expected}",
    "dict_type": "an object",
    "list_type": "a list",
    "too_long": "at most {max_length} entries long",
}
"""What a field may be, by pydantic's types of errors."""


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
