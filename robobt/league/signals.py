"""Robots are stopped also when their process is told to end from outside."""

from __future__ import annotations

import signal
import sys
import threading
from types import FrameType

_BASE = 128
"""What a shell adds to a signal's number for the exit code."""


def exit_on_signals() -> None:
    """Let SIGTERM and SIGHUP end this process as ``sys.exit`` does, so that worlds are closed.

    For programs; handlers that somebody has set are left alone.
    """
    if threading.current_thread() is not threading.main_thread():
        return
    for name in ("SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, _leave)


def _leave(number: int, _: FrameType | None) -> None:
    sys.exit(_BASE + number)
