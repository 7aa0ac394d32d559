"""Simulated time for control nodes."""

from __future__ import annotations

from typing import Protocol

_DURATION_ROUNDING = 1e-9


class HasTime(Protocol):
    """A store that has the time; timed nodes are bound to one like leaves."""

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        ...


class Timer:
    """Runs for a while once started, on a clock that its caller reads.

    A clock that has gone backwards (a new match on an old tree) ends it, so that no node waits for an old
    time.

    Raises:
        ValueError: not a finite number of 0 or more seconds.
    """

    __slots__ = ("_started", "seconds")

    def __init__(self, seconds: float) -> None:
        if not 0.0 <= seconds < float("inf"):
            raise ValueError(f"seconds must be 0 or more and finite, not {seconds}")
        self.seconds = seconds
        self._started: float | None = None

    def start(self, now: float) -> None:
        """Run from ``now`` [s] on."""
        self._started = now

    def runs(self, now: float) -> bool:
        """Return whether it was started and less than ``seconds`` have passed at ``now`` [s]."""
        # The slack keeps a multiple of the control period from taking a tick longer.
        return self._started is not None and 0.0 <= now - self._started < self.seconds - _DURATION_ROUNDING

    @property
    def until(self) -> float:
        """When it ends, or 0 if it was never started [s]."""
        return 0.0 if self._started is None else self._started + self.seconds
