"""A served field and a league world under one simulated clock: over real packets, as fast as it goes.

What is left out is what a machine's load adds, so that the same seed plays the same match.
"""

from __future__ import annotations

from typing import Any

from robobt.league.serve.server import SimServer
from robobt.league.world import LeagueWorld


class LockstepWorld(LeagueWorld):
    """A league world that lets its server simulate while it waits.

    Args:
        server: whose packets it hears; nobody else may run it.
        arguments: those of :class:`LeagueWorld` by name, but for the clock.
    """

    def __init__(self, server: SimServer, **arguments: Any) -> None:
        self._server = server
        self.machine_time = 0.0
        super().__init__(clock=lambda: self.machine_time, **arguments)
        self._hear = self._feed.receive
        self._feed.receive = self._receive  # type: ignore[method-assign]

    def _receive(self, wait: float) -> None:
        heard = self._feed.frames
        self._hear(0.0)
        end = self.machine_time + max(0.0, wait)
        while self._feed.frames == heard and wait > 0.0:
            due = self._server.field.time + self._server.field.period
            if due > end + 1e-9:
                self.machine_time = end
                return
            self.machine_time = max(self.machine_time, due)
            self._server.receive()
            self._server.step()
            self._server.send_due(self.machine_time)
            self._hear(0.0)
