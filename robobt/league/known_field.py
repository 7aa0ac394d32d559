"""What one world of a field leaves to the next: how its clock runs, and what the user has been told."""

from __future__ import annotations

import logging

from robobt.league.estimate.clocks import FieldClock
from robobt.league.wire.notices import Notices
from robobt.world.field import FieldGeometry

_log = logging.getLogger(__name__)

_BASELINE = 5.0
"""Over how long a rate is measured before it is told [s]."""

_NOTABLE, _SLOW = 0.01, 0.9
"""A rate that is off by this share is told; one below this share of the expected is a slow field."""


class KnownField(Notices):
    """What is known of a field from one match to the next.

    ``speed`` is the rate that its clock is expected to have [s of the field per s].
    """

    def __init__(self, speed: float = 1.0) -> None:
        super().__init__()
        self.clock = FieldClock(speed)
        self.field: FieldGeometry | None = None
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
        """Tell of a rate that is not the expected one; ``now`` is on this machine's clock [s]."""
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
        if rate < _SLOW * self._speed:
            self.tell(
                "slow",
                f"{found}: its simulator does not keep up, or was set to be slow. "
                "The match goes on at that pace, and takes longer; all its times are the field's.",
            )
        elif abs(rate - self._speed) > _NOTABLE * self._speed:
            self.tell("rate", f"{found}; the match follows it, and all its times are the field's")
