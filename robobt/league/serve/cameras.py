"""What cameras over a simulated field report: noisy, with gaps, one or several of them."""

from __future__ import annotations

from collections.abc import Mapping
from math import ceil, sqrt

import numpy as np

from robobt.league.wire.vision import BallDetection, CameraFrame, RobotDetection
from robobt.sim.settings import RealismSettings
from robobt.world.field import FieldGeometry
from robobt.world.geometry import wrap_angle
from robobt.world.state import RobotId

_OVERLAP = 0.2
"""How far a camera sees beyond its part of the field [m]. Source: grSim's cameras."""

MAX_CAMERAS = 16


class Cameras:
    """Cameras that share a field, each over its part of a grid.

    Args:
        field: what they look at.
        realism: their noise and gaps; delays are the caller's.
        count: how many, 1 to 16.
        rng: all randomness.

    Raises:
        ValueError: a count out of range.
    """

    def __init__(
        self, field: FieldGeometry, realism: RealismSettings, count: int, rng: np.random.Generator
    ) -> None:
        if not 1 <= count <= MAX_CAMERAS:
            raise ValueError(f"there are 1 to {MAX_CAMERAS} cameras, not {count}")
        self._realism, self._rng = realism, rng
        self._areas = _areas(field, count)
        self._number = 0

    def look(
        self,
        time: float,
        sent: float,
        robots: Mapping[RobotId, tuple[float, float, float]],
        ball: tuple[float, float] | None,
    ) -> list[CameraFrame]:
        """One frame of each camera.

        Args:
            time: of the capture [s].
            sent: when the frames go out [s].
            robots: x, y, heading of each on the field [m, m, rad].
            ball: its place, None when there is none [m].
        """
        realism, rng = self._realism, self._rng
        self._number += 1
        frames = []
        for camera, (left, right, low, high) in enumerate(self._areas):
            frame = CameraFrame(camera, self._number, time, sent)
            noise = rng.standard_normal((len(robots) + 1, 3)).tolist()
            gaps = rng.random(len(robots) + 1).tolist()
            for (robot, (x, y, heading)), (a, b, c), gap in zip(
                robots.items(), noise[1:], gaps[1:], strict=True
            ):
                if left <= x <= right and low <= y <= high and gap >= realism.missing_robot:
                    frame.robots.append(
                        RobotDetection(
                            robot,
                            x + a * realism.robot_noise,
                            y + b * realism.robot_noise,
                            wrap_angle(heading + c * realism.heading_noise),
                        )
                    )
            if ball is not None and gaps[0] >= realism.missing_ball:
                x, y = ball
                if left <= x <= right and low <= y <= high:
                    a, b, _ = noise[0]
                    frame.balls.append(BallDetection(x + a * realism.ball_noise, y + b * realism.ball_noise))
            frames.append(frame)
        return frames


def _areas(field: FieldGeometry, count: int) -> list[tuple[float, float, float, float]]:
    """Left, right, lowest and highest edge of each camera's part; the outer ones see all beyond [m]."""
    rows = max(n for n in range(1, ceil(sqrt(count)) + 1) if count % n == 0 and n * n <= count)
    columns = count // rows
    far = 10.0 * (field.length + field.width)

    def edges(parts: int, length: float) -> list[tuple[float, float]]:
        cuts = [-length / 2 + length * i / parts for i in range(parts + 1)]
        return [
            (
                -far if i == 0 else cuts[i] - _OVERLAP,
                far if i == parts - 1 else cuts[i + 1] + _OVERLAP,
            )
            for i in range(parts)
        ]

    return [(*x, *y) for x in edges(columns, field.length) for y in edges(rows, field.width)]
