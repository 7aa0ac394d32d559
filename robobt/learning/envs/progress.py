"""How episodes have gone so far, in a form that compiled code reads and writes by name."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from robobt.learning.envs.task import FloatArray


class Progress(Protocol):
    """An episode so far, all in numbers: a row of :data:`PROGRESS`.

    Attributes:
        ticks: since the start.
        ticks_held: for how many in a row the ball has lain in the mouth with the dribbler on.
        kick_tick: in which the kicker first fired; -1 before.
        kick_rewarded: 1 once there was what the reward takes for a kick, 0 before.
        total_reward: undiscounted.
        ball_x, ball_y: the ball before the tick [m].
    """

    ticks: float
    ticks_held: float
    kick_tick: float
    kick_rewarded: float
    total_reward: float
    ball_x: float
    ball_y: float


PROGRESS = np.dtype([(name, np.float64) for name in Progress.__annotations__])
"""How an episode has gone so far; see :class:`Progress`."""


def progress_at(starts: FloatArray) -> NDArray[np.void]:
    """Return the progress of episodes that begin at these starts (m, 10), columns ``START_COLUMNS``."""
    progress = np.zeros(len(starts), dtype=PROGRESS)
    progress["kick_tick"] = -1.0
    progress["ball_x"] = starts[:, 6]
    progress["ball_y"] = starts[:, 7]
    return progress
