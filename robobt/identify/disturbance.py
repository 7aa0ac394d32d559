"""When a robot may be pushed by another one, a wall or a goal."""

from __future__ import annotations

from math import inf

import numpy as np

from robobt.identify.free_ball import carried_on
from robobt.identify.observations import Observations
from robobt.world.state import ROBOT_RADIUS

_TOUCHING, _RECOVERY = 2 * ROBOT_RADIUS + 0.02, 0.25
"""Robots nearer than this may push each other [m], and for how long afterwards nothing is concluded [s]."""


def undisturbed(seen: Observations, robot: int) -> np.ndarray:
    """Return (T,) whether neither another robot nor a wall touches this robot, or has done so just before.

    Args:
        seen: what cameras saw.
        robot: place of the robot in the arrays.
    """
    poses = carried_on(seen.poses)
    gaps = np.hypot(*(poses[:, :, :2] - poses[:, robot : robot + 1, :2]).transpose(2, 0, 1))
    gaps[:, robot] = inf
    x, y = np.abs(poses[:, robot, :2]).T
    outer_x, outer_y = seen.field.outer
    near = _TOUCHING / 2.0
    at_goal = (x > seen.field.half_length - near) & (y < seen.field.goal_width / 2 + near)
    touching = (gaps.min(axis=1) < _TOUCHING) | at_goal | (x > outer_x - near) | (y > outer_y - near)
    since = np.where(touching, seen.times, -inf)
    return np.asarray(seen.times - np.maximum.accumulate(since) > _RECOVERY)
