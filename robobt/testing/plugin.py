"""Fixtures for pytest, which finds them by robobt's entry point ``pytest11``: no conftest names them.

What a fixture needs is imported when a test uses it, so that other tests start as quickly as before.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from robobt.skills.store import Store
    from robobt.testing.ticking import Ticker


def pytest_assertrepr_compare(op: str, left: object, right: object) -> list[str] | None:
    """Show wrong statuses of ``tick_on`` with what the skills said, where a test expects a list."""
    told = getattr(left, "differences", None)
    if op != "==" or told is None or type(left).__module__ != "robobt.testing.ticking":
        return None
    if not isinstance(right, list | tuple):
        return None
    lines: list[str] = told(right)
    return lines


@pytest.fixture
def make_store() -> Callable[..., Store]:
    """Return the function :func:`robobt.testing.make_store`, which makes a robot's store."""
    from robobt.testing.ticking import make_store

    return make_store


@pytest.fixture
def tick_on() -> Iterator[Ticker]:
    """Yield a function that ticks a skill or a tree on frames, see :class:`robobt.testing.Ticker`."""
    from robobt.testing.ticking import Ticker

    ticker = Ticker()
    yield ticker
    ticker.close()
