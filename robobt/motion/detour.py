"""Ways round circular obstacles: the geometry beneath the path planner."""

from __future__ import annotations

from math import acos, atan2, cos, hypot, inf, pi, sin, sqrt, tan

from robobt.world.geometry import Point

Circle = tuple[float, float, float]
"""Centre x and y, radius [m]."""

_CLEARANCE = 0.04
"""How much wider than the blocking circle a detour is, so that the next plan finds it free [m]."""
_WIDEST_TURN = 0.9


def first_hit(start: Point, end: Point, circles: list[Circle], end_counts: bool) -> Circle | None:
    """Return the circle that the segment enters first, shrunk to leave out the segment's ends.

    ``end_counts`` says whether a circle around the end is shrunk too.
    """
    x, y = start
    gx, gy = end
    dx, dy = gx - x, gy - y
    length = hypot(dx, dy)
    if length < 1e-6:
        return None
    ux, uy = dx / length, dy / length
    nearest = inf
    hit: Circle | None = None
    for cx, cy, radius in circles:
        ox, oy = cx - x, cy - y
        ahead = ox * ux + oy * uy
        if ahead <= 0.0 or ahead >= length + radius:
            continue
        across = ox * uy - oy * ux
        if across >= radius or across <= -radius:
            continue
        to_start = hypot(ox, oy)
        if to_start < radius:
            radius = to_start * 0.999
        if end_counts:
            to_end = hypot(cx - gx, cy - gy)
            if to_end < radius:
                radius = to_end * 0.999
        half_chord = radius * radius - across * across
        if half_chord <= 0.0:
            continue
        entry = ahead - sqrt(half_chord)
        if entry < length and entry < nearest:
            nearest = entry
            hit = (cx, cy, radius)
    return hit


def detour(
    start: Point, end: Point, circle: Circle, side: float, circles: list[Circle], depth: int
) -> tuple[Point, float, float]:
    """Compute the first waypoint round ``circle`` on one side.

    A ``side`` of 1 leaves the circle to the right, -1 to the left; ``depth`` is how many more circles to go
    round on the first leg.

    Returns:
        The point where the tangents from start and end meet, the length of the
        path plus a penalty for what else is in it, and the angle turned there.
    """
    cx, cy, radius = circle
    wide = radius + _CLEARANCE
    sx, sy = start[0] - cx, start[1] - cy
    gx, gy = end[0] - cx, end[1] - cy
    to_start, to_end = hypot(sx, sy), hypot(gx, gy)
    near, far = min(wide, to_start), min(wide, to_end)
    turned = (atan2(sy, sx) - atan2(gy, gx)) * side % (2.0 * pi)
    to_tangent = acos(near / to_start) if to_start > 0.0 else 0.0
    arc = max(0.0, turned - to_tangent - (acos(far / to_end) if to_end > 0.0 else 0.0))
    leg = sqrt(max(0.0, to_start * to_start - near * near))
    cost = leg + wide * arc + sqrt(max(0.0, to_end * to_end - far * far))
    tangent = atan2(-sy, -sx) + side * (pi / 2.0 - to_tangent)
    reach = leg + near * tan(min(arc / 2.0, _WIDEST_TURN)) + 0.01
    corner = (start[0] + reach * cos(tangent), start[1] + reach * sin(tangent))
    if depth > 0:
        others = [other for other in circles if other[0] != cx or other[1] != cy]
        blocking = first_hit(start, corner, others, False)
        if blocking is not None:
            point, extra, bend = detour(start, corner, blocking, side, others, depth - 1)
            return (point, cost + extra - reach + 0.1, arc + bend)
        if first_hit(corner, end, others, True) is not None:
            cost += 0.2
    return (corner, cost, arc)
