"""Results of episodes, and the shortest possible time."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robobt.learning.envs.task import BoolArray, FloatArray, IntArray


def straight_line_time(distance: ArrayLike, speed: ArrayLike, acceleration: ArrayLike) -> FloatArray:
    """Compute the shortest times from rest without braking [s].

    Args:
        distance: distance to drive [m].
        speed: top speed [m/s].
        acceleration: acceleration up to the top speed [m/s^2].
    """
    d = np.maximum(np.asarray(distance, dtype=np.float64), 0.0)
    v, a = np.asarray(speed, dtype=np.float64), np.asarray(acceleration, dtype=np.float64)
    return np.where(d * a * 2.0 <= v * v, np.sqrt(2.0 * d / a), d / v + v / (2.0 * a))


@dataclass(slots=True)
class Episodes:
    """Ended episodes, one per entry of each array.

    Attributes:
        start: index in the given starts, -1 for a start that was drawn.
        success: ball reached, or goal scored.
        truncated: cut off by the time limit.
        ticks: duration in control periods.
        time: duration [s].
        optimum: the straight line's time for the robot's limits [s]; nan where
            robot or ball started in motion, and for Shoot.
        kick_time: start to the end of the tick in which the kicker first fired
            [s]; nan without a kick.
        total_reward: undiscounted.
        terms: contribution of each term of the reward, a record with their names.
    """

    start: IntArray
    success: BoolArray
    truncated: BoolArray
    ticks: IntArray
    time: FloatArray
    optimum: FloatArray
    kick_time: FloatArray
    total_reward: FloatArray
    terms: NDArray[np.void]

    def __len__(self) -> int:
        return len(self.start)

    @property
    def time_ratio(self) -> float:
        """Mean time over mean optimum of the successes that have one; nan without any."""
        counts = self.success & np.isfinite(self.optimum) & (self.optimum > 0.0)
        return float(self.time[counts].sum() / self.optimum[counts].sum()) if counts.any() else float("nan")

    def pick(self, which: IntArray | BoolArray) -> Episodes:
        """Return the episodes at these indices."""
        return Episodes(**{item.name: getattr(self, item.name)[which] for item in fields(self)})

    @classmethod
    def joined(cls, parts: list[Episodes]) -> Episodes:
        """Return all episodes of at least one part in one table."""
        names = [item.name for item in fields(cls)]
        return cls(**{name: np.concatenate([getattr(part, name) for part in parts]) for name in names})
