"""Offsets between this machine's clock and those of the cameras' computers.

The packet with the least delay shows the offset between its sender's clock and
this machine's.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass

_MEMORY = 2.0
"""How long the fastest packet counts [s]."""

_IN_STEP = 0.05
"""Clocks closer than this count as one: the delays of packets differ by as much [s]."""

_JUMP = 0.5
"""A clock does not gain this much; a single packet that shows it has a wrong timestamp [s]."""

_CONFIRMATIONS = 3
"""Consecutive packets after which a clock that jumped is believed."""


class VisionClock:
    """The offset between this machine's clock and the vision's."""

    def __init__(self) -> None:
        # Times of arrival and offsets, both increasing.
        self._offsets: deque[tuple[float, float]] = deque()

    def clear(self) -> None:
        """Forget the offset: the vision's clock was restarted."""
        self._offsets.clear()

    def update(self, arrived: float, sent: float) -> None:
        """Learn from a packet that was sent and arrived at these times, each on its own clock [s]."""
        offset = arrived - sent
        # Only what may still become the least is kept, so a flood does not pile up here.
        while self._offsets and self._offsets[-1][1] >= offset:
            self._offsets.pop()
        self._offsets.append((arrived, offset))
        while self._offsets and self._offsets[0][0] < arrived - _MEMORY:
            self._offsets.popleft()

    def offset(self) -> float | None:
        """Return what this machine's clock is ahead, None before the first packet [s]."""
        return self._offsets[0][1] if self._offsets else None


@dataclass(slots=True)
class _Offset:
    """Least difference between arrival and sending, in this stretch of time and the one before [s]."""

    since: float
    least: float
    before: float
    odd: int = 0

    @property
    def now(self) -> float:
        return min(self.least, self.before)


class CameraClocks:
    """The offset of each camera's clock from that of the camera heard first."""

    def __init__(self) -> None:
        self._offsets: dict[int, _Offset] = {}

    def clear(self) -> None:
        """Forget all offsets: the clocks were restarted."""
        self._offsets.clear()

    def shift(self, camera: int, arrived: float, sent: float) -> float:
        """Return what to add to a camera's timestamps to convert them to the first camera's clock [s].

        Args:
            camera: number of the camera.
            arrived: when its packet arrived, on this machine's clock [s].
            sent: when it was sent, on the camera's clock [s].
        """
        offset = arrived - sent
        known = self._offsets.get(camera)
        if known is None:
            known = self._offsets[camera] = _Offset(arrived, offset, offset)
        elif offset < known.now - _JUMP and known.odd + 1 < _CONFIRMATIONS:
            known.odd += 1
            return 0.0
        elif arrived - known.since > _MEMORY:
            known.since, known.before, known.least = arrived, known.least, offset
        known.odd = 0
        known.least = min(known.least, offset)
        first = next(iter(self._offsets.values()))
        apart = known.now - first.now
        return apart if abs(apart) > _IN_STEP else 0.0
