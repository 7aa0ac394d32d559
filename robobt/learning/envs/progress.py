"""How episodes have gone so far, in a form that compiled code reads and writes by name."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from robobt.learning.envs.task import FloatArray
from robobt.world.compiled import record_dtype
from robobt.world.records import BALL


class Progress(Protocol):
    """An episode so far, all in numbers: a row of :data:`PROGRESS`.

    Attributes:
        ticks: since the start.
        ticks_held: for how many in a row the ball has lain in the mouth with the dribbler on; where there
            is a goalkeeper, in its mouth.
        kick_tick: in which the kicker first fired; -1 before.
        kick_rewarded: 1 once there was what the reward takes for a kick, or while a shot that it took for
            one is on its way; else 0.
        total_reward: undiscounted.
        ball_x, ball_y: the ball before the tick [m].
        carried_x, carried_y: where the ball came into the mouth it lies in; nan in none [m].
        potential: what the state before the tick is worth to a reward that is shaped by it; nan at first.
    """

    ticks: float
    ticks_held: float
    kick_tick: float
    kick_rewarded: float
    total_reward: float
    ball_x: float
    ball_y: float
    carried_x: float
    carried_y: float
    potential: float


PROGRESS = record_dtype(Progress)
"""How an episode has gone so far; see :class:`Progress`."""


def progress_at(balls: FloatArray) -> NDArray[np.void]:
    """Return the progress of episodes that begin with these balls (m, size(BALL))."""
    starts, progress = balls.view(BALL)[:, 0], np.zeros(len(balls), dtype=PROGRESS)
    progress["kick_tick"] = -1.0
    progress["ball_x"], progress["ball_y"] = starts["x"], starts["y"]
    for name in ("carried_x", "carried_y", "potential"):
        progress[name] = np.nan
    return progress
