"""What cameras saw of a field and what robots were commanded: all that identification works on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robobt.world.field import FieldGeometry
from robobt.world.geometry import FloatArray
from robobt.world.state import RobotId


@dataclass(slots=True)
class CameraViews:
    """What each camera saw by itself, in the order of time; P is the number of its pictures.

    A camera takes every ball to lie on the ground.

    Attributes:
        times: (P,) times at which the pictures were taken [s].
        cameras: (P,) number of the camera.
        ball: (P, 2) x, y [m]; NaN where the ball was not seen.
        poses: (P, K, 3) x, y [m], heading [rad] of the robots in the order of the observations.
        places: x, y and height above the ground of those cameras whose place is known [m].
    """

    times: FloatArray
    cameras: NDArray[np.int64]
    ball: FloatArray
    poses: FloatArray
    places: Mapping[int, tuple[float, float, float]]

    def between(self, start: float, end: float) -> CameraViews:
        """Return the part from the time ``start`` up to the time ``end`` [s]."""
        kept = (self.times >= start) & (self.times < end)
        return CameraViews(
            self.times[kept], self.cameras[kept], self.ball[kept], self.poses[kept], self.places
        )


@dataclass(slots=True)
class Observations:
    """A stretch of play as it was seen, in world coordinates (blue defends -x), SI units.

    T is the number of pictures, C that of the times at which commands were sent, K that of the robots.

    Attributes:
        field: dimensions.
        robots: the robots, in the order of the arrays.
        times: (T,) times at which the pictures were taken or, where that is not known, arrived; rising [s].
        ball: (T, 2) x, y [m]; NaN where the ball was not seen.
        poses: (T, K, 3) x, y [m], heading [rad]; NaN where a robot was not seen.
        sent: (C,) times at which commands were sent, by the clock of ``times`` as it is here; rising [s].
        commands: (C, K, 6) vx, vy [m/s], omega [rad/s] in the robot's own frame, kick speed [m/s] (0: none),
            angle of the kick from the ground [rad], 1 for the dribbler; NaN for robots whose commands are
            not known.
        age: time from a picture to its arrival [s]; 0 if ``times`` are times of arrival.
        cameras: (T,) number of the camera that took the picture, -1 for several at once; None where there is
            a single view.
        views: what each camera saw by itself; None where only what all saw together is known.
        alone: mean of 1 over the number of cameras that a place of the ball comes from.
    """

    field: FieldGeometry
    robots: tuple[RobotId, ...]
    times: FloatArray
    ball: FloatArray
    poses: FloatArray
    sent: FloatArray
    commands: FloatArray
    age: float = 0.0
    cameras: NDArray[np.int64] | None = None
    views: CameraViews | None = None
    alone: float = 1.0

    def __len__(self) -> int:
        return len(self.times)

    @property
    def period(self) -> float:
        """Median time from one picture to the next [s]."""
        return float(np.median(np.diff(self.times))) if len(self) > 1 else 0.0

    def commanded(self, robot: int) -> bool:
        """Return whether any command to the robot at this place of the arrays is known."""
        return bool(np.isfinite(self.commands[:, robot, 0]).any())

    def between(self, start: float, end: float) -> Observations:
        """Return the part from ``start`` up to ``end``, in seconds after the first picture."""
        since = self.times - self.times[0]
        kept = (since >= start) & (since < end)
        sent = (self.sent - self.times[0] >= start) & (self.sent - self.times[0] < end)
        return Observations(
            self.field,
            self.robots,
            self.times[kept],
            self.ball[kept],
            self.poses[kept],
            self.sent[sent],
            self.commands[sent],
            self.age,
            None if self.cameras is None else self.cameras[kept],
            None if self.views is None else self.views.between(self.times[0] + start, self.times[0] + end),
            self.alone,
        )


def without_repeats(seen: FloatArray) -> FloatArray:
    """Return positions with NaN wherever one repeats the last to the last digit, as a lost detection does.

    Without noise a thing at rest repeats its position as well. Then many in a row are equal, and nothing
    trembles; such positions stay.

    Args:
        seen: (T, d) positions.
    """
    result = np.array(seen, dtype=float)
    repeated = np.append(False, (result[1:] == result[:-1]).all(axis=1)) if len(result) else np.zeros(0, bool)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], repeated, [False]])))
    steps = np.diff(result[:, :2], axis=0)
    moved = steps[~repeated[1:] & np.isfinite(steps[:, 0])]
    back = (moved[1:] * moved[:-1]).sum(axis=1) < 0.0
    short = len(edges) > 0 and np.median(edges[1::2] - edges[::2]) <= _SHORT
    if short or (len(back) > 0 and back.mean() > _TREMBLES):
        result[repeated] = np.nan
    return result


_SHORT, _TREMBLES = 2, 0.1
"""Usual number of detections lost in a row, and the share of steps back from which positions tremble."""
