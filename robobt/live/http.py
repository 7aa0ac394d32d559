"""The live page's answers over HTTP: who may see and steer is checked first."""

from __future__ import annotations

import secrets
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from http import HTTPStatus
from importlib.resources import files
from pathlib import PurePosixPath
from typing import Literal

from websockets.asyncio.server import ServerConnection
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from robobt.live.page_files import page_text

LOOPBACK_HOSTS = ("127.0.0.1", "localhost", "[::1]")

Refusal = Literal["host", "token", "origin"]


@dataclass(slots=True, frozen=True)
class Access:
    """What a request has to show.

    Attributes:
        token: the first part of every path.
        hosts: the names by which this server may be called, with the port.
    """

    token: str
    hosts: frozenset[str]

    @classmethod
    def new(cls, names: Iterable[str], port: int) -> Access:
        """Return the access by these names to a port, with a new token."""
        return cls(secrets.token_urlsafe(16), frozenset(f"{name}:{port}".lower() for name in names))

    def refuses(self, hosts: list[str], path: str, origins: list[str] | None) -> Refusal | None:
        """Return what is wrong with a request, None where nothing is.

        Args:
            hosts: its ``Host`` headers.
            path: what it asks for.
            origins: its ``Origin`` headers; None where none is needed, as of one that only reads.
        """
        if len(hosts) != 1 or hosts[0].lower() not in self.hosts:
            return "host"
        token, _, _ = path.removeprefix("/").partition("/")
        if not secrets.compare_digest(token.encode(), self.token.encode()):
            return "token"
        if origins is not None and [origin.lower() for origin in origins] != [f"http://{hosts[0].lower()}"]:
            return "origin"
        return None


_MEDIA_TYPES = {".html": "text/html", ".css": "text/css", ".js": "text/javascript"}
_LIVE_HEAD = '<link rel="stylesheet" href="viewer.css">\n<link rel="icon" href="data:,">'
_LIVE_SCRIPTS = '<script type="module" src="live.js"></script>'

RECORDING_TYPE = "application/vnd.apache.arrow.stream"

_METHODS = (b"GET", b"HEAD")
_LONGEST_METHOD = 32
"""How many bytes may come before the first space of a request that is looked at."""


class PageConnection(ServerConnection):
    """A connection that refuses methods other than GET and HEAD.

    The method is read here because websockets closes the connection without an answer when a request
    has a body.
    """

    _begun = b""
    _method_known = False

    def data_received(self, data: bytes) -> None:
        """Pass the data on to websockets; first refuse the request if its method is not served."""
        if not self._method_known:
            data = self._begun = self._begun + data
            method, space, _ = data.partition(b" ")
            if not space and len(data) <= _LONGEST_METHOD:
                return
            self._method_known = True
            if method.isalpha() and method not in _METHODS:
                refusal = response(HTTPStatus.METHOD_NOT_ALLOWED, b"The page is only read.\n", "127.0.0.1")
                refusal.headers["Allow"] = b", ".join(_METHODS).decode()
                self.protocol.send_response(refusal)
        super().data_received(data)


def without_body(_: ServerConnection, request: Request, answer: Response) -> None:
    """Take the body out of the answer to a HEAD request."""
    # websockets tells the method from version 17 on; earlier ones let nothing but GET through.
    if getattr(request, "method", "GET") == "HEAD":
        answer.body = b""


def file_response(path: str, host: str) -> Response:
    """Return a file of the page; ``path`` is what follows the token, ``host`` how the server was called."""
    name = path or "index.html"
    if name not in _names():
        return response(HTTPStatus.NOT_FOUND, b"There is no such file.\n", host)
    return response(HTTPStatus.OK, _content(name), host, _MEDIA_TYPES[PurePosixPath(name).suffix])


def response(
    status: HTTPStatus, body: bytes, host: str, kind: str = "text/plain", attached: str | None = None
) -> Response:
    """Return an answer; ``attached`` is the file name of what is to be saved rather than shown."""
    policy = (
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src data:; "
        f"connect-src 'self' ws://{host}; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    )
    charset = "; charset=utf-8" if kind.startswith("text/") else ""
    headers = {
        "Content-Type": f"{kind}{charset}",
        "Content-Length": str(len(body)),
        "Content-Security-Policy": policy,
        "X-Content-Type-Options": "nosniff",
        "Referrer-Policy": "no-referrer",
        "Cross-Origin-Opener-Policy": "same-origin",
        "Cross-Origin-Resource-Policy": "same-origin",
        "Cache-Control": "no-store",
        "Connection": "close",
    }
    if attached is not None:
        headers["Content-Disposition"] = f'attachment; filename="{attached}"'
    return Response(status.value, status.phrase, Headers(headers), body)


@lru_cache(maxsize=1)
def _names() -> frozenset[str]:
    there = {each.name for each in files("robobt.live").joinpath("page").iterdir()}
    return frozenset({name for name in there if name.endswith((".js", ".css"))} | {"index.html"})


@lru_cache(maxsize=32)
def _content(name: str) -> bytes:
    if name != "index.html":
        return page_text(name).encode()
    page = page_text("viewer.html").replace("{{title}}", "robobt live")
    return page.replace("{{head}}", _LIVE_HEAD).replace("{{scripts}}", _LIVE_SCRIPTS).encode()
