"""When to act: at a fixed rate, in phase with the vision's frames where these come at about that rate.

No clock here: all times are arguments.
"""

from __future__ import annotations

_MAX_SHIFT = 0.03
"""Share of a period by which a frame may shift the phase; the rate error stays within it."""

_TRIGGER_SHARE = 0.45
"""Share of a period around the due time in which a frame triggers an act."""


class FrameBeat:
    """A beat that follows the frames' phase but not their gaps.

    The beats are a ``period`` apart, the first at ``now`` [s].
    """

    def __init__(self, period: float, now: float) -> None:
        self.period = period
        self._beat = now

    def restart(self, now: float) -> None:
        """Restart the beat with an act at ``now``."""
        self._beat = now

    def opens(self) -> float:
        """Return from when on the next frame triggers an act [s]."""
        return self._beat + self.period * (1.0 - _TRIGGER_SHARE)

    def closes(self) -> float:
        """Return when to act even without a frame [s]."""
        return self._beat + self.period * (1.0 + _TRIGGER_SHARE)

    def acted(self, now: float, frame: float | None) -> None:
        """Record an act; ``frame`` is when the newest frame since the act before arrived, if one did [s]."""
        due = self._beat + self.period
        if now > due + 4.0 * self.period:
            # This process was delayed; catching up would not help.
            due = now
        elif frame is not None:
            # Towards the frames' phase, whichever way is shorter.
            off = (frame - due + self.period / 2) % self.period - self.period / 2
            most = self.period * _MAX_SHIFT
            due += min(max(off, -most), most)
        self._beat = due
