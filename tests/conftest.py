"""What holds for all tests."""

from __future__ import annotations

import logging
from collections.abc import Iterator

import pytest


@pytest.fixture(autouse=True)
def _the_log_as_it_was() -> Iterator[None]:
    """A command that ran in this process has set how much is logged; the next test starts afresh."""
    log = logging.getLogger("robobt")
    level, propagate = log.level, log.propagate
    yield
    log.setLevel(level)
    log.propagate = propagate
