"""When to act: at a fixed rate, in step with the vision's frames where these come at about that rate.

No clock here: all times are arguments.
"""

from __future__ import annotations

_SHIFT = 0.03
"""Share of a period by which a frame may move the beat; the rate stays within so much of the wanted."""

_SLACK = 0.45
"""Share of a period around the beat in which a frame is acted on at once."""


class Pace:
    """A beat that follows the frames' phase but not their gaps.

    Args:
        period: between two acts [s].
        now: the first beat [s].
    """

    def __init__(self, period: float, now: float) -> None:
        self.period = period
        self._beat = now

    def restart(self, now: float) -> None:
        """Begin anew with an act at ``now``."""
        self._beat = now

    def opens(self) -> float:
        """From when on the next frame is acted on at once [s]."""
        return self._beat + self.period * (1.0 - _SLACK)

    def closes(self) -> float:
        """When it is time to act even if no frame has come [s]."""
        return self._beat + self.period * (1.0 + _SLACK)

    def acted(self, now: float, frame: float | None) -> None:
        """An act happened at ``now``; the newest frame since the one before came at ``frame``, if any."""
        due = self._beat + self.period
        if now > due + 4.0 * self.period:
            # This process was held up; hurrying after the beat would help nobody.
            due = now
        elif frame is not None:
            # Towards the frames' phase, whichever way is shorter.
            off = (frame - due + self.period / 2) % self.period - self.period / 2
            most = self.period * _SHIFT
            due += min(max(off, -most), most)
        self._beat = due
