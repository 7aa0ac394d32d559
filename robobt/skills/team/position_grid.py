"""A grid of points over the opponent's half, and the shadows that opponents cast on it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache
from math import asin, atan2, ceil, floor, hypot, inf, sqrt, tan

import numpy as np
from numpy.typing import NDArray

from robobt.world.field import FieldGeometry
from robobt.world.geometry import Point
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS, RobotState

EDGE_GAP = 0.2
"""Least distance of a grid point from the field's lines and the opponent's defence area [m]."""

CLUSTER_GAP = 2.0 * ROBOT_RADIUS + 2.0 * BALL_RADIUS + 0.01
"""Opponents with centres closer together than this let no ball through [m].

Source: RoboBulls' published code, AttackMain.
"""

_STEEPEST = 1.55

BoolArray = NDArray[np.bool_]
GridArray = NDArray[np.float32]
"""Single precision takes half the time and is far finer than any grid."""


HalfPlane = tuple[float, float, float]
"""(a, b, c): the points with a x + b y >= c."""

Region = tuple[HalfPlane, HalfPlane, HalfPlane]
"""The overlap of three half planes."""


class PositionGrid:
    """Points ``spacing`` apart over the opponent's half, symmetric about the x axis.

    Every (X, Y) array has a row for each x and a column for each y.

    Attributes:
        x, y: (X, 1) and (1, Y) coordinates [m].
        forbidden: (X, Y), true in the opponent's defence area.
        goal_distance: (X, Y) to the opponent's goal centre [m].
        goal_angle: (X, Y) off the straight way out of the goal, 0 to pi/2 [rad].
    """

    def __init__(self, field: FieldGeometry, spacing: float) -> None:
        self.field = field
        self.spacing = spacing
        rows = max(0, int((field.half_length - EDGE_GAP) / spacing)) + 1
        self._side = max(0, int((field.half_width - EDGE_GAP) / spacing))
        self.x = (np.arange(rows) * spacing).astype(np.float32)[:, None]
        self.y = (np.arange(-self._side, self._side + 1) * spacing).astype(np.float32)[None, :]
        to_goal = field.half_length - self.x
        self.forbidden = (to_goal <= field.defense_depth + EDGE_GAP) & (
            np.abs(self.y) <= field.defense_width / 2.0 + EDGE_GAP
        )
        self.goal_distance = np.hypot(to_goal, self.y)
        self.goal_angle = np.arctan2(np.abs(self.y), to_goal)

    def best(self, value: GridArray) -> tuple[Point, float]:
        """Return the point where ``value`` (X, Y) is largest, and that value."""
        row, column = divmod(int(value.argmax()), value.shape[1])
        return (row * self.spacing, (column - self._side) * self.spacing), float(value[row, column])

    def at(self, value: GridArray, point: Point) -> float:
        """Return ``value`` (X, Y) at the grid point nearest to ``point``; -inf off the grid."""
        x, y = point
        row = round(x / self.spacing)
        column = round(y / self.spacing) + self._side
        rows, columns = value.shape
        return float(value[row, column]) if 0 <= row < rows and 0 <= column < columns else -inf

    def distance_from(self, point: Point) -> GridArray:
        """Return the (X, Y) distances from ``point`` [m]."""
        x, y = point
        distances: GridArray = np.sqrt(np.square(self.x - x) + np.square(self.y - y))
        return distances

    def count_regions(self, regions: Sequence[Region]) -> NDArray[np.uint8]:
        """Count for each point, (X, Y), how many of the regions contain it."""
        if not regions:
            return np.zeros(self.forbidden.shape, dtype=np.uint8)
        a, b, c = np.array(regions, dtype=np.float32).transpose(2, 1, 0)[..., None, None]
        # Each side is one row or column, so that only the comparison fills the grid.
        inside = b * self.y >= c - a * self.x
        inside[0] &= inside[1]
        inside[0] &= inside[2]
        count: NDArray[np.uint8] = np.add.reduce(inside[0].view(np.uint8), axis=0, dtype=np.uint8)
        return count

    def rows(self, low: float, high: float) -> slice:
        """Return the rows with low <= x <= high."""
        first = max(0, ceil(low / self.spacing))
        return slice(first, max(first, floor(high / self.spacing) + 1))

    def goal_hidden(self, opponents: Iterable[RobotState], extra: float) -> list[tuple[slice, BoolArray]]:
        """Find where opponents standing together hide both goal posts: rows, and a mask of them, each.

        The hidden region is between the line from the left post past the leftmost of them and the line from
        the right post past the rightmost, from the robots back to where the lines meet.

        ``extra`` is added to the shadow of each of the opponents on either side [m].
        """
        goal_x = self.field.half_length
        half = self.field.goal_width / 2.0 + extra
        masks = []
        for group in clusters(opponents):
            nearest = max(robot.x for robot in group)
            if nearest >= goal_x:
                continue
            left, right = group[0], group[-1]
            rise = _tangent(goal_x - left.x, left.y - half + extra, 1.0)
            fall = _tangent(goal_x - right.x, right.y + half - extra, -1.0)
            meeting = goal_x - 2.0 * half / (fall - rise) if fall > rise else 0.0
            rows = self.rows(meeting, nearest + ROBOT_RADIUS)
            if rows.start < rows.stop:
                back = goal_x - self.x[rows]
                masks.append((rows, (self.y <= half + back * rise) & (self.y >= back * fall - half)))
        return masks


@lru_cache(maxsize=16)
def position_grid(field: FieldGeometry, spacing: float) -> PositionGrid:
    """Return the grid of a field, cached."""
    return PositionGrid(field, spacing)


def lane_shadow(origin: Point, robot: RobotState, radius: float) -> Region:
    """Return where a ball from ``origin`` would have to pass within ``radius`` [m] of ``robot``.

    Only points farther away than the robot count. A robot within ``radius`` shadows the whole half plane
    behind it.
    """
    x, y = origin
    dx, dy = robot.x - x, robot.y - y
    gap = max(hypot(dx, dy), 1e-9)
    ux, uy = dx / gap, dy / gap
    behind = (ux, uy, ux * x + uy * y + gap)
    if gap <= radius:
        return (behind, behind, behind)
    slope = radius / sqrt(gap * gap - radius * radius)
    # slope * along +- across >= 0, both measured from the origin.
    ax, ay = slope * ux - uy, slope * uy + ux
    bx, by = slope * ux + uy, slope * uy - ux
    left = (ax, ay, ax * x + ay * y)
    right = (bx, by, bx * x + by * y)
    return (behind, left, right)


def shot_path(field: FieldGeometry, origin: Point, room: float) -> Region:
    """Return the region between ``origin`` and the opponent's goal, up to ``room`` [m] beside either post."""
    x, y = origin
    reach = field.half_length - x
    half = field.goal_width / 2.0 + room
    above = (half + y, reach, (half + y) * x + reach * y)
    below = (half - y, -reach, (half - y) * x - reach * y)
    return ((1.0, 0.0, x), above, below)


def clusters(robots: Iterable[RobotState]) -> list[Sequence[RobotState]]:
    """Group robots that let no ball through between them, in order from left (+y) to right."""
    groups: list[list[RobotState]] = []
    for robot in sorted(robots, key=lambda robot: -robot.y):
        if groups and hypot(robot.x - groups[-1][-1].x, robot.y - groups[-1][-1].y) < CLUSTER_GAP:
            groups[-1].append(robot)
        else:
            groups.append([robot])
    return list(groups)


def _tangent(back: float, across: float, side: float) -> float:
    """Return the slope of the line past one side of a robot ``back`` behind and ``across`` beside a post."""
    gap = max(hypot(back, across), 1e-9)
    angle = atan2(across, back) + side * asin(min(1.0, ROBOT_RADIUS / gap))
    return tan(min(_STEEPEST, max(-_STEEPEST, angle)))
