"""Signals that end a process, turned into a normal exit so that robots are stopped."""

from __future__ import annotations

import signal
import sys
import threading
from types import FrameType

_BASE = 128
"""Exit codes of processes ended by a signal are its number plus this."""


def exit_on_signals() -> None:
    """Let SIGTERM and SIGHUP end this process as ``sys.exit`` does, so that worlds are closed.

    For programs; handlers that are already installed stay.
    """
    if threading.current_thread() is not threading.main_thread():
        return
    for name in ("SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, _exit)


def _exit(number: int, _: FrameType | None) -> None:
    sys.exit(_BASE + number)
