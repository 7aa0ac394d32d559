"""What cameras detected, as they did: neither filtered nor predicted."""

from __future__ import annotations

from dataclasses import dataclass, field

from robobt.world.geometry import Point
from robobt.world.state import RobotId


@dataclass(slots=True)
class Detections:
    """What one camera, or several together, saw at one instant, in world coordinates (blue defends -x).

    Attributes:
        captured: when the picture was taken, by the frames' clock [s].
        camera: number of the camera; 0 where there is one or they are one.
        ball: x, y [m]; None where no ball was seen.
        robots: x, y [m] and heading [rad] of each robot that was seen.
    """

    captured: float
    camera: int = 0
    ball: Point | None = None
    robots: dict[RobotId, tuple[float, float, float]] = field(default_factory=dict)
