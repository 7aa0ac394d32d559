"""Signals that end a program: never lost, and never in the middle of an uninterruptible block.

Within :func:`ending`, SIGTERM and SIGHUP raise :class:`Terminated` and SIGINT raises
KeyboardInterrupt in the main thread, wherever it is, so that files are finished and robots
stopped on the way out. Two exceptions: inside ``with uninterrupted:`` the signal waits for
the end of the block, and where the exception was swallowed, as by a callback from C or by a
skill that catches everything, :func:`check` raises it again.
"""

from __future__ import annotations

import atexit
import os
import signal
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import FrameType

_BASE = 128
"""Exit statuses of processes that a signal ended are its number plus this."""

_SAME_END_TIME = 1.0
"""Signals within this time of the first one ask for the same end: service managers send several [s]."""

_WAIT_FOR_WRITERS = 0.2
"""How long a forced end waits for a block that must not be interrupted [s]."""

TERMINATE: tuple[int, ...] = tuple(
    getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)
)
"""The signals that raise :class:`Terminated`."""


class Terminated(SystemExit):
    """The signal ``number`` asked the process to end; uncaught, it gives that signal's exit status."""

    def __init__(self, number: int) -> None:
        super().__init__(_BASE + number)
        self.signal = signal.Signals(number)


class _Uninterrupted:
    """A block at whose end a signal takes effect that arrived inside; blocks may be nested."""

    def __init__(self) -> None:
        self.depth = 0

    def __enter__(self) -> None:
        if threading.get_ident() == _MAIN:
            self.depth += 1

    def __exit__(self, *_: object) -> None:
        if threading.get_ident() == _MAIN:
            self.depth -= 1
            if not self.depth and _told.waiting:
                check()


class _Told:
    """The signal that the process has received.

    Attributes:
        number: the signal, None before one has come.
        at: when it came [s].
        waiting: whether it has still to be raised, because it came inside an uninterrupted block.
        patience: how long the main thread may take to react before the end is forced, None for ever [s].
        force: ends the process when that time is over.
    """

    def __init__(self) -> None:
        self.number: int | None = None
        self.at = 0.0
        self.waiting = False
        self.patience: float | None = None
        self.force: threading.Timer | None = None


_MAIN = threading.main_thread().ident
_told = _Told()

uninterrupted = _Uninterrupted()
"""Put ``with uninterrupted:`` around what is written or sent as a whole; no effect in other threads."""


def check() -> None:
    """Raise again what a signal has raised, in case somebody has swallowed it; else do nothing.

    Raises:
        Terminated: SIGTERM or SIGHUP has come.
        KeyboardInterrupt: SIGINT has come.
    """
    if _told.number is not None and threading.get_ident() == _MAIN:
        _told.waiting = False
        raise KeyboardInterrupt if _told.number == signal.SIGINT else Terminated(_told.number)


@contextmanager
def ending(numbers: tuple[int, ...] = (signal.SIGINT, *TERMINATE)) -> Iterator[None]:
    """Return a context that the signals ``numbers`` end; in other threads than the main one it does nothing.

    The previous handlers are installed again after it.

    SIGINT works even where the shell had it ignored, as for a command in the background of a
    script. SIGHUP stays ignored where it is, as ``nohup`` wants it; otherwise what is printed
    to the closed terminal from then on is dropped.
    """
    if threading.get_ident() != _MAIN:
        yield
        return
    terminals = [fd for fd in (1, 2) if _is_terminal(fd)]

    def on_signal(number: int, _: FrameType | None) -> None:
        if number == getattr(signal, "SIGHUP", None):
            _close(terminals)
        now = time.monotonic()
        if _told.number is not None and now < _told.at + _SAME_END_TIME:
            return
        _told.number, _told.at = number, now
        if _told.patience is not None and _told.force is None:
            _told.force = threading.Timer(_told.patience, _end_by_force)
            _told.force.daemon = True
            _told.force.start()
        _told.waiting = uninterrupted.depth > 0
        if not _told.waiting:
            check()

    def on_unraisable(ignored: sys.UnraisableHookArgs) -> None:
        # It came while something was deleted or collected, and is raised again.
        if not isinstance(ignored.exc_value, Terminated | KeyboardInterrupt):
            report(ignored)

    before = {number: signal.getsignal(number) or signal.SIG_DFL for number in numbers}
    report, sys.unraisablehook = sys.unraisablehook, on_unraisable
    try:
        for number, handler in before.items():
            if number == signal.SIGINT or handler is not signal.SIG_IGN:
                signal.signal(number, on_signal)
        yield
    finally:
        sys.unraisablehook = report
        for number, handler in before.items():
            signal.signal(number, handler)
        _told.number, _told.waiting = None, False


@contextmanager
def at_the_latest_after(seconds: float) -> Iterator[None]:
    """Return a context that ends the process by force where it still goes on ``seconds`` after a signal [s].

    That takes what runs on and on whatever is raised in it, such as a skill with a bare
    ``except`` in an endless loop. What is registered with ``atexit`` is still done.
    """
    _told.patience = seconds
    try:
        yield
    finally:
        _told.patience = None
        let_go()


def let_go() -> None:
    """Say that the main thread is on its way out: no end has to be forced any more."""
    if _told.force is not None:
        _told.force.cancel()
        _told.force = None


def leave_after_signal(status: object) -> None:
    """End the process at once if its exit status is that of a signal; else do nothing.

    The interpreter would take apart its modules first, which takes longer than all the rest. What
    is registered with ``atexit`` is still done.
    """
    if not isinstance(status, int) or status - _BASE not in (signal.SIGINT, *TERMINATE):
        return
    for stream in (sys.stdout, sys.stderr):
        # Nobody may be there to read.
        with suppress(OSError, ValueError):
            stream.flush()
    atexit._run_exitfuncs()
    os._exit(status)


def _end_by_force() -> None:
    """End the process from another thread than the main one."""
    number = _told.number
    if number is None:
        return
    end = time.monotonic() + _WAIT_FOR_WRITERS
    while uninterrupted.depth and time.monotonic() < end:
        time.sleep(0.001)
    if _told.force is None:
        return
    atexit._run_exitfuncs()
    if _told.force is None:
        # It did let go, only later, as on a busy machine.
        return
    name = signal.Signals(number).name
    with suppress(OSError):
        os.write(2, f"robobt: ended by force on {name}: a skill or a callback does not let go\n".encode())
    os._exit(_BASE + number)


def _is_terminal(fd: int) -> bool:
    with suppress(OSError):
        return os.isatty(fd)
    return False


def _close(terminals: list[int]) -> None:
    """Print to nowhere instead: a terminal that is gone answers with errors."""
    for fd in terminals:
        with suppress(OSError):
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, fd)
            os.close(nowhere)
