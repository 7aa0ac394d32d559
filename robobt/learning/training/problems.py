"""The information on a task that a learner needs, besides stepping it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from robobt.learning.envs import TaskSettings, VectorTask, make_task, run_starts
from robobt.learning.envs.episodes import Episodes
from robobt.learning.envs.per_robot import Others
from robobt.learning.training.arenas import arenas_of, opposed_arenas, shares_of
from robobt.learning.training.results import Evaluation, Policy
from robobt.learning.training.settings import (
    TrainSettings,
    evaluated_on,
    stage_after,
    stages_of,
    validated_on,
    worlds_of,
)
from robobt.world.observation import Group

Split = Literal["validation", "held_out"]
"""Fixed starts of evaluations: those that choose the actor, or those that its figures come from."""

_SPLIT_SEEDS: dict[Split, int] = {"validation": 1_000_001, "held_out": 2_000_003}
_TRAINING = 2**62
"""Seeds of training episodes have this bit, so that none is the seed of fixed starts."""

_EVALUATION_ARENAS = 128
"""Arenas side by side in an evaluation."""


@dataclass(frozen=True)
class Problem:
    """A task to learn.

    Attributes:
        make: ``n`` arenas of it.
        evaluate: plays a policy once from each of a number of a split's starts.
        scale: (observation,) typical size of each entry, in its unit.
        smoothed: (action,) whether target smoothing may change an entry; not a threshold.
        state_scale: (state,) typical size of the additional input of a central critic, in ``make``'s arenas
            only; empty without one.
        later: returns the arenas after a number of steps, for a pool or stages; None if they are always
            ``make``'s.
        vectors: entries at which the observation's vectors begin, that to the ball first; none where the
            policy cannot be asked in the ball's frame.
        groups: the observation's places for robots of one kind.
    """

    make: Callable[[int], VectorTask]
    evaluate: Callable[[Policy, Split, int], Evaluation]
    scale: tuple[float, ...]
    smoothed: tuple[bool, ...]
    state_scale: tuple[float, ...] = ()
    later: Callable[[int, Others], VectorTask] | None = None
    vectors: tuple[int, ...] = ()
    groups: tuple[Group, ...] = ()


def problem_for(settings: TrainSettings) -> Problem:
    """Return the task of a run."""
    problem = problem_of(
        settings.environment,
        evaluated_on(settings),
        worlds_of(settings),
        settings.central,
        validated_on(settings),
    )
    if not settings.changes_on_the_way:
        return problem
    stages, n = stages_of(settings), settings.collection.num_envs

    def later(steps: int, others: Others) -> VectorTask:
        stage = stages[stage_after(settings, steps)]
        if stage.worlds:
            return arenas_of(worlds_of(stage), n, settings.central)
        return opposed_arenas(stage.environment, stage.pool, others, n, settings.central)

    return replace(problem, later=later)


def problem_of(
    environment: TaskSettings,
    held_out: TaskSettings | None = None,
    worlds: Sequence[TaskSettings] = (),
    central: bool = False,
    validated: Sequence[TaskSettings] = (),
) -> Problem:
    """Return the task in that environment.

    Args:
        environment: the environment that a policy observes.
        held_out: environment of the held-out starts, if different.
        worlds: environments that share the training arenas, if not that environment.
        central: whether a central critic learns.
        validated: environments that share the validation starts, if not ``worlds``.
    """
    task = make_task(environment, 1)
    trained = tuple(worlds) or (environment,)
    where: dict[Split, Sequence[TaskSettings]] = {
        "validation": tuple(validated) or trained,
        "held_out": (held_out or environment,),
    }
    return Problem(
        lambda n: arenas_of(trained, n, central),
        lambda policy, split, starts: _evaluate(where[split], policy, split, starts),
        task.scale,
        tuple([entry != "kick" for entry in task.action.entries]),
        task.central_scale if central else (),
        vectors=task.observation.vectors,
        groups=task.observation.groups,
    )


def training_seed(seed: int, steps: int) -> int:
    """Return the seed of a run's simulator built after this many steps."""
    drawn = int(np.random.SeedSequence([seed, steps]).generate_state(1, np.uint64)[0])
    return (drawn & (_TRAINING - 1)) | _TRAINING


def split_seed(split: Split) -> int:
    """Return the seed of a split's starts, noise and randomisation, different from every run's simulator."""
    return _SPLIT_SEEDS[split]


def _evaluate(worlds: Sequence[TaskSettings], policy: Policy, split: Split, starts: int) -> Evaluation:
    seed = split_seed(split)
    parts = []
    for world, share in zip(worlds, shares_of(starts, len(worlds)), strict=True):
        task = make_task(world, min(_EVALUATION_ARENAS, share))
        parts.append(run_starts(task, task.jointly(policy), task.sample_starts(seed, share), seed))
    episodes = Episodes.joined(parts)
    times, rewards = getattr(episodes, task.timed), episodes.total_reward
    terms = {name: float(episodes.terms[name].mean()) for name in episodes.terms.dtype.names or ()}
    return Evaluation(episodes.success, times, episodes.optimum, rewards, terms)
