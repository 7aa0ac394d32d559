"""Doing something no more often than every so often, in the world's own time."""

from __future__ import annotations


class RateLimit:
    """A limit on how often something is done that need not be done every tick.

    Args:
        every: least time from one to the next [s]; 0 is every tick.
    """

    __slots__ = ("_last", "every")

    def __init__(self, every: float) -> None:
        if not every >= 0.0:
            raise ValueError(f"every must be 0 or more seconds, not {every}")
        self.every = every
        self._last: float | None = None

    def due(self, time: float) -> bool:
        """Return whether it is due at ``time`` [s]; if so, the next is due ``every`` later.

        A clock that runs backwards is a new match: due at once.
        """
        # The small slack keeps a multiple of the control period from slipping a tick.
        if self._last is not None and 0.0 <= time - self._last < self.every - 1e-9:
            return False
        self._last = time
        return True
