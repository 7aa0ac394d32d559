"""What cameras over a simulated field report: noisy, with gaps, from one or several of them.

Four are numbered as grSim's are: from its +x, +y quarter on, clockwise seen from above.
"""

from __future__ import annotations

from math import cos, sin

import numpy as np

from robobt.league.wire.geometry import CameraPlace
from robobt.league.wire.vision import BallDetection, CameraFrame, RobotDetection
from robobt.sim.realism import RealismSettings
from robobt.sim.sight import (
    CAMERA_HEIGHT,
    camera_areas,
    camera_places,
    offset_of,
    reported_error,
    visible_part,
)
from robobt.world.field import FieldGeometry
from robobt.world.geometry import Point, wrap_angle
from robobt.world.state import BALL_RADIUS, BallState, Frame

_MAX_SERVED_CAMERAS = 16

_LEAST_BELOW = 0.1
"""A ball never counts as nearer to a camera's height than this [m]."""


_LIGHT_BARRIER = (0.075, -0.04)
"""Where a dribbler's light barrier is taken for a ball, ahead and aside of a robot's centre [m].

Source: ER-Force's simulator, which reports it at the dribbler's right corner."""


class Cameras:
    """Cameras that share a field, each over its part of a grid.

    ``realism`` gives their noise, gaps, systematic errors and false balls; its latency is the caller's
    business. A ball in the air is seen where the ray from the camera through it meets the ground.

    Args:
        field: which they hang over.
        realism: as above.
        count: of the cameras, 1 to 16.
        rng: draws noise, gaps and false balls.
        interval: time between two frames [s].
        face: from a robot's centre to its flat front, past which a ball is seen [m].

    Attributes:
        places: where they hang, each over the middle of its part [m].

    Raises:
        ValueError: there can't be as many cameras.
    """

    def __init__(
        self,
        field: FieldGeometry,
        realism: RealismSettings,
        count: int,
        rng: np.random.Generator,
        interval: float = 1 / 60,
        face: float = 0.075,
    ) -> None:
        if not 1 <= count <= _MAX_SERVED_CAMERAS:
            raise ValueError(f"a field has 1 to {_MAX_SERVED_CAMERAS} cameras, not {count}")
        self._field, self._rng, self._interval, self._face = field, rng, interval, face
        self.places = camera_places(field, count)
        self.realism = realism
        self._number = 0

    @property
    def realism(self) -> RealismSettings:
        """The level of realism; may be replaced."""
        return self._realism

    @realism.setter
    def realism(self, realism: RealismSettings) -> None:
        self._realism = realism
        self._areas = camera_areas(self._field, len(self.places), realism.camera_overlap)
        self._offsets = [offset_of(place, realism.object_offset) for place in self.places]

    @property
    def calibrated(self) -> dict[int, CameraPlace]:
        """Where they are, by number, as their calibration says: wrong by ``camera_error``."""
        ex, ey, ez = reported_error(self._realism.camera_error)
        return {i: CameraPlace(x + ex, y + ey, CAMERA_HEIGHT + ez) for i, (x, y) in enumerate(self.places)}

    def capture(self, truth: Frame, captured: float, sent: float) -> list[CameraFrame]:
        """Return one frame of each camera, with these timestamps of capture and sending [s]."""
        robots, ball = truth.robots(), truth.ball
        realism, rng = self._realism, self._rng
        poses = [(state.x, state.y, state.heading) for state in robots.values()]
        self._number += 1
        frames = []
        for camera, area in enumerate(self._areas):
            frame = CameraFrame(camera, self._number, captured, sent)
            noise = rng.standard_normal((len(robots) + 1, 3)).tolist()
            gaps = rng.random(len(robots) + 1).tolist()
            dx, dy = self._offsets[camera]
            for (robot, state), (a, b, c), gap in zip(robots.items(), noise[1:], gaps[1:], strict=True):
                if area.holds(state.x, state.y) and gap >= realism.missing_robot:
                    x, y = state.x + a * realism.robot_noise + dx, state.y + b * realism.robot_noise + dy
                    heading = wrap_angle(state.heading + c * realism.heading_noise)
                    frame.robots.append(RobotDetection(robot, x, y, heading))
                    if realism.false_balls > 0.0 and rng.random() < realism.false_balls * self._interval:
                        frame.balls.append(_at_dribbler(x, y, heading))
            x, y = projected(ball, self.places[camera])
            if gaps[0] >= realism.missing_ball and area.holds(x, y):
                seen = self._seen(ball, camera, poses)
                if seen is not None:
                    a, b, _ = noise[0]
                    x, y = projected(seen, self.places[camera])
                    x, y = x + a * realism.ball_noise + dx, y + b * realism.ball_noise + dy
                    frame.balls.append(BallDetection(x, y))
            if len(frame.balls) > 1:
                frame.balls = [frame.balls[i] for i in rng.permutation(len(frame.balls))]
            frames.append(frame)
        return frames

    def _seen(
        self, ball: BallState, camera: int, poses: list[tuple[float, float, float]]
    ) -> BallState | None:
        """Return the part of the ball that a camera sees, None where too little of it shows."""
        least = self._realism.hidden_below
        if least <= 0.0:
            return ball
        part = visible_part((ball.x, ball.y, ball.z), self.places[camera], poses, self._face)
        return None if part.share < least else BallState(part.x, part.y, z=max(part.z, 0.0))


def _at_dribbler(x: float, y: float, heading: float) -> BallDetection:
    """Return the false ball of the robot that is seen there."""
    c, s = cos(heading), sin(heading)
    ahead, aside = _LIGHT_BARRIER
    return BallDetection(x + c * ahead - s * aside, y + s * ahead + c * aside)


def projected(ball: BallState, place: Point) -> Point:
    """Return where a camera over ``place`` sees the ball, as if it lay on the ground [m]."""
    if ball.z <= 0.0:
        return ball.position
    # As it reckons with a ball on the ground, it is that ball's centre that heights count from.
    height = CAMERA_HEIGHT - BALL_RADIUS
    farther = height / max(height - ball.z, _LEAST_BELOW)
    return place[0] + (ball.x - place[0]) * farther, place[1] + (ball.y - place[1]) * farther
