"""Who may see and steer: requests are checked before anything is answered.

A page of another site can send requests to this machine, and a name of its own can be made to
lead here (DNS rebinding). So the address holds a random token, the host has to be one that
was named, and a WebSocket has to come from a page of this server.
"""

from __future__ import annotations

import secrets
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

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
