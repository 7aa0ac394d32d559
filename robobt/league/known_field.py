"""Knowledge of a field that is kept between worlds: its clock's rate, and the warnings given."""

from __future__ import annotations

import logging

from robobt.league.estimate.clocks import FieldClock
from robobt.league.wire.notices import Notices
from robobt.world.delay import DelayWatch
from robobt.world.field import FieldGeometry

_log = logging.getLogger(__name__)

_BASELINE = 5.0
"""Time over which a rate is measured before it is reported [s]."""

_NOTABLE_RATE_ERROR, _SLOW_RATE_SHARE = 0.01, 0.9
"""Deviation from which a rate is reported, and share of the expected rate below which a field is slow."""


class KnownField(Notices):
    """Knowledge of a field from one match to the next.

    ``speed`` is the rate that its clock is expected to have [s of the field per s].

    Attributes:
        clock: how the field's clock runs.
        field: dimensions that the vision reports, None before it has.
        delays: what measures the robots' delays, None before a world was made.
    """

    def __init__(self, speed: float = 1.0) -> None:
        super().__init__()
        self.clock = FieldClock(speed)
        self.field: FieldGeometry | None = None
        self.delays: DelayWatch | None = None
        self._speed = speed
        self._since: tuple[float, float] | None = None

    def tell_again(self, message: str) -> None:
        """Warn the user of something each time that it happens."""
        _log.warning(message)

    def restarted(self) -> None:
        """Take note that the field's clock was restarted."""
        self.clock.clear()
        self._since = None

    def watch(self, now: float) -> None:
        """Report an unexpected rate; ``now`` is on this machine's clock [s]."""
        there = self.clock.at(now)
        if there is None or not self.clock.settled:
            return
        if self._since is None:
            self._since = now, there
        elapsed = now - self._since[0]
        if elapsed < _BASELINE:
            return
        rate = (there - self._since[1]) / elapsed
        self._since = now, there
        found = f"the field's clock runs at {rate:.3f} of real time, not at {self._speed:g}"
        if rate < _SLOW_RATE_SHARE * self._speed:
            self.tell(
                "slow",
                f"{found}: its simulator does not keep up, or was set to be slow. "
                "The match goes on at that pace, and takes longer; all its times are the field's.",
            )
        elif abs(rate - self._speed) > _NOTABLE_RATE_ERROR * self._speed:
            self.tell("rate", f"{found}; the match follows it, and all its times are the field's")
