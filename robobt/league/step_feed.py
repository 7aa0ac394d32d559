"""A feed in lock step: each wait advances the field, independent of this machine's clock."""

from __future__ import annotations

import select
import time
from collections.abc import Callable, Mapping

from robobt.league.connection import Connection, LeagueError
from robobt.league.feed import Feed
from robobt.league.known_field import KnownField
from robobt.league.wire.steps import StepLink
from robobt.sim.settings import SimSettings
from robobt.world.field import FieldGeometry
from robobt.world.limits import RobotLimits
from robobt.world.state import RobotId

_TIME_ROUNDING = 1e-9

_ARRIVAL_TIMEOUT = 2.0
"""Time for packets sent before an answer to arrive, because they take another route [s]."""


class StepFeed(Feed):
    """A feed whose camera frames are the answers to its link's steps, a ``period`` [s] each.

    The game controller's messages and the field's geometry come as packets all the same. Those of an instant
    have to be sent before the answer; the former's is waited for, as trees depend on it.
    Other arguments are those of :class:`Feed`.
    """

    def __init__(
        self,
        link: StepLink,
        period: float,
        connection: Connection,
        field: FieldGeometry | None,
        settings: SimSettings,
        limits: Mapping[RobotId, RobotLimits],
        clock: Callable[[], float],
        known: KnownField | None,
    ) -> None:
        super().__init__(connection, field, settings, limits, clock, known)
        self._link, self._step = link, period
        self._geometry_due = True

    def receive(self, wait: float) -> None:
        """Advance by up to ``wait`` seconds, until a new frame has arrived.

        Raises:
            LeagueError: the game controller says nothing about this instant.
            StreamError: the simulator does not answer.
        """
        link, end = self._link, self._link.time + max(0.0, wait)
        if wait <= 0.0:
            return
        if link.stepped + self._step > end + _TIME_ROUNDING:
            link.time = end
            return
        frames = link.step(self._step)
        link.time = max(link.time, link.stepped)
        if frames:
            self._packets(frames[-1].sent)
        for frame in frames:
            self.add(frame, link.time)

    def _packets(self, sent: float) -> None:
        """Take in the packets up to those of an instant [s]; the first geometry is waited for too."""
        end = time.monotonic() + _ARRIVAL_TIMEOUT
        while True:
            for packet in self._vision.receive():
                self._read(packet, self._link.time)
            self._geometry_due &= not self.filter.cameras
            self.hear_referee()
            late = self.referee is not None and self.referee.sent < sent - 1e-3
            if not late and not self._geometry_due:
                return
            left = end - time.monotonic()
            if left <= 0.0:
                # Not every simulator tells where its cameras are.
                self._geometry_due = False
                if not late:
                    return
                raise LeagueError(
                    f"no game controller at {self.connection.endpoints.referee} follows the steps; play "
                    "without follow_referee"
                )
            select.select(self._sources, [], [], left)
