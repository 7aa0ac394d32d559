"""When a ball counts as placed, for many fields at a time.

The challenge's judge and the training task ask the same class. Source: RoboCup SSL rules, chapter "Ball
Placement", and AutoReferee, as in :class:`~robobt.match.referee.rules.placement.PlacementSucceeded`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robobt.match.referee.rules.placement import (
    AVERAGE_SMOOTHING,
    LEARNT_AT,
    OWN_GAP,
    SOONEST,
    STILL_DISTANCE,
)
from robobt.world.geometry import FloatArray
from robobt.world.rules import PLACED_DISTANCE
from robobt.world.state import ROBOT_RADIUS

CLEAR_DISTANCE = ROBOT_RADIUS + OWN_GAP
"""Least distance of a robot's centre from a placed ball whose team takes the free kick [m]."""


class PlacedBalls:
    """Sees whether balls rest at their spots with all robots clear of them.

    The robots belong to the team that takes the free kick.

    Args:
        n: number of fields.
        period: time between two frames [s].
    """

    def __init__(self, n: int, period: float) -> None:
        self._share = AVERAGE_SMOOTHING ** (period / LEARNT_AT)
        self._mean = np.zeros((n, 2))

    def restart(self, which: NDArray[np.int64], balls: FloatArray) -> None:
        """Begin a placement on the fields ``which`` (m,), with the ``balls`` at (m, 2) [m]."""
        self._mean[which] = balls

    def see(
        self, robots: FloatArray, balls: FloatArray, spots: FloatArray, elapsed: FloatArray
    ) -> NDArray[np.bool_]:
        """Take in the next frame of each field; return where the ball is placed, (n,).

        Args:
            robots: places of all robots, (n, R, 2) [m].
            balls: places of the balls, (n, 2) [m].
            spots: where they are to be placed, (n, 2) [m].
            elapsed: time since the placements began, (n,) [s].
        """
        self._mean = self._share * self._mean + (1.0 - self._share) * balls
        placed: NDArray[np.bool_] = (
            (elapsed >= SOONEST)
            & (np.hypot(*(balls - spots).T) <= PLACED_DISTANCE)
            & (np.hypot(*(balls - self._mean).T) <= STILL_DISTANCE)
            & (np.linalg.norm(robots - balls[:, None], axis=2) >= CLEAR_DISTANCE).all(axis=1)
        )
        return placed
