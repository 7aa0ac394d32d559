"""Every learner of a task as a separate row, so that one policy learns for all of them."""

from __future__ import annotations

import numpy as np
from gymnasium.spaces import Box
from numpy.typing import ArrayLike

from robobt.learning.envs.arena_task import ArenaTask
from robobt.learning.envs.episodes import Episodes
from robobt.learning.envs.task import FloatArray, StepResult
from robobt.sim.arenas import Arenas


class PerRobot:
    """A :class:`~robobt.learning.envs.task.VectorTask` with a row for each learner of each arena.

    An arena's learners are adjacent; their episodes end together. Each has its own reward. With ``central``
    an observation is followed by the additional input of a central critic
    (:meth:`~robobt.learning.envs.arena_task.ArenaTask.central_view`).
    """

    def __init__(self, task: ArenaTask, central: bool = False) -> None:
        self.task = task
        self._central = central
        self.settings = task.settings
        self.observation = task.observation
        self.blue = task.blue
        self.each = len(task.learners)
        self.n = task.n * self.each
        self.observation_size = task.observation.size
        if central:
            self.observation_size += len(task.central_scale)
        self.action_size = task.action.size

    @property
    def space(self) -> Box[np.float32]:
        """What each learner can observe."""
        return self.task.space

    @property
    def reach(self) -> float | None:
        """See :attr:`~robobt.learning.envs.arena_task.ArenaTask.reach`."""
        return self.task.reach

    @property
    def arenas(self) -> Arenas:
        """The simulator."""
        return self.task.arenas

    @property
    def ended(self) -> Episodes | None:
        """The episodes that ended in the last step, once for each learner; None without any."""
        ended = self.task.ended
        return None if ended is None else ended.pick(np.repeat(np.arange(len(ended)), self.each))

    def reset(self, seed: int | None = None) -> FloatArray:
        """See :meth:`robobt.learning.envs.task.VectorTask.reset`."""
        return self._rows(self.task.reset(seed))

    def reset_to(self, starts: ArrayLike, seed: int | None = None) -> FloatArray:
        """See :meth:`robobt.learning.envs.arena_task.ArenaTask.reset_to`; a start is an arena's."""
        return self._rows(self.task.reset_to(starts, seed))

    def restart(self) -> FloatArray:
        """See :meth:`robobt.learning.envs.arena_task.ArenaTask.restart`."""
        return self._rows(self.task.restart())

    def step(self, actions: FloatArray) -> StepResult:
        """See :meth:`robobt.learning.envs.task.VectorTask.step`.

        Raises:
            ValueError: wrong shape, or an action that is not finite.
        """
        result = self.task.advance(self._of_arenas(actions))
        final = self._rows(result.final_observation)
        self.task.renew(result)
        return self._spread(result, self._rows(result.observation), final)

    def advance(self, actions: FloatArray) -> StepResult:
        """See :meth:`robobt.learning.envs.arena_task.ArenaTask.advance`."""
        result = self.task.advance(self._of_arenas(actions))
        final = self._rows(result.final_observation)
        return self._spread(result, final.copy(), final)

    def _of_arenas(self, actions: FloatArray) -> FloatArray:
        given = np.asarray(actions, dtype=np.float64)
        if given.shape != (self.n, self.action_size):
            raise ValueError(f"actions must have the shape {(self.n, self.action_size)}, not {given.shape}")
        return given.reshape(self.task.n, -1)

    def _spread(self, result: StepResult, seen: FloatArray, final: FloatArray) -> StepResult:
        terminated, truncated, success = (
            np.repeat(column, self.each) for column in (result.terminated, result.truncated, result.success)
        )
        return StepResult(seen, self.task.shares.ravel(), terminated, truncated, final, success)

    def _rows(self, observation: FloatArray) -> FloatArray:
        own = observation.reshape(self.n, -1)
        if not self._central:
            return own
        return np.concatenate((own, self.task.central_view().reshape(self.n, -1)), axis=1)
