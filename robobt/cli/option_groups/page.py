"""The options of commands that show something in the browser."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import typer

from robobt.cli.common import errors, warn
from robobt.cli.options import option
from robobt.config.extras import need

if TYPE_CHECKING:
    from robobt.live.server import Server


LOOPBACK_HOST = "127.0.0.1"
"""This machine alone."""


@dataclass(frozen=True)
class Page:
    """Where the live page is served."""

    host: Annotated[
        str,
        option(
            "--host",
            ". With any other than this machine's own, whoever can reach it and knows the page's address "
            "watches and steers, unencrypted",
        ),
    ] = LOOPBACK_HOST
    port: Annotated[int, option("--port", min=0, max=65535)] = 0
    open_page: Annotated[bool | None, option("--open")] = None

    def check(self, live: bool) -> None:
        """Refuse options that would do nothing without --live."""
        given = {
            "--host": self.host != LOOPBACK_HOST,
            "--port": self.port != 0,
            "--open": self.open_page is not None,
        }
        for name, there in given.items():
            if there and not live:
                raise typer.BadParameter("is for --live", param_hint=name)

    @contextmanager
    def server(self) -> Iterator[Server]:
        """Serve the live page, say where, and open it where that is wanted."""
        need("live", "pyarrow", "websockets")
        from robobt.live.server import Server

        own = self.host in ("127.0.0.1", "localhost", "::1")
        names = () if own else tuple(_names_of(self.host))
        with Server(self.host, self.port, names) as server:
            # What is printed on stdout may be read by a program.
            errors.print(f"Live: {server.url}", soft_wrap=True)
            if not own:
                warn(
                    f"the page is open to every machine that can reach {self.host}: whoever has its address "
                    "watches and steers, and nothing is encrypted"
                )
            if _desktop() if self.open_page is None else self.open_page:
                import webbrowser

                webbrowser.open(server.url)
            yield server


def _names_of(host: str) -> Iterator[str]:
    """Give the names by which other machines may call this one."""
    import socket

    if host in ("0.0.0.0", "::"):
        yield socket.gethostname()
        yield from sorted({str(info[4][0]) for info in socket.getaddrinfo(socket.gethostname(), None)})
    else:
        yield host


def _desktop() -> bool:
    return sys.platform in ("darwin", "win32") or bool(
        os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    )
