"""How episodes have gone so far, in a form that compiled code reads and writes by name."""

from __future__ import annotations

from math import hypot
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from robobt.learning.envs.task import FloatArray
from robobt.world.compiled import compiled

PROGRESS = np.dtype(
    [
        (name, np.float64)
        for name in (
            "ticks",
            "ticks_held",
            "kick_tick",
            "kick_rewarded",
            "way",
            "total_reward",
            "robot_x",
            "robot_y",
            "ball_x",
            "ball_y",
        )
    ]
)
"""How an episode has gone so far; see :class:`Progress`."""


class Progress(Protocol):
    """An episode so far, all in numbers: a row of :data:`PROGRESS`.

    Attributes:
        ticks: since the start.
        ticks_held: for how many in a row the ball has lain in the mouth with the dribbler on.
        kick_tick: in which the kicker first fired; -1 before.
        kick_rewarded: 1 once there was what the reward takes for a kick, 0 before.
        way: length of the way driven [m].
        total_reward: undiscounted.
        robot_x, robot_y, ball_x, ball_y: before the tick [m].
    """

    ticks: float
    ticks_held: float
    kick_tick: float
    kick_rewarded: float
    way: float
    total_reward: float
    robot_x: float
    robot_y: float
    ball_x: float
    ball_y: float


def progress_at(starts: FloatArray) -> NDArray[np.void]:
    """Return the progress of episodes that begin at these starts (m, 10), columns ``START_COLUMNS``."""
    progress = np.zeros(len(starts), dtype=PROGRESS)
    progress["kick_tick"] = -1.0
    for column, name in ((0, "robot_x"), (1, "robot_y"), (6, "ball_x"), (7, "ball_y")):
        progress[name] = starts[:, column]
    return progress


@compiled
def count_tick(progress: Progress, robot: FloatArray) -> None:
    """Count a tick and the way driven in it; ``robot`` (6,) is the state after it."""
    progress.ticks += 1
    progress.way += hypot(robot[0] - progress.robot_x, robot[1] - progress.robot_y)
    progress.robot_x = robot[0]
    progress.robot_y = robot[1]
