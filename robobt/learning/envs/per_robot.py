"""Arenas as rows for one policy: each learner, blue's learners only, or the learners of several worlds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields

import numpy as np
from gymnasium.spaces import Box
from numpy.typing import ArrayLike

from robobt.learning.envs.arena_task import ArenaTask
from robobt.learning.envs.episodes import Episodes
from robobt.learning.envs.task import FloatArray, StepResult, VectorTask
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


class SeveralWorlds:
    """The arenas of all ``parts`` as one :class:`~robobt.learning.envs.task.VectorTask`.

    The parts are the same task in different worlds: simulators, delays, opponents. A policy does not observe
    which world it is in.

    Raises:
        ValueError: no parts, or parts that differ in what is observed or done.
    """

    def __init__(self, parts: Sequence[VectorTask]) -> None:
        sizes = {(part.observation_size, part.action_size) for part in parts}
        if len(sizes) != 1:
            raise ValueError("worlds must be of one task: the same observations and actions in each")
        ((self.observation_size, self.action_size),) = sizes
        self.parts = tuple(parts)
        self.n = sum(part.n for part in parts)
        self._ends = np.cumsum([part.n for part in parts])[:-1]

    def reset(self, seed: int | None = None) -> FloatArray:
        """See :meth:`robobt.learning.envs.task.VectorTask.reset`; each world has a seed of its own."""
        seeds: list[int | None] = [None] * len(self.parts)
        if seed is not None:
            drawn = np.random.SeedSequence(seed).generate_state(len(self.parts), np.uint64)
            seeds = [int(one) for one in drawn]
        return np.concatenate([part.reset(one) for part, one in zip(self.parts, seeds, strict=True)])

    def step(self, actions: FloatArray) -> StepResult:
        """See :meth:`robobt.learning.envs.task.VectorTask.step`."""
        given = np.split(actions, self._ends)
        results = [part.step(own) for part, own in zip(self.parts, given, strict=True)]
        return StepResult(
            *(np.concatenate([getattr(one, item.name) for one in results]) for item in fields(StepResult))
        )


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
