"""Which cameras see what: their places over the field, balls behind robots, and systematic errors."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import ceil, cos, hypot, pi, sin, sqrt
from typing import NamedTuple

import numpy as np

from robobt.sim.realism import RealismSettings
from robobt.sim.records import BoolArray
from robobt.world.field import FieldGeometry
from robobt.world.geometry import FloatArray, Point
from robobt.world.state import BALL_RADIUS, ROBOT_HEIGHT, ROBOT_RADIUS

CAMERA_HEIGHT = 4.0
"""Height of the cameras above the ground [m]. Source: grSim's."""

_CAMERAS = 4
"""Cameras over the built-in simulator's field, as grSim has them."""

_BALL_POINTS = 64
"""Points on the ball's outline that are looked for."""

_NEAR = 0.5
"""A robot farther from the ball than this never hides it: rays rise above all robots before [m]."""

_ERROR_DIRECTION = (0.3, 0.7, 0.05)
"""Direction of the error of all cameras' reported places. Source: ER-Force's simulator."""


class CameraArea(NamedTuple):
    """The part of the field that one camera sees, unbounded at the outside [m]."""

    left: float
    right: float
    low: float
    high: float

    def holds(self, x: float, y: float) -> bool:
        """Return whether a place lies in it."""
        return self.left <= x <= self.right and self.low <= y <= self.high


def camera_areas(field: FieldGeometry, count: int, overlap: float) -> list[CameraArea]:
    """Return the parts of a field that ``count`` cameras share, numbered as grSim's are.

    Source of the numbers: grSim, whose first of four cameras hangs over the +x, +y quarter, the others
    clockwise as seen from above.

    Args:
        field: which they hang over.
        count: of the cameras, in a grid.
        overlap: by which a camera sees beyond its part [m].
    """
    rows = max(n for n in range(1, ceil(sqrt(count)) + 1) if count % n == 0 and n * n <= count)
    columns = count // rows
    far = 10.0 * (field.length + field.width)

    def edges(parts: int, length: float) -> list[tuple[float, float]]:
        cuts = [-length / 2 + length * i / parts for i in range(parts + 1)]
        return [
            (
                -far if i == 0 else cuts[i] - overlap,
                far if i == parts - 1 else cuts[i + 1] + overlap,
            )
            for i in range(parts)
        ]

    # Column by column from the right, down and up in turn.
    low_to_high = edges(rows, field.width)
    turns = (low_to_high[::-1], low_to_high)
    return [
        CameraArea(*x, *y) for i, x in enumerate(reversed(edges(columns, field.length))) for y in turns[i % 2]
    ]


def camera_places(field: FieldGeometry, count: int) -> list[Point]:
    """Return where the cameras hang, each over the middle of its part of the field [m]."""
    most_x, most_y = field.half_length, field.half_width
    return [
        (
            (max(area.left, -most_x) + min(area.right, most_x)) / 2,
            (max(area.low, -most_y) + min(area.high, most_y)) / 2,
        )
        for area in camera_areas(field, count, 0.0)
    ]


def offset_of(place: Point, offset: float) -> Point:
    """Return by how much a camera at ``place`` sees everything shifted away from the centre [m].

    Source: ER-Force's simulator, object_position_offset.
    """
    away = hypot(*place)
    if away <= offset:
        return place if offset > 0.0 else (0.0, 0.0)
    return place[0] / away * offset, place[1] / away * offset


def reported_error(error: float) -> tuple[float, float, float]:
    """Return by how much the cameras' reported places are wrong, x, y and z [m]."""
    length = sqrt(sum(part * part for part in _ERROR_DIRECTION))
    x, y, z = (error * part / length for part in _ERROR_DIRECTION)
    return x, y, z


class Sight:
    """The systematic errors of four cameras over a simulated field.

    Args:
        field: which they hang over.
        realism: its ``object_offset``, ``camera_error``, ``camera_overlap`` and ``hidden_below`` count.
        face: from a robot's centre to its flat front [m].
    """

    def __init__(self, field: FieldGeometry, realism: RealismSettings, face: float) -> None:
        self._areas = camera_areas(field, _CAMERAS, realism.camera_overlap)
        self._places = camera_places(field, _CAMERAS)
        self._offsets = [offset_of(place, realism.object_offset) for place in self._places]
        self._error = reported_error(realism.camera_error)
        self._hidden_below, self._face = realism.hidden_below, face

    def look(self, rows: FloatArray) -> bool:
        """Shift what is seen, and return whether any camera sees the ball.

        Args:
            rows: robots (x, y, heading, …) and, last, the ball (x, y, z, …); changed.
        """
        robots = rows[:-1].tolist()
        x, y, z = rows[-1, :3].tolist()
        camera, part = self._camera_of(x, y), VisiblePart(1.0, x, y, z)
        if self._hidden_below > 0.0:
            for camera in self._cameras_of(x, y):
                part = visible_part((x, y, z), self._places[camera], robots, self._face)
                if part.share >= self._hidden_below:
                    break
        dx, dy = self._offsets[camera]
        # A wrong place of the camera shifts what flies by the share of the way to it that is taken back.
        lifted = z / (CAMERA_HEIGHT - BALL_RADIUS)
        rows[-1, 0] = part.x + dx + lifted * self._error[0]
        rows[-1, 1] = part.y + dy + lifted * self._error[1]
        for row, (x, y, *_) in zip(rows[:-1], robots, strict=True):
            dx, dy = self._offsets[self._camera_of(x, y)]
            row[0] += dx
            row[1] += dy
        return part.share >= self._hidden_below

    def _camera_of(self, x: float, y: float) -> int:
        """Return the nearest camera."""
        return min(range(_CAMERAS), key=lambda i: hypot(self._places[i][0] - x, self._places[i][1] - y))

    def _cameras_of(self, x: float, y: float) -> list[int]:
        """Return the cameras over a place, the nearest first."""
        over = [i for i in range(_CAMERAS) if self._areas[i].holds(x, y)]
        return sorted(over, key=lambda i: hypot(self._places[i][0] - x, self._places[i][1] - y))


