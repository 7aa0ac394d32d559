"""What a frame derives from all its robots, made from arrays at once instead of robot by robot."""

from __future__ import annotations

from collections.abc import Sequence
from struct import pack

import numpy as np
from numpy.typing import NDArray

from robobt.world.geometry import FloatArray
from robobt.world.limits import RobotLimits
from robobt.world.records import movers
from robobt.world.state import PACKED, Frame, RobotState


class FrameNumbers:
    """Makes the packed robots and the movers of frames with the same robots, which have them then as cached.

    Args:
        own: number and limits of each robot of the frames' own team, in the frames' order.
        opponents: number and limits of each opponent.
    """

    def __init__(
        self, own: Sequence[tuple[int, RobotLimits]], opponents: Sequence[tuple[int, RobotLimits]]
    ) -> None:
        robots = [RobotState(number, 0.0, 0.0, limits=limits) for number, limits in (*own, *opponents)]
        self._own, self._opponents = len(own), len(opponents)
        self._movers = movers(robots)
        # As Frame.packed() has a robot.
        self._packed = np.zeros((len(robots), 8), dtype="<f8")
        self._packed[:, 0] = [robot.id for robot in robots]

    def give(self, frame: Frame, states: FloatArray, contact: NDArray[np.bool_]) -> None:
        """Cache the numbers with a frame.

        Args:
            frame: the frame, with all the robots.
            states: x, y, heading, vx, vy and omega of each (n, 6) [m, rad, m/s, rad/s].
            contact: whether each has the ball in its mouth, (n,).
        """
        everybody = frame.made["movers"] = self._movers.copy()
        everybody[:, :2] = states[:, :2]
        everybody[:, 2:4] = states[:, 3:5]
        packed, own, ball = self._packed, self._own, frame.ball
        packed[:, 1:7] = states
        packed[:, 7] = contact
        frame.made[PACKED] = b"".join(
            (
                pack("<6d", frame.time, ball.x, ball.y, ball.vx, ball.vy, own),
                packed[:own].tobytes(),
                pack("<d", self._opponents),
                packed[own:].tobytes(),
                pack("<2d", ball.z, ball.vz) if ball.z or ball.vz else b"",
            )
        )
