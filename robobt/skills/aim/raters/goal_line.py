"""The goal line as a row of target points: shared by every rater that tries points."""

from __future__ import annotations

from base64 import b64decode, b64encode
from functools import lru_cache
from math import atan2, erfc, sqrt

import numpy as np
from numpy.typing import NDArray

from robobt.skills.aim.raters.base import best_first
from robobt.skills.store import GoalLine, Shot
from robobt.world.compiled import compiled
from robobt.world.field import FieldGeometry
from robobt.world.geometry import FloatArray, Point
from robobt.world.state import BALL_RADIUS, Frame, RobotState

POST_GAP = BALL_RADIUS + 0.01
"""Least distance of a target point from a post [m]. Source: the paper's shot selection."""

_MOST_POINTS = 100
"""Number of points kept of a judged goal line."""

_NOTICED = 2
"""A judged goal line counts as changed when a point differs by more than this [%]."""


def goal_candidates(field: FieldGeometry, spacing: float = 0.01) -> FloatArray:
    """Return target points on the opponent's goal line, from the right post (y < 0) to the left.

    The row has as many points as fit between the posts, leaving :data:`POST_GAP` free at either post: 94 for
    a goal of 1 m at the paper's spacing of 10 mm. It is centred on the goal, so it is its own mirror image;
    the paper's row starts at the right end, up to half a spacing off centre. The array is (T, 2) [m] and
    read-only. ``field`` has the goal, and ``spacing`` is that of the points [m].
    """
    return _candidates(field.half_length, field.goal_width, spacing)


@lru_cache(maxsize=64)
def _candidates(x: float, goal_width: float, spacing: float) -> FloatArray:
    usable = max(0.0, goal_width - 2.0 * POST_GAP)
    count = int(usable / spacing + 1e-9) + 1
    y = (np.arange(count) - (count - 1) / 2.0) * spacing
    points = np.column_stack((np.full(count, x), y))
    points.flags.writeable = False
    return points


def directions(origin: Point, points: FloatArray) -> FloatArray:
    """Compute the direction of every point (T, 2) from ``origin``, (T,) [rad]."""
    (x, y), (px, py) = origin, points.T
    found: FloatArray = np.arctan2(py - y, px - x)
    return found


def obstacles(frame: Frame, me: RobotState) -> FloatArray:
    """Return the centres of all robots but ``me``, own ones first, (K, 2) [m]."""
    return np.array([(robot.x, robot.y) for robot in frame.others(me.id)], dtype=np.float64).reshape(-1, 2)


def lane_clearances(
    origin: Point, targets: FloatArray, centres: FloatArray, *, behind: bool = False
) -> FloatArray:
    """Compute the distance of every obstacle from every straight lane origin -> target, (T, K) [m].

    An obstacle whose nearest point on the lane would be behind the origin is not in the ball's way, so its
    distance is infinite; with ``behind`` it is the obstacle's distance from the origin.

    ``targets`` (T, 2) and ``centres`` (K, 2) are in metres; ``behind`` says whether obstacles behind the
    origin count.
    """
    dx, dy = (targets - origin).T[:, :, None]
    ox, oy = (centres - origin).T[:, None, :]
    length_squared = dx * dx + dy * dy
    along = dx * ox + dy * oy
    across = dx * oy
    across -= dy * ox
    across *= across
    across /= np.maximum(length_squared, 1e-12)
    beyond = along > length_squared
    if beyond.any():
        to_end = np.square(ox - dx) + np.square(oy - dy)
        across = np.where(beyond, to_end, across)
    past = along <= 0.0
    across = np.where(past, ox * ox + oy * oy, across) if behind else np.where(past, np.inf, across)
    distances: FloatArray = np.sqrt(across)
    return distances


def runs(clear: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Find groups of neighbouring true entries as (first, one past the last), in order."""
    padded = np.zeros(len(clear) + 2, dtype=np.bool_)
    padded[1:-1] = clear
    edges = np.flatnonzero(padded[1:] != padded[:-1]).tolist()
    return list(zip(edges[::2], edges[1::2], strict=True))


def shots_at_groups(
    points: FloatArray, good: NDArray[np.bool_], spacing: float, origin: Point, heading: float
) -> list[Shot]:
    """Return a shot at the middle of each group of neighbouring good points, the best first.

    The score is the group's share of all points, the tolerance half the angle the group spans.
    """
    x, y = origin
    margin = spacing / 2.0
    shots = []
    for first, stop in runs(good):
        (goal_x, low), (_, high) = points[first].tolist(), points[stop - 1].tolist()
        reach = goal_x - x
        angle = atan2(high + margin - y, reach) - atan2(low - margin - y, reach)
        shots.append(Shot((goal_x, (low + high) / 2.0), angle / 2.0, (stop - first) / len(points)))
    return best_first(shots, origin, heading)


def normal_cdf(values: FloatArray) -> FloatArray:
    """Return the cumulative distribution of the standard normal, elementwise."""
    return _normal_cdf(np.atleast_1d(values).ravel()).reshape(np.shape(values))


@compiled
def _normal_cdf(values: FloatArray) -> FloatArray:
    # scipy's version is avoided: importing scipy takes longer than importing all skills.
    return np.array([0.5 * erfc(-value * sqrt(0.5)) for value in values])


def judged_goal_line(points: FloatArray, chances: FloatArray, before: GoalLine | None = None) -> GoalLine:
    """Return the judged goal line, or ``before`` if it differs too little to be visible.

    ``points`` (T, 2) lie on the goal line, evenly from right to left [m]; ``chances`` (T,) are in [0, 1].
    """
    percent = 100.0 * chances
    if len(percent) > _MOST_POINTS:
        kept = np.linspace(0.0, len(percent) - 1.0, _MOST_POINTS)
        percent = np.interp(kept, np.arange(len(percent)), percent)
    _, y = points.T
    reach = round(float(y[-1] - y[0]) / 2.0, 6)
    whole = np.rint(percent).astype(np.uint8)
    if before is not None and before.reach == reach:
        old = np.frombuffer(b64decode(before.chances), dtype=np.uint8)
        if len(old) == len(whole) and bool((np.abs(percent - old) <= _NOTICED).all()):
            return before
    return GoalLine(reach, b64encode(whole.tobytes()).decode("ascii"))
