"""Arenas with learners on both teams, of which only blue's learn."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from robobt.learning.envs.per_robot import PerRobot
from robobt.learning.envs.task import FloatArray, StepResult

Others = Callable[[FloatArray], FloatArray]
"""The policy in place of yellow's learners: observations (arenas, k, O) to actions (arenas, k, A)."""


class OneSide:
    """A :class:`~robobt.learning.envs.task.VectorTask` with a row for each of blue's learners of ``rows``."""

    def __init__(self, rows: PerRobot, others: Others) -> None:
        self._rows = rows
        self._others = others
        self._blue = np.array(rows.task.learners) < rows.blue
        self._own = rows.observation.size
        self.n = rows.task.n * int(self._blue.sum())
        self.observation_size = rows.observation_size
        self.action_size = rows.action_size

    def reset(self, seed: int | None = None) -> FloatArray:
        """See :meth:`robobt.learning.envs.task.VectorTask.reset`."""
        return self._learners(self._rows.reset(seed))

    def step(self, actions: FloatArray) -> StepResult:
        """See :meth:`robobt.learning.envs.task.VectorTask.step`."""
        all_ = np.empty((self._rows.task.n, len(self._blue), self.action_size))
        all_[:, self._blue] = actions.reshape(len(all_), -1, self.action_size)
        all_[:, ~self._blue] = self._others(self._yellow)
        result = self._rows.step(all_.reshape(-1, self.action_size))
        kept = np.tile(self._blue, len(all_))
        return StepResult(
            self._learners(result.observation),
            result.reward[kept],
            result.terminated[kept],
            result.truncated[kept],
            result.final_observation[kept],
            result.success[kept],
        )

    def _learners(self, seen: FloatArray) -> FloatArray:
        """Store the observations of yellow's learners; return blue's rows."""
        each = seen.reshape(self._rows.task.n, len(self._blue), -1)
        self._yellow = each[:, ~self._blue, : self._own]
        return each[:, self._blue].reshape(self.n, -1)
