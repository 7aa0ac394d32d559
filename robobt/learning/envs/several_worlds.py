"""Arenas of several worlds combined, so that one policy learns in all of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields

import numpy as np

from robobt.learning.envs.task import FloatArray, StepResult, VectorTask


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
