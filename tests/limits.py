"""No test waits for ever: one that hangs fails, and a process that cannot even fail is ended."""

from __future__ import annotations

import faulthandler
import os
import signal
import sys
from collections.abc import Iterator

import pytest

_LET_GO = 60.0
"""How long a test that has failed, or a process without further tests, may take to end [s]."""

_STDERR = pytest.StashKey[int]()


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--patience",
        type=float,
        default=600.0,
        help="A test that is still running after so many seconds fails; 0 waits for ever, as for a debugger.",
    )


def pytest_configure(config: pytest.Config) -> None:
    # Output is captured while a test runs, and lost when the process is ended.
    config.stash[_STDERR] = os.dup(sys.__stderr__.fileno())  # type: ignore[union-attr]


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """Fail a test that runs for too long where it is, and end the process if it does not let go."""
    patience = item.config.getoption("--patience")
    if not patience or item.get_closest_marker("slow") or not hasattr(signal, "SIGALRM"):
        return (yield)

    def fail(*_: object) -> None:
        pytest.fail(f"still running after {patience:g} s")

    before = signal.signal(signal.SIGALRM, fail)
    signal.setitimer(signal.ITIMER_REAL, patience)
    _end_after(patience + _LET_GO, item.config)
    try:
        return (yield)
    finally:
        faulthandler.cancel_dump_traceback_later()
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def pytest_unconfigure(config: pytest.Config) -> None:
    """End the process if threads or functions registered with ``atexit`` keep it from ending."""
    # A worker of pytest-xdist waits for the others, and is ended by the process that started it.
    if config.getoption("--patience") and not hasattr(config, "workerinput"):
        _end_after(_LET_GO, config)


def _end_after(seconds: float, config: pytest.Config) -> None:
    """End the process in so long, with the stacks of its threads, unless that is cancelled before."""
    faulthandler.dump_traceback_later(seconds, exit=True, file=config.stash[_STDERR])
