"""Ways round circular obstacles: the geometry beneath the path planner, compiled."""

from __future__ import annotations

from math import acos, atan2, cos, hypot, inf, pi, sin, sqrt, tan

import numpy as np

from robobt.world.compiled import compiled
from robobt.world.geometry import FloatArray

_CLEARANCE = 0.04
"""How much wider than the blocking circle a detour is, so that the next plan finds it free [m]."""
_WIDEST_TURN = 0.9


@compiled
def first_hit(
    x: float, y: float, gx: float, gy: float, circles: FloatArray, end_counts: bool
) -> tuple[int, float]:
    """Find the circle that the segment from (x, y) to (gx, gy) enters first.

    ``circles`` are (n, 3), centre and radius [m]; each is shrunk to leave out the segment's start.
    ``end_counts`` says whether one around the end is shrunk too.

    Returns:
        Its row, -1 where there is none, and its radius, shrunk [m].
    """
    dx, dy = gx - x, gy - y
    length = hypot(dx, dy)
    hit, hit_radius = -1, 0.0
    if length < 1e-6:
        return hit, hit_radius
    ux, uy = dx / length, dy / length
    nearest = inf
    for i in range(len(circles)):
        cx, cy, radius = circles[i, 0], circles[i, 1], circles[i, 2]
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
            hit, hit_radius = i, radius
    return hit, hit_radius


@compiled
def detour(
    x: float,
    y: float,
    gx: float,
    gy: float,
    circle: FloatArray,
    side: float,
    others_side: float,
    circles: FloatArray,
    depth: int,
) -> tuple[float, float, float, float, bool]:
    """Compute the first waypoint from (x, y) to (gx, gy) round ``circle`` on one side.

    A ``side`` of 1 leaves the circle to the right, -1 to the left, and ``others_side`` is the same for what
    is in the way to it; ``depth`` is how many more of ``circles`` to go round on the first leg.

    Returns:
        The point where the tangents from start and end meet, x and y, the length of the
        path plus a penalty for what else is in it, the angle turned there, and whether anything
        was in the way to the circle.
    """
    # In a loop, not by calling itself: numba loads functions that do so from its cache broken.
    costs, reaches, arcs = np.empty(depth + 1), np.empty(depth + 1), np.empty(depth + 1)
    others = circles
    n = 0
    while True:
        cx, cy, radius = circle[0], circle[1], circle[2]
        wide = radius + _CLEARANCE
        to_start, to_end = hypot(x - cx, y - cy), hypot(gx - cx, gy - cy)
        near, far = min(wide, to_start), min(wide, to_end)
        turned = (atan2(y - cy, x - cx) - atan2(gy - cy, gx - cx)) * side % (2.0 * pi)
        to_tangent = acos(near / to_start) if to_start > 0.0 else 0.0
        arc = max(0.0, turned - to_tangent - (acos(far / to_end) if to_end > 0.0 else 0.0))
        leg = sqrt(max(0.0, to_start * to_start - near * near))
        cost = leg + wide * arc + sqrt(max(0.0, to_end * to_end - far * far))
        tangent = atan2(cy - y, cx - x) + side * (pi / 2.0 - to_tangent)
        reach = leg + near * tan(min(arc / 2.0, _WIDEST_TURN)) + 0.01
        corner_x, corner_y = x + reach * cos(tangent), y + reach * sin(tangent)
        if n == depth:
            break
        others = others[np.flatnonzero((others[:, 0] != cx) | (others[:, 1] != cy))]
        blocking, shrunk = first_hit(x, y, corner_x, corner_y, others, False)
        if blocking < 0:
            if first_hit(corner_x, corner_y, gx, gy, others, True)[0] >= 0:
                cost += 0.2
            break
        # Something is in the way to the corner: round that first.
        costs[n], reaches[n], arcs[n] = cost, reach, arc
        n += 1
        gx, gy, side = corner_x, corner_y, others_side
        circle = np.array((others[blocking, 0], others[blocking, 1], shrunk))
    for k in range(n - 1, -1, -1):
        cost = costs[k] + cost - reaches[k] + 0.1
        arc = arcs[k] + arc
    return corner_x, corner_y, cost, arc, n > 0
