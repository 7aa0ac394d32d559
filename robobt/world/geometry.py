"""Plane geometry: scalar helpers for skills, array helpers with leading batch axes.

Angles are in radians, counter-clockwise, lengths in metres.
"""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin, sqrt

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robobt.world.compiled import compilable

Point = tuple[float, float]
FloatArray = NDArray[np.float64]

_TAU = 2.0 * pi


@compilable
def wrap_angle(angle: float) -> float:
    """Return the direction of an ``angle`` in (-pi, pi] [rad]."""
    wrapped = angle % _TAU
    return wrapped - _TAU if wrapped > pi else wrapped


def wrap_angles(angles: ArrayLike) -> FloatArray:
    """Apply :func:`wrap_angle` elementwise; any shape."""
    wrapped = np.mod(np.asarray(angles, dtype=np.float64), _TAU)
    return np.where(wrapped > pi, wrapped - _TAU, wrapped)


@compilable
def direction(origin: Point, target: Point) -> float:
    """Return the angle of the ray from ``origin`` to ``target``; 0 when they coincide."""
    return atan2(target[1] - origin[1], target[0] - origin[0])


@compilable
def distance(a: Point, b: Point) -> float:
    """Return the Euclidean distance between ``a`` and ``b`` [m]."""
    return hypot(b[0] - a[0], b[1] - a[1])


@compilable
def closest_point_on_segment(point: Point, start: Point, end: Point) -> Point:
    """Return the point of the segment nearest to ``point``; ``start`` for a segment of no length."""
    (px, py), (x, y), (end_x, end_y) = point, start, end
    dx, dy = end_x - x, end_y - y
    length_squared = dx * dx + dy * dy
    if length_squared <= 0.0:
        return start
    share = ((px - x) * dx + (py - y) * dy) / length_squared
    # In place of min and max, which Python takes longer to call.
    share = share if share > 0.0 else 0.0
    share = share if share < 1.0 else 1.0
    return (x + share * dx, y + share * dy)


@compilable
def segment_distance(point: Point, start: Point, end: Point) -> float:
    """Return the distance of ``point`` from the segment [m]."""
    return distance(point, closest_point_on_segment(point, start, end))


def segments_distance(start: Point, end: Point, other_start: Point, other_end: Point) -> float:
    """Return the distance between two segments [m]; 0 where they cross."""
    if _side(start, end, other_start) * _side(start, end, other_end) < 0.0 and (
        _side(other_start, other_end, start) * _side(other_start, other_end, end) < 0.0
    ):
        return 0.0
    return min(
        segment_distance(start, other_start, other_end),
        segment_distance(end, other_start, other_end),
        segment_distance(other_start, start, end),
        segment_distance(other_end, start, end),
    )


def _side(start: Point, end: Point, point: Point) -> float:
    """Return on which side of the line ``point`` lies, by its sign; 0 on it."""
    return (end[0] - start[0]) * (point[1] - start[1]) - (end[1] - start[1]) * (point[0] - start[0])


@compilable
def line_crossing_x(start: Point, angle: float, x: float) -> float | None:
    """Return the y at which the ray from ``start`` along ``angle`` crosses the vertical line at ``x``.

    None when the ray points away from the line or runs along it.
    """
    step = cos(angle)
    reach = x - start[0]
    if step == 0.0 or reach * step < 0.0:
        return None
    return start[1] + reach / step * sin(angle)


def to_robot_frame(vx: float, vy: float, heading: float) -> Point:
    """Return a field-frame vector in the frame of a robot with this heading."""
    c, s = cos(heading), sin(heading)
    return (c * vx + s * vy, c * vy - s * vx)


def limit_norm(x: float, y: float, most: float) -> Point:
    """Return the vector shortened to length ``most`` when it is longer."""
    squared = x * x + y * y
    if squared <= most * most:
        return (x, y)
    scale = most / sqrt(squared)
    return (x * scale, y * scale)
