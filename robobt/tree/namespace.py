"""Private namespaces: two owners may use the same name for different objects in one process."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any


class Namespace:
    """An owner's registrations; inside :func:`within` they come before public ones.

    Two owners, such as two versions of a team's plays, may register the same names: each finds only its own,
    and others find neither.
    """

    def __init__(self) -> None:
        self._entries: dict[int, dict[str, Any]] = {}

    def of(self, registry: object) -> dict[str, Any]:
        """Return its own entries of a registry, by name."""
        return self._entries.setdefault(id(registry), {})


_current: ContextVar[Namespace | None] = ContextVar("namespace", default=None)


def current_namespace() -> Namespace | None:
    """Return the active namespace, or None."""
    return _current.get()


@contextmanager
def within(namespace: Namespace | None) -> Iterator[None]:
    """Register and look up names in a namespace inside the block; with None only public ones."""
    token = _current.set(namespace)
    try:
        yield
    finally:
        _current.reset(token)
