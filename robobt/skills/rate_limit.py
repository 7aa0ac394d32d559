"""Limit how often something is done, in simulation time."""

from __future__ import annotations


class RateLimit:
    """A rate limit for work that need not be done in every tick.

    Args:
        every: least time between two runs [s]; 0 for every tick.
    """

    __slots__ = ("_last", "every")

    def __init__(self, every: float) -> None:
        if not every >= 0.0:
            raise ValueError(f"every must be 0 or more seconds, not {every}")
        self.every = every
        self._last: float | None = None

    def due(self, time: float) -> bool:
        """Return whether a run is due at ``time`` [s]; if so, the next is due ``every`` later.

        A clock that runs backwards means a new match, so a run is due at once.
        """
        # The small slack keeps a multiple of the control period from coming a tick late.
        if self._last is not None and 0.0 <= time - self._last < self.every - 1e-9:
            return False
        self._last = time
        return True