class VisiblePart(NamedTuple):
    """How much of a ball a camera sees, and the middle of that part [m]."""

    share: float
    x: float
    y: float
    z: float


def visible_part(
    ball: tuple[float, float, float],
    camera: Point,
    robots: Iterable[Sequence[float]],
    face: float,
) -> VisiblePart:
    """Return which part of a ball is seen past the robots.

    Args:
        ball: centre of the ball, x, y and height above where it lies [m].
        camera: place of the camera, :data:`CAMERA_HEIGHT` above the ground [m].
        robots: x, y and heading of each, which may be followed by other values [m, rad].
        face: from a robot's centre to its flat front [m].
    """
    x, y, z = ball
    near = [robot for robot in robots if hypot(robot[0] - x, robot[1] - y) < _NEAR]
    if not near or z >= ROBOT_HEIGHT:
        return VisiblePart(1.0, x, y, z)
    centre = np.array((x, y, z + BALL_RADIUS))
    eye = np.array((*camera, CAMERA_HEIGHT))
    points = centre + BALL_RADIUS * _outline(eye - centre)
    # Where each ray is as high as the robots; above, nothing hides it.
    rise = np.clip((ROBOT_HEIGHT - points[:, 2]) / (eye[2] - points[:, 2]), 0.0, 1.0)
    ends = points + rise[:, None] * (eye - points)
    hidden = np.zeros(len(points), dtype=np.bool_)
    for robot in near:
        hidden |= _crosses(points, ends, robot, face)
    seen = points[~hidden]
    if not len(seen):
        return VisiblePart(0.0, x, y, z)
    sx, sy, sz = seen.mean(axis=0)
    return VisiblePart(len(seen) / len(points), float(sx), float(sy), float(sz) - BALL_RADIUS)


def _outline(towards: FloatArray) -> FloatArray:
    """Return points of the unit disc that faces ``towards``, evenly spread, (n, 3)."""
    ray = towards / hypot(*towards.tolist())
    aside = np.array((-ray[1], ray[0], 0.0))
    width = hypot(ray[0], ray[1])
    aside = np.array((1.0, 0.0, 0.0)) if width < 1e-9 else aside / width
    up = np.cross(ray, aside)
    spread: FloatArray = _DISC[:, :1] * aside + _DISC[:, 1:] * up
    return spread


def _sunflower(count: int) -> FloatArray:
    index = np.arange(count)
    radius = np.sqrt((index + 0.5) / count)
    angle = index * pi * (3.0 - sqrt(5.0))
    return np.stack((radius * np.cos(angle), radius * np.sin(angle)), axis=1)


_DISC = _sunflower(_BALL_POINTS)


def _crosses(starts: FloatArray, ends: FloatArray, robot: Sequence[float], face: float) -> BoolArray:
    """Return which segments, seen from above, cross a robot: a disc cut flat at the front."""
    c, s = cos(robot[2]), sin(robot[2])
    turn = np.array(((c, -s), (s, c)))
    # No @: BLAS multiplies in an order that depends on the processor.
    begin = np.einsum("ij,jk->ik", starts[:, :2] - np.array(robot[:2]), turn)
    along = np.einsum("ij,jk->ik", ends[:, :2] - starts[:, :2], turn)
    # The part of each segment within the disc, 0 to 1.
    a = np.maximum((along**2).sum(axis=1), 1e-18)
    b = (begin * along).sum(axis=1)
    left = b * b - a * ((begin**2).sum(axis=1) - ROBOT_RADIUS**2)
    root = np.sqrt(np.maximum(left, 0.0))
    first, last = np.maximum((-b - root) / a, 0.0), np.minimum((-b + root) / a, 1.0)
    # And behind the flat front.
    speed = along[:, 0]
    at = (face - begin[:, 0]) / np.where(np.abs(speed) < 1e-12, 1e-12, speed)
    last = np.where(speed > 0.0, np.minimum(last, at), last)
    first = np.where(speed < 0.0, np.maximum(first, at), first)
    beside = (np.abs(speed) < 1e-12) & (begin[:, 0] > face)
    crossed: BoolArray = (left > 0.0) & (first <= last) & ~beside
    return crossed
