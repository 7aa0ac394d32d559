"""The clocks of the cameras' computers, which need not agree."""

from __future__ import annotations

from dataclasses import dataclass

_IN_STEP = 0.05
"""Clocks closer than this are taken for one: packets' ways differ by as much [s]."""

_JUMP = 0.5
"""A clock does not get ahead by so much; a single packet that says so has slipped [s]."""

_CONFIRMED = 3
"""Packets in a row after which a clock that jumped is believed."""

_MEMORY = 2.0
"""For how long, once or twice over, the fastest packet counts [s]."""


@dataclass(slots=True)
class _Offset:
    """Least difference between arrival and sending, of this stretch of time and the one before [s]."""

    since: float
    least: float
    before: float
    odd: int = 0

    @property
    def now(self) -> float:
        return min(self.least, self.before)


class CameraClocks:
    """How far each camera's clock is from that of the camera that was heard first.

    The packet that was least on its way tells the offset between its camera's
    clock and this machine's.
    """

    def __init__(self) -> None:
        self._offsets: dict[int, _Offset] = {}

    def clear(self) -> None:
        """Forget all: the clocks were started anew."""
        self._offsets.clear()

    def shift(self, camera: int, arrived: float, sent: float) -> float:
        """What to add to a camera's times to have them in the first camera's clock; 0 where they agree [s].

        Args:
            arrived: when the packet came, in this machine's clock [s].
            sent: when it was sent, in the camera's clock [s].
        """
        offset = arrived - sent
        known = self._offsets.get(camera)
        if known is None:
            known = self._offsets[camera] = _Offset(arrived, offset, offset)
        elif offset < known.now - _JUMP and known.odd + 1 < _CONFIRMED:
            known.odd += 1
            return 0.0
        elif arrived - known.since > _MEMORY:
            known.since, known.before, known.least = arrived, known.least, offset
        known.odd = 0
        known.least = min(known.least, offset)
        first = next(iter(self._offsets.values()))
        apart = known.now - first.now
        return apart if abs(apart) > _IN_STEP else 0.0
