"""What cameras over a simulated field report: noisy, with gaps, from one or several of them.

Four are numbered as grSim's are: from its +x, +y quarter on, clockwise seen from above.
"""

from __future__ import annotations

from math import ceil, sqrt

import numpy as np

from robobt.league.wire.geometry import CAMERA_HEIGHT, CameraPlace
from robobt.league.wire.vision import BallDetection, CameraFrame, RobotDetection
from robobt.sim.settings import RealismSettings
from robobt.world.field import FieldGeometry
from robobt.world.geometry import Point, wrap_angle
from robobt.world.state import BALL_RADIUS, BallState, Frame

_CAMERA_OVERLAP = 0.2
"""How far a camera sees beyond its part of the field [m]. Source: grSim's cameras."""

_MAX_SERVED_CAMERAS = 16

_LEAST_BELOW = 0.1
"""A ball never counts as nearer to a camera's height than this [m]."""


class Cameras:
    """Cameras that share a field, each over its part of a grid.

    There are 1 to 16 of them; ``realism`` gives their noise and gaps, its latency is the caller's business.
    A ball in the air is seen where the ray from the camera through it meets the ground.

    Attributes:
        realism: as above; may be replaced.
        places: where they hang, each over the middle of its part [m].
    """

    def __init__(
        self, field: FieldGeometry, realism: RealismSettings, count: int, rng: np.random.Generator
    ) -> None:
        if not 1 <= count <= _MAX_SERVED_CAMERAS:
            raise ValueError(f"a field has 1 to {_MAX_SERVED_CAMERAS} cameras, not {count}")
        self.realism, self._rng = realism, rng
        self._areas = _areas(field, count)
        most_x, most_y = field.half_length, field.half_width
        self.places: list[Point] = [
            (_middle(left, right, most_x), _middle(low, high, most_y))
            for left, right, low, high in self._areas
        ]
        self._number = 0

    @property
    def calibrated(self) -> dict[int, CameraPlace]:
        """Where they are, by number, as their calibration tells."""
        return {i: CameraPlace(x, y, CAMERA_HEIGHT) for i, (x, y) in enumerate(self.places)}

    def capture(self, truth: Frame, captured: float, sent: float) -> list[CameraFrame]:
        """Return one frame of each camera, with these timestamps of capture and sending [s]."""
        robots, ball = truth.robots(), truth.ball
        realism, rng = self.realism, self._rng
        self._number += 1
        frames = []
        for camera, (left, right, low, high) in enumerate(self._areas):
            frame = CameraFrame(camera, self._number, captured, sent)
            noise = rng.standard_normal((len(robots) + 1, 3)).tolist()
            gaps = rng.random(len(robots) + 1).tolist()
            for (robot, state), (a, b, c), gap in zip(robots.items(), noise[1:], gaps[1:], strict=True):
                if left <= state.x <= right and low <= state.y <= high and gap >= realism.missing_robot:
                    x, y = state.x + a * realism.robot_noise, state.y + b * realism.robot_noise
                    heading = wrap_angle(state.heading + c * realism.heading_noise)
                    frame.robots.append(RobotDetection(robot, x, y, heading))
            x, y = projected(ball, self.places[camera])
            if gaps[0] >= realism.missing_ball and left <= x <= right and low <= y <= high:
                a, b, _ = noise[0]
                x, y = x + a * realism.ball_noise, y + b * realism.ball_noise
                frame.balls.append(BallDetection(x, y))
            frames.append(frame)
        return frames


def projected(ball: BallState, place: Point) -> Point:
    """Return where a camera over ``place`` sees the ball, as if it lay on the ground [m]."""
    if ball.z <= 0.0:
        return ball.position
    # As it reckons with a ball on the ground, it is that ball's centre that heights count from.
    height = CAMERA_HEIGHT - BALL_RADIUS
    farther = height / max(height - ball.z, _LEAST_BELOW)
    return place[0] + (ball.x - place[0]) * farther, place[1] + (ball.y - place[1]) * farther


def _areas(field: FieldGeometry, count: int) -> list[tuple[float, float, float, float]]:
    """Return left, right, lowest and highest edge of each camera's part; outer parts are unbounded [m]."""
    rows = max(n for n in range(1, ceil(sqrt(count)) + 1) if count % n == 0 and n * n <= count)
    columns = count // rows
    far = 10.0 * (field.length + field.width)

    def edges(parts: int, length: float) -> list[tuple[float, float]]:
        cuts = [-length / 2 + length * i / parts for i in range(parts + 1)]
        return [
            (
                -far if i == 0 else cuts[i] - _CAMERA_OVERLAP,
                far if i == parts - 1 else cuts[i + 1] + _CAMERA_OVERLAP,
            )
            for i in range(parts)
        ]

    # Column by column from the right, down and up in turn.
    low_to_high = edges(rows, field.width)
    turns = (low_to_high[::-1], low_to_high)
    return [(*x, *y) for i, x in enumerate(reversed(edges(columns, field.length))) for y in turns[i % 2]]


def _middle(low: float, high: float, most: float) -> float:
    """Return the middle of what lies within ``most`` from the centre, without overlaps [m]."""
    low, high = (
        (-most if low < -most else low + _CAMERA_OVERLAP),
        (most if high > most else high - _CAMERA_OVERLAP),
    )
    return (low + high) / 2
