"""What the two robots of the cooperation challenge earn, on many fields at a time.

The challenge's judge and the training task ask the same class. Source: RoboCup 2026 SSL RCJ Cooperation
Challenge.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robobt.world.field import FieldGeometry
from robobt.world.geometry import FloatArray

MAJOR_ROW, JUNIOR_ROW = 0, 1
"""Places of the robot that shoots first and of the junior robot, which scores, in the arrays."""

STARTS_MOVING = 0.1
"""Speed from which robot or ball do not stay still [m/s]."""

BoolArray = NDArray[np.bool_]


class Handover:
    """Counts the points of tries, without what broken rules cost.

    The junior robot earns 6 points for a touch, 4 for one in the attacked half, 6 for a shot into the penalty
    area, 10 for the goal, and 10 each for a goal within 15 and 20 s.

    Args:
        n: number of fields.
        field: their size.

    Attributes:
        shot: whether the major robot has shot, (n,).
        early: whether the junior robot moved before that, (n,).
        touched: whether the junior robot has touched the ball, (n,).
        scored: when the junior robot scored, (n,) [s]; nan before.
    """

    def __init__(self, n: int, field: FieldGeometry) -> None:
        self._front = field.half_length - field.defense_depth
        self._side = field.defense_width / 2.0
        self.shot, self.early, self.touched = (np.zeros(n, dtype=np.bool_) for _ in range(3))
        self._ahead, self._in_area = (np.zeros(n, dtype=np.bool_) for _ in range(2))
        self.scored = np.full(n, np.nan)

    def restart(self, which: NDArray[np.int64]) -> None:
        """Begin a try on the fields ``which``."""
        for told in (self.shot, self.early, self.touched, self._ahead, self._in_area):
            told[which] = False
        self.scored[which] = np.nan

    def see(
        self,
        speeds: FloatArray,
        touching: BoolArray,
        last: NDArray[np.int64],
        ball: FloatArray,
        ball_speed: FloatArray,
        goal: BoolArray,
        time: FloatArray,
    ) -> None:
        """Take in the next true frame of each field; the robots attack towards +x.

        Args:
            speeds: of both robots, (n, 2) [m/s].
            touching: which of them touch the ball, (n, 2).
            last: which touched it last, -1 for neither, (n,).
            ball: its place, (n, 2) [m].
            ball_speed: (n,) [m/s].
            goal: whether it has just gone into the goal, (n,).
            time: since the try began, (n,) [s].
        """
        self.shot |= (last == MAJOR_ROW) & ~touching[:, MAJOR_ROW] & (ball_speed > STARTS_MOVING)
        self.early |= ~self.shot & (speeds[:, JUNIOR_ROW] > STARTS_MOVING)
        junior, at_it = last == JUNIOR_ROW, touching[:, JUNIOR_ROW]
        self.touched |= junior
        self._ahead |= junior & at_it & (ball[:, 0] > 0.0)
        inside = (ball[:, 0] >= self._front) & (np.abs(ball[:, 1]) <= self._side)
        self._in_area |= junior & ~at_it & inside
        new = junior & goal & np.isnan(self.scored)
        self.scored[new] = time[new]

    @property
    def points(self) -> FloatArray:
        """The points so far, (n,)."""
        points: FloatArray = 6.0 * self.touched + 4.0 * self._ahead + 6.0 * self._in_area
        for earned, limit in ((10.0, np.inf), (10.0, 15.0), (10.0, 20.0)):
            # A comparison with nan is false.
            points = points + earned * (self.scored <= limit + 1e-9)
        return points
