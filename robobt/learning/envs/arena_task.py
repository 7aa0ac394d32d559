"""The base of the tasks: arenas that are stepped, observed and reset."""

from __future__ import annotations

from functools import partial
from typing import cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robobt.learning.envs.episodes import Episodes
from robobt.learning.envs.judging import PROGRESS, Ledger, count, goals, progress_at
from robobt.learning.envs.perception import Perception
from robobt.learning.envs.randomiser import Randomiser
from robobt.learning.envs.settings import MemorySettings, TaskSettings
from robobt.learning.envs.starts import StartPool, check_starts, columns_of, commands_before, split
from robobt.learning.envs.task import BoolArray, EpisodeEnds, FloatArray, IntArray, StepResult
from robobt.learning.envs.task_parts import TaskParts
from robobt.learning.envs.tick import Tick, call, checked_starts, checked_terms, end_by, error_of
from robobt.models.actions import fill_commands
from robobt.sim.arenas import Arenas
from robobt.sim.records import COMMAND, size
from robobt.world.compiled import numbers_of
from robobt.world.memory import Memory, MemorySize, with_memory
from robobt.world.observation import Observation, seen

_TASKS: dict[type[TaskSettings], type[ArenaTask]] = {}
"""The task that settings of each class belong to."""


class ArenaTask(TaskParts):
    """``n`` arenas with a ball and a learner's robot; see :class:`~robobt.learning.envs.task.VectorTask`.

    A task is a subclass that defines the parts of :class:`~robobt.learning.envs.task_parts.TaskParts`. With
    several learners their observations, and their actions, are concatenated.

    ``settings`` are the task's settings. ``seed`` is the seed of all random draws from the first ``reset``
    on; None for a new one each time. Each arena has its own generators: its episodes depend only on the seed
    and its index, bit for bit, whatever the number of arenas.

    Attributes:
        ended: the episodes that ended in the last step, or None.
    """

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        if not issubclass(cls.Settings, TaskSettings):
            raise TypeError(f"{cls.__name__}: Settings must be a subclass of TaskSettings")
        if cls.Settings in _TASKS:
            about = {"__module__": cls.__module__, "__qualname__": f"{cls.__qualname__}.Settings"}
            cls.Settings = type("Settings", (cls.Settings,), {**about, "__doc__": cls.Settings.__doc__})
        _TASKS[cls.Settings] = cls

    def __init__(self, settings: TaskSettings | None = None, n: int = 1, seed: int | None = None) -> None:
        settings = self.Settings() if settings is None else settings
        self._check(settings, n)
        columns = columns_of(self.robots)
        if len(self.start_columns) < len(columns):
            self.start_columns = columns
        self.settings = settings
        self.n = n
        self.action = settings.action
        self.seen_size = self.observation.size
        self._without_memory = self.observation
        self._memory_size: MemorySize | None = None
        if settings.memory != MemorySettings():
            actions, seen = settings.memory.actions, settings.memory.observations
            self._memory_size = MemorySize(self.observation.name, actions, self.action.size, seen)
            self.observation = with_memory(self.observation, self._memory_size)
        self.observation_size = len(self.learners) * self.observation.size
        self.action_size = len(self.learners) * self.action.size
        self.ended: Episodes | None = None
        self._memory: Memory | None
        self._last_seen: FloatArray
        self._scaling = numbers_of(self.action)
        self._kind = self.action.drives, self.action.kicks, self.action.holds
        self._seed: int | None = seed
        self._seeded = False
        self._all = np.arange(n)
        self._rewards = np.zeros(n)
        self._own_terms: NDArray[np.void] | None = None
        judged_by = next(kind for kind in type(self).__mro__ if "_judge" in vars(kind))
        self._own_reward = type(self).reward is not judged_by.__dict__.get("reward", TaskParts.reward)
        self._own_observations = not type(self).observe.__module__.startswith("robobt.") or isinstance(
            self._without_memory, Observation
        )
        self._own_opponents = not type(self).oppose.__module__.startswith("robobt.")
        self._own_ends = type(self).ends is not judged_by.__dict__.get("ends", TaskParts.ends)

    def _judge(self, actions: FloatArray, rewards: FloatArray, ends: EpisodeEnds) -> bool:  # noqa: ARG002
        """Add a tick's reward to ``rewards`` (n,) and fill ``ends``; return whether any episode has ended.

        Episodes that have already ended stay unchanged. Tasks with compiled rewards and ends override this;
        here only the time limit ends an episode.
        """
        fired: BoolArray = np.any(self.arenas.kicked[:, self.learners], axis=1)
        return count(self.settings.time_limit, fired, self._ledger(rewards, ends))

    @property
    def _progress(self) -> NDArray[np.void]:
        # Not cached: a copied or unpickled task would have a separate array.
        progress: NDArray[np.void] = self._progress_rows.view(PROGRESS)[:, 0]
        return progress

    @property
    def _judged_terms(self) -> NDArray[np.void]:
        return self._term_rows.view(self.terms)[:, 0] if self.terms.names else np.zeros(self.n, self.terms)

    @property
    def _terms(self) -> NDArray[np.void]:
        """The terms of the episodes so far, (n,)."""
        return self._judged_terms if self._own_terms is None else self._own_terms

    def _ledger(self, rewards: FloatArray, ends: EpisodeEnds) -> Ledger:
        """Return the arguments of a compiled judge as a plain tuple."""
        return cast(Ledger, (self._progress_rows, self._term_rows, rewards, *ends))

    @property
    def ticks(self) -> FloatArray:
        """Ticks since the start of each arena's episode, (n,)."""
        ticks: FloatArray = self._progress["ticks"]
        return ticks

    def sample_starts(self, seed: int, count: int) -> FloatArray:
        """Return ``count`` starts (count, S) from a separate ``seed``, leaving the task's state unchanged."""
        return checked_starts(self, len(self.start_columns), np.random.default_rng(seed), count)

    def reset(self, seed: int | None = None) -> FloatArray:
        """See :meth:`robobt.learning.envs.task.VectorTask.reset`."""
        if seed is not None or not self._seeded:
            self._seed_all(self._seed if seed is None else seed)
        self._build()
        return self._begin(self._all)

    def reset_to(self, starts: ArrayLike, seed: int | None = None) -> FloatArray:
        """Start from given starts in a new simulator and return the (n, O) observations.

        Arenas without a given start, and later episodes, draw their starts as usual.

        Args:
            starts: (m, S), columns :attr:`start_columns`, used in order, first by the arenas and then by
                those whose episode ends.
            seed: seed of noise, randomisation and starts drawn later.

        Raises:
            ValueError: wrong shape, a number that is not finite, or a place outside the walls.
        """
        rows = np.atleast_2d(np.array(starts, dtype=np.float64))
        check_starts(rows, self.start_columns, self.robots, self.settings.field)
        if seed is not None or not self._seeded:
            self._seed_all(self._seed if seed is None else seed)
        self._build()
        self._pool.give(rows)
        return self._begin(self._all)

    def restart(self) -> FloatArray:
        """Restart all arenas in the existing simulator, faster than :meth:`reset`; return (n, O)."""
        self.ended = None
        return self._begin(self._all)

    def step(self, actions: FloatArray) -> StepResult:
        """See :meth:`robobt.learning.envs.task.VectorTask.step`.

        Raises:
            ValueError: wrong shape, or an action that is not finite.
        """
        result = self.advance(actions)
        self.renew(result)
        return result

    def renew(self, result: StepResult) -> None:
        """Restart the episodes that ended in :meth:`advance`; their first observations go into ``result``."""
        if self.ended is not None:
            which = np.flatnonzero(result.terminated | result.truncated)
            result.observation[which] = self._begin(which)

    def advance(self, actions: FloatArray) -> StepResult:
        """Step and return as :meth:`step`, but do not restart ended episodes; a reset does.

        ``actions`` (n, A) are in [-1, 1].
        """
        given = np.ascontiguousarray(actions, dtype=np.float64)
        if given.shape != (self.n, self.action_size):
            raise ValueError(f"actions must have the shape {(self.n, self.action_size)}, not {given.shape}")
        each, filled = len(self.learners), self._filled
        kick = self._randomiser.kick if each == 1 else np.repeat(self._randomiser.kick, each)
        rows = given.reshape(len(filled), self.action.size)
        if not fill_commands(rows, self._scaling, *self._kind, kick, filled):
            raise ValueError("an action is not finite")
        self._commands[:, self.learners] = filled.reshape(self.n, each, filled.shape[-1])
        rewards = np.zeros(self.n)
        ends = EpisodeEnds.none(self.n)
        last = self.settings.decide_every - 1
        for tick in range(self.settings.decide_every):
            if not self._own_opponents:
                self.oppose(self._commands)
            else:
                call(self, "oppose", self._commands)
                if not np.isfinite(self._commands).all():
                    raise error_of(type(self), "oppose", ValueError("a command is not finite"))
            if self._own_reward or self._own_ends:
                ended = self._step_with_own(given, rewards, ends)
            else:
                self.arenas.step(self._carried())
                ended = self._judge(given, rewards, ends)
            if tick == last or self._perception.follows:
                final = self._perception.look(self.arenas.robots, self.arenas.balls)
        self._announce(final, self._all)
        if self._memory is not None:
            self._memory.remember(self._last_seen, given)
            self._last_seen, final = final.copy(), self._memory.recall(final)
        self._rewards = rewards
        self.ended = self._collect(np.flatnonzero(ends.over), ends) if ended else None
        return StepResult(final.copy(), rewards, ends.terminated, ends.truncated, final, ends.success)

    def _carried(self) -> FloatArray:
        """Return the commands, with sideways speed limited for the dribbler as in skills."""
        limits = self.settings.robot_limits
        if limits.carry_aside is None:
            return self._commands
        commands, learners = self._commands.copy(), self.learners
        aside = commands.view(COMMAND)["vy"][..., 0]
        slow = np.clip(aside[:, learners], -limits.carry_aside, limits.carry_aside)
        aside[:, learners] = np.where(self.arenas.contact[:, learners], slow, aside[:, learners])
        return commands

    def _step_with_own(self, actions: FloatArray, rewards: FloatArray, ends: EpisodeEnds) -> bool:
        """Step a tick and judge it by :meth:`reward` and :meth:`ends` if a subclass defines them."""
        arenas, progress, blue = self.arenas, self._progress, self.blue
        field, going = self.settings.field, ~ends.over
        robots, balls = arenas.robots.copy(), arenas.balls.copy()
        arenas.step(self._carried())
        judged_ends, total = ends.copy(), progress["total_reward"].copy()
        self._term_rows[:] = 0.0
        self._judge(actions, np.zeros(self.n), judged_ends)
        tick = Tick(
            now=self.now,
            before=seen(robots, balls, blue, field),
            contact=arenas.contact,
            kicked=arenas.kicked,
            touch=arenas.touch,
            goal=goals(balls, arenas.balls, numbers_of(field)),
            actions=actions,
            ticks=progress["ticks"],
            success=judged_ends.success & going,
            failed=judged_ends.terminated & ~judged_ends.success & going,
            terms={name: self._judged_terms[name].copy() for name in self.terms.names or ()},
        )
        if self._own_ends:
            end_by(self, tick, ends, self.settings.time_limit)
        else:
            for part, judged in zip(ends, judged_ends, strict=True):
                part[:] = judged
        terms = checked_terms(self, tick, self.n)
        if self._own_terms is None or self._own_terms.dtype.names != tuple(terms):
            self._own_terms = np.zeros(self.n, dtype=np.dtype([(name, np.float64) for name in terms]))
        earned = np.zeros(self.n)
        for name, term in terms.items():
            self._own_terms[name] += np.where(going, term, 0.0)
            earned += term
        rewards[going] += earned[going]
        progress["total_reward"] = np.where(going, total + earned, total)
        return bool(ends.over.any())

    def _seed_all(self, seed: int | None) -> None:
        seeds = [arena.spawn(3) for arena in np.random.SeedSequence(seed).spawn(self.n)]
        starts, noise, parameters = zip(*seeds, strict=True)
        self._start_rngs = [np.random.default_rng(each) for each in starts]
        self._noise_rngs = [np.random.default_rng(each) for each in noise]
        self._parameter_rngs = [np.random.default_rng(each) for each in parameters]
        self._seeded = True

    def _build(self) -> None:
        """Build again everything that a run changes."""
        settings, n, robots = self.settings, self.n, self.robots
        self.arenas = Arenas(
            settings.field, self._robot_limits, settings.stepped_simulator, settings.period, n
        )
        self._pool = StartPool(
            partial(checked_starts, self, len(self.start_columns)), self._start_rngs, len(self.start_columns)
        )
        observe = partial(call, self, "observe") if self._own_observations else self.observe
        self._last_seen = np.zeros((n, len(self.learners) * self.seen_size))
        self._memory = None
        if self._memory_size is not None:
            self._memory = Memory(self._memory_size, self.seen_size, n)
        self._perception = Perception(settings, observe, self._last_seen.shape[1], robots, self._noise_rngs)
        self._randomiser = Randomiser(settings, self.arenas, self._parameter_rngs)
        self._commands = np.zeros((n, robots, size(COMMAND)))
        self._filled = np.zeros((n * len(self.learners), size(COMMAND)))
        self._progress_rows = np.zeros((n, size(PROGRESS)))
        self._term_rows = np.zeros((n, size(self.terms)))
        self._own_terms = None
        self._starts: IntArray = np.full(n, -1, dtype=np.int64)
        self._optimal_time = np.full(n, np.nan)
        self.ended = None

    def _begin(self, which: IntArray) -> FloatArray:
        """Start the episodes of these arenas; return their first observations (m, O)."""
        rows, index = self._pool.take(which)
        self._starts[which] = index
        self._randomiser.draw(which)
        robots, balls, _ = split(rows, self.robots)
        self.arenas.place(robots, balls, which)
        before = commands_before(
            robots, self.arenas.robot_parameters[which], self.learners, self.action.dribbler
        )
        self.arenas.follow_before(which, before)
        call(self, "begin", rows, which)
        self._progress[which] = progress_at(balls)
        self._terms[which] = np.zeros(len(which), dtype=self._terms.dtype)
        self._optimal_time[which] = self._optimum(rows, which)
        seen = self._perception.start(self.arenas.robots, self.arenas.balls, which)
        self._announce(seen, which)
        if self._memory is not None:
            self._last_seen[which] = seen
            self._memory.begin(seen, which)
            seen = self._memory.recall(seen, which)
        return seen

    def _collect(self, which: IntArray, ends: EpisodeEnds) -> Episodes:
        progress, period = self._progress[which], self.settings.period
        kick, ticks = progress["kick_tick"], progress["ticks"]
        return Episodes(
            start=self._starts[which],
            success=ends.success[which],
            truncated=ends.truncated[which],
            ticks=ticks.astype(np.int64),
            time=ticks * period,
            optimum=self._optimal_time[which],
            kick_time=np.where(kick < 0, np.nan, kick * period),
            total_reward=progress["total_reward"],
            terms=self._terms[which],
        )


_TASKS[TaskSettings] = ArenaTask


def task_of(settings: type[TaskSettings]) -> type[ArenaTask] | None:
    """Return the task of this class of settings; None if its module has not been imported."""
    found = next((_TASKS[one] for one in settings.__mro__ if one in _TASKS), ArenaTask)
    return None if found is ArenaTask else found
