"""The goal mouth as an interval of directions, minus the directions that robots hide."""

from __future__ import annotations

from collections.abc import Iterable
from math import asin, atan2, hypot, pi, tan

from robobt.skills.aim.raters.base import best_first
from robobt.skills.store import Shot
from robobt.world.field import FieldGeometry
from robobt.world.geometry import Point

Interval = tuple[float, float]

_SLIVER = 1e-9


def goal_mouth(field: FieldGeometry, origin: Point, inset: float) -> Interval | None:
    """Return the directions from ``origin`` to the right and the left post [rad], ``inset`` further in [m].

    None from a point on or behind the goal line.
    """
    x, y = origin
    reach = field.half_length - x
    half = field.goal_width / 2.0 - inset
    if reach <= 0.0 or half <= 0.0:
        return None
    return (atan2(-half - y, reach), atan2(half - y, reach))


def disc_shadow(field: FieldGeometry, origin: Point, centre: Point, radius: float) -> Interval | None:
    """Return the directions that a disc hides from ``origin`` [rad], not wrapped.

    A disc that reaches over the origin hides the half plane on its side. One
    that lies wholly behind the goal line hides nothing (None).
    """
    (x, y), (centre_x, centre_y) = origin, centre
    if centre_x - radius >= field.half_length:
        return None
    dx, dy = centre_x - x, centre_y - y
    gap = hypot(dx, dy)
    middle = atan2(dy, dx)
    half = asin(radius / gap) if gap > radius else pi / 2.0
    return (middle - half, middle + half)


def free_intervals(mouth: Interval, shadows: list[Interval]) -> list[Interval]:
    """Return the intervals of the mouth that no shadow covers, in order."""
    low, high = mouth
    free = []
    for start, end in sorted(shadows):
        if start >= high:
            break
        if start - low > _SLIVER:
            free.append((low, start))
        if end > low:
            low = end
    if high - low > _SLIVER:
        free.append((low, high))
    return free


def opening_shots(
    field: FieldGeometry,
    origin: Point,
    heading: float,
    inset: float,
    discs: Iterable[tuple[Point, float]],
    full_angle: float,
) -> list[Shot]:
    """Return a shot along the bisector of each opening between the discs, the best first.

    The score is the opening's width as a share of ``full_angle``, at most 1.

    ``inset`` is the width taken off the goal at either post [m], ``discs`` are the centre and radius of
    everything in the way [m], and an opening of ``full_angle`` [rad] scores 1.
    """
    mouth = goal_mouth(field, origin, inset)
    if mouth is None:
        return []
    shadows = [disc_shadow(field, origin, centre, radius) for centre, radius in discs]
    x, y = origin
    reach = field.half_length - x
    shots = []
    for low, high in free_intervals(mouth, [shadow for shadow in shadows if shadow is not None]):
        target = (field.half_length, y + reach * tan((low + high) / 2.0))
        shots.append(Shot(target, (high - low) / 2.0, min((high - low) / full_angle, 1.0)))
    return best_first(shots, origin, heading)
