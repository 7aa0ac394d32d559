"""Waiting for another thread or process: as long as a busy machine may need, and not for ever."""

from __future__ import annotations

from collections.abc import Callable
from time import monotonic, sleep
from typing import TypeVar

Found = TypeVar("Found")

LIMIT = 300.0
"""How long that may be [s]; compiling for the first time on a busy machine takes a hundred."""


def soon(what: Callable[[], Found], said: str = "it") -> Found:
    """Return what is true at last.

    Raises:
        AssertionError: it did not come true within :data:`LIMIT`.
    """
    end = monotonic() + LIMIT
    while monotonic() < end:
        if found := what():
            return found
        sleep(0.01)
    raise AssertionError(f"did not come true within {LIMIT:g} s: {said}")
