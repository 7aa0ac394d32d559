"""What holds for all tests."""

from __future__ import annotations

import functools
import gc
import logging
import multiprocessing
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, suppress
from multiprocessing import resource_tracker
from pathlib import Path

import pytest
import typer.testing
from hypothesis import HealthCheck, settings

from robobt.config.telling import OFTEN
from robobt.signals import TERMINATE
from tests import workers

pytest_plugins = ("tests.limits", "robobt.testing.plugin")

# Terminals and services that run tests set these, and commands print otherwise.
for _name in ("COLUMNS", "LINES", "FORCE_COLOR", "NO_COLOR", "PY_COLORS", "GITHUB_ACTIONS"):
    os.environ.pop(_name, None)

# Each worker of the suite has a core; threads of numeric libraries would only wait for those of the others.
for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

# An application is made into commands by reading all its functions, which takes longer than most commands.
typer.testing._get_command = functools.cache(typer.testing._get_command)  # type: ignore[attr-defined]

# The same examples in every run, however long each takes on a busy machine.
settings.register_profile(
    "robobt", derandomize=True, deadline=None, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("robobt")

workers.fork_workers()

StartPython = Callable[..., "subprocess.Popen[str]"]


# What is imported and collected stays to the end. Without this, garbage would be looked for among all of it,
# two million objects, again and again: while it is collected, and by each live match that begins.
gc.disable()


def pytest_collection_finish() -> None:
    """Look for garbage from now on, but only among what tests make."""
    gc.freeze()
    # Seldom: most tests make no garbage that refers to itself.
    gc.set_threshold(20_000, 10, 10)
    gc.enable()
    gc.freeze = gc.unfreeze = lambda: None
    # pytest puts its handlers on the root and on each logger that tells it nothing, as torch's fifty do, six
    # times a test.
    for name, log in logging.root.manager.loggerDict.items():
        if name.startswith("torch") and isinstance(log, logging.Logger):
            log.propagate = True


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--moments", type=int, default=20, help="How often the slow tests of endings end a match."
    )


@pytest.fixture
def moments(request: pytest.FixtureRequest) -> int:
    """How many random moments a slow test tries."""
    return int(request.config.getoption("--moments"))


@pytest.fixture(autouse=True)
def _the_log_as_it_was() -> Iterator[None]:
    """A command that ran in this process has set how much is logged; the next test starts afresh."""
    logs = [logging.getLogger(name) for name in ("robobt", *OFTEN)]
    before = [(log.level, log.propagate) for log in logs]
    yield
    for log, (level, propagate) in zip(logs, before, strict=True):
        if log.level != level:
            # It makes all loggers forget what they have looked up.
            log.setLevel(level)
        log.propagate = propagate


@pytest.fixture
def signals_of_a_terminal() -> Iterator[None]:
    """Signals end processes, also where nohup or a script's background has them ignored from the start."""
    usual = {signal.SIGINT: signal.default_int_handler, **dict.fromkeys(TERMINATE, signal.SIG_DFL)}
    before = {number: signal.signal(number, handler) for number, handler in usual.items()}
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


@pytest.fixture
def spawned_workers(monkeypatch: pytest.MonkeyPatch) -> None:
    """Worker processes start from nothing, as outside of tests."""
    monkeypatch.setattr(multiprocessing, "get_context", workers.usual)


@pytest.fixture(scope="session", autouse=True)
def _no_process_outlives_the_session() -> Iterator[None]:
    yield
    assert not _children(), f"left running: {_children()}"


@pytest.fixture(autouse=True)
def _no_process_outlives_its_test() -> Iterator[None]:
    """A process left behind would fail, by its warning, whichever test happens to run next."""
    before = _children()
    yield
    left = _children() - before
    assert not left, f"the test started processes and did not wait for them: {left}"


@pytest.fixture
def start_python(_no_process_outlives_its_test: None) -> Iterator[StartPython]:
    """Start Python with arguments, its output piped; what still runs when the test ends is killed."""
    with ExitStack() as processes:

        def start(
            *arguments: object, env: dict[str, str] | None = None, stdin: int | None = None
        ) -> subprocess.Popen[str]:
            command = [sys.executable, *map(str, arguments)]
            process = subprocess.Popen(command, stdin=stdin, stdout=subprocess.PIPE, text=True, env=env)
            processes.enter_context(process)
            # Before the context waits for it.
            processes.callback(process.kill)
            return process

        yield start


_THREADS = Path("/proc/self/task")


def _children() -> set[int]:
    """Processes that this one has started and not waited for; empty where there is no /proc."""
    # This waits for those that have ended.
    found = {process.pid or 0 for process in multiprocessing.active_children()}
    if _THREADS.exists():
        for thread in os.listdir(_THREADS):
            # Not where it has just ended.
            with suppress(OSError), open(f"{_THREADS}/{thread}/children") as listed:
                found.update(map(int, listed.read().split()))
    # Started with the first worker process, and meant to outlive the others.
    return found - {getattr(resource_tracker._resource_tracker, "_pid", None), workers.server()}
