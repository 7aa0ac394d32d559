"""Worker processes of tests are forked from one that has imported what they need, which takes seconds."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable
from multiprocessing import forkserver
from multiprocessing.context import ForkServerContext, ForkServerProcess
from multiprocessing.reduction import ForkingPickler
from pathlib import Path
from typing import Any

# No play, skill or model: these a worker must find for itself.
IMPORTED = ["numba", "pyarrow", "pydantic", "pytest", "robobt.match", "robobt.worlds", "robobt.sim.world"]


class _Forked(ForkServerProcess):
    """A process with the environment of the one that starts it, as a spawned one has it."""

    def __reduce__(self) -> tuple[Callable[..., _Forked], tuple[dict[str, str], bytes]]:
        return _restored, (dict(os.environ), bytes(ForkingPickler.dumps(self.__dict__)))


def _restored(environment: dict[str, str], packed: bytes) -> _Forked:
    os.environ.clear()
    os.environ.update(environment)
    process = _Forked.__new__(_Forked)
    process.__dict__.update(ForkingPickler.loads(packed))
    return process


class _Forking(ForkServerContext):
    Process = _Forked


usual: Callable[..., Any] = multiprocessing.get_context
"""What Python has for it."""


def _context(method: str | None = None) -> Any:
    return _Forking() if method == "spawn" else usual(method)


def fork_workers() -> None:
    """Fork in this process what would be spawned; see the fixture ``spawned_workers``."""
    if os.name == "posix":
        forkserver.set_forkserver_preload(IMPORTED)
        multiprocessing.get_context = _context


def server() -> int:
    """Return the number of the process that forks; 0 where none has been needed."""
    return getattr(forkserver._forkserver, "_forkserver_pid", None) or 0


def processor_time() -> float:
    """Return what that process has taken, with those that it has forked and that have ended [s]."""
    stat = Path("/proc", str(server()), "stat")
    if not server() or not stat.exists():
        return 0.0
    # Its own times and those of its children, behind the name, which may hold spaces.
    return sum(map(int, stat.read_text().rpartition(")")[2].split()[11:15])) / os.sysconf("SC_CLK_TCK")
