"""Evaluation of a policy from a fixed set of starts, each counted exactly once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from robobt.learning.envs.arena_task import ArenaTask
from robobt.learning.envs.episodes import Episodes
from robobt.learning.envs.task import FloatArray

Decide = Callable[[FloatArray], FloatArray]
"""A policy: (n, O) observations to (n, A) actions in [-1, 1]."""


def run_starts(task: ArenaTask, decide: Decide, starts: ArrayLike, seed: int = 0) -> Episodes:
    """Play one episode from each start, with any number of arenas; return them in the order of the starts.

    Every start is played to its end, so that short episodes are not counted more
    often than long ones.

    ``starts`` (m, 10) have the columns ``START_COLUMNS``; the task's running episodes are lost. ``decide``
    maps observations (n, O) to actions (n, A); ``seed`` is the seed of noise and randomisation.
    """
    rows = np.atleast_2d(np.array(starts, dtype=np.float64))
    observation = task.reset_to(rows, seed)
    parts: list[Episodes] = []
    open_ = len(rows)
    while open_ > 0:
        observation = task.step(decide(observation)).observation
        if task.ended is not None:
            counted = task.ended.pick(task.ended.start >= 0)
            parts.append(counted)
            open_ -= len(counted)
    whole = Episodes.joined(parts)
    return whole.pick(np.argsort(whole.start))
