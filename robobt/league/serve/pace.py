"""Decides when a served field has to be stepped. No clock here: all times are arguments."""

from __future__ import annotations

_SKIPPED_LATENESS = 0.25
"""A server later than this skips frames instead of sending them all at once [s]."""

_CATCH_UP = 0.005
"""Relative speed-up until it is on time again, too small for clients to notice."""

_SPEED_WINDOW = 5.0
"""Time over which the field's speed is measured [s]."""

_KEPT_SPEED_SHARE = 0.98
"""A field that keeps less than this share of its speed is slow."""


class ServingPace:
    """Simulated time that follows this machine's clock at some speed, through stalls too.

    It begins where this machine's clock shows ``now`` and the simulation's ``time`` [s].

    Attributes:
        due: simulated time that has to be reached [s].
        kept: share of its speed that the field has kept.
    """

    def __init__(self, now: float, time: float) -> None:
        self.due = self._asked = self._start = time
        self.kept = 1.0
        self._now = self._looked = now
        self._then = time, time

    def advance(self, now: float, speed: float) -> None:
        """Take note of this machine's clock [s], and of the speed that has been in force so far."""
        passed = (now - self._now) * speed
        behind = self._asked - self.due
        self._now = now
        self._asked += passed
        self.due += passed + min(behind, passed * _CATCH_UP)

    def reached(self, time: float, period: float) -> None:
        """Take note of how far the simulation has come [s]; if it is far behind, more is not asked of it."""
        if self.due - time > _SKIPPED_LATENESS + period:
            self.due = time + period
        if self._asked > self._start:
            self.kept = (self.due - self._start) / (self._asked - self._start)

    def slow(self) -> float | None:
        """Return the share of its speed that the field kept lately, None while it keeps it."""
        if self._now - self._looked < _SPEED_WINDOW:
            return None
        asked, done = self._asked - self._then[0], self.due - self._then[1]
        self._looked, self._then = self._now, (self._asked, self.due)
        return done / asked if done < _KEPT_SPEED_SHARE * asked else None
