"""What a robot touches in the obstacle challenge, for many fields at a time.

The challenge's judge and the training task ask the same function. Source: RoboCup 2025 Obstacle Avoidance
Challenge.
"""

from __future__ import annotations

from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from robobt.world.field import FieldGeometry
from robobt.world.geometry import FloatArray
from robobt.world.rules import AREA_DISTANCE, STOP_DISTANCE
from robobt.world.state import ROBOT_RADIUS

HULLS_TOUCH = 2.0 * ROBOT_RADIUS + 0.002
"""Two robots whose centres are this near touch [m]; contact is seen once a tick."""


class CourseTouch(IntEnum):
    """What a robot touches; the first of several counts."""

    NOTHING = 0
    ROBOT = 1
    AREA = 2
    BALL_WAY = 3
    LINE = 4


def touched(
    me: FloatArray,
    others: FloatArray,
    ball: FloatArray,
    spot: FloatArray,
    line: FloatArray,
    field: FieldGeometry,
) -> NDArray[np.int64]:
    """Return the :class:`CourseTouch` in each field, (n,); places are [m], NaN where there is no such thing.

    Args:
        me: place of the robot, which attacks towards +x, (n, 2).
        others: places of the other robots, (n, R, 2).
        ball: place of a ball that the opponents place, (n, 2).
        spot: where it is to be placed, (n, 2).
        line: both ends of the line that may not be touched, (n, 2, 2).
        field: the field.
    """
    gaps = np.linalg.norm(others - me[:, None], axis=2)
    ahead = np.maximum(0.0, field.half_length - field.defense_depth - me[:, 0])
    aside = np.maximum(0.0, np.abs(me[:, 1]) - field.defense_width / 2.0)
    found = np.select(
        [
            (gaps <= HULLS_TOUCH).any(axis=1),
            np.hypot(ahead, aside) < AREA_DISTANCE + ROBOT_RADIUS,
            _segment_gap(me, ball, spot) < STOP_DISTANCE + ROBOT_RADIUS,
            _segment_gap(me, line[:, 0], line[:, 1]) <= ROBOT_RADIUS,
        ],
        [CourseTouch.ROBOT, CourseTouch.AREA, CourseTouch.BALL_WAY, CourseTouch.LINE],
        CourseTouch.NOTHING,
    )
    return np.asarray(found, dtype=np.int64)


def _segment_gap(places: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """Return the distance of each place from its segment, NaN where an end is NaN."""
    way, to = end - start, places - start
    length = (way * way).sum(axis=1)
    share = np.clip((to * way).sum(axis=1) / np.where(length > 0.0, length, 1.0), 0.0, 1.0)
    gap: FloatArray = np.linalg.norm(to - share[:, None] * way, axis=1)
    return gap
