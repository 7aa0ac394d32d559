"""The progress of episodes, as a record that compiled code accesses by name."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from robobt.learning.envs.task import FloatArray
from robobt.world.compiled import record_dtype
from robobt.world.records import BALL


class EpisodeProgress(Protocol):
    """The progress of one episode: a row of :data:`PROGRESS`.

    Attributes:
        ticks: ticks since the start.
        ticks_held: ticks in a row with the ball in the mouth and the dribbler on; with a goalkeeper, in the
            goalkeeper's mouth.
        kick_tick: tick in which the kicker first fired; -1 before.
        kick_rewarded: 1 once a kick has been rewarded, or while a rewarded shot is on its way; else 0.
        total_reward: undiscounted sum of rewards.
        ball_x, ball_y: position of the ball before the tick [m].
            carried_x, carried_y: where the ball came into the present mouth [m]; nan if it is in none.
        potential: potential of the state before the tick, for reward shaping; nan at first.
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


PROGRESS = record_dtype(EpisodeProgress)
"""Record of the progress of an episode; see :class:`EpisodeProgress`."""


def progress_at(balls: FloatArray) -> NDArray[np.void]:
    """Return the progress of new episodes with these balls (m, size(BALL))."""
    starts, progress = balls.view(BALL)[:, 0], np.zeros(len(balls), dtype=PROGRESS)
    progress["kick_tick"] = -1.0
    progress["ball_x"], progress["ball_y"] = starts["x"], starts["y"]
    for name in ("carried_x", "carried_y", "potential"):
        progress[name] = np.nan
    return progress
