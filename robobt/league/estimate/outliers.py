"""Detections far from every prediction, which are believed once they are repeated."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot

from robobt.world.state import RobotId


@dataclass(slots=True)
class _Outlier:
    """A detection far from every prediction, and how often it was repeated."""

    x: float
    y: float
    time: float
    count: int = 1


class Outliers:
    """The last outlier of each robot, and of the ball (None).

    It is believed after ``confirmations`` detections at about one place, each within ``timeout`` of the one
    before [s].
    """

    def __init__(self, confirmations: int, timeout: float) -> None:
        self._confirmations, self._timeout = confirmations, timeout
        self._known: dict[RobotId | None, _Outlier] = {}

    def forget(self, robot: RobotId | None) -> None:
        """Forget its outlier: it was seen where it was expected."""
        self._known.pop(robot, None)

    def confirm(self, robot: RobotId | None, x: float, y: float, time: float, gate: float) -> bool:
        """Take in an outlier; return whether it was repeated often enough, within ``gate`` each time [m]."""
        known = self._known.get(robot)
        if known is None or time - known.time > self._timeout or hypot(x - known.x, y - known.y) > gate:
            self._known[robot] = _Outlier(x, y, time)
            return False
        known.x, known.y, known.time = x, y, time
        known.count += 1
        if known.count < self._confirmations:
            return False
        del self._known[robot]
        return True
