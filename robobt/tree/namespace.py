"""Names of one owner's: two may give different things the same name in one process."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any


class Namespace:
    """What an owner has registered; inside :func:`within` it comes before what everybody has.

    Two owners, such as two states of a team's plays, may register the same names: neither finds the
    other's, and nobody else finds either's.
    """

    def __init__(self) -> None:
        self._entries: dict[int, dict[str, Any]] = {}

    def of(self, registry: object) -> dict[str, Any]:
        """Return its own entries of a registry, by name."""
        return self._entries.setdefault(id(registry), {})


_current: ContextVar[Namespace | None] = ContextVar("namespace", default=None)


def current_namespace() -> Namespace | None:
    """Return whose names come first, None where nobody's do."""
    return _current.get()


@contextmanager
def within(namespace: Namespace | None) -> Iterator[None]:
    """Register and look up names in a namespace inside the block; with None only everybody's."""
    token = _current.set(namespace)
    try:
        yield
    finally:
        _current.reset(token)
