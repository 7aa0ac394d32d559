"""What the environments have in common: arenas that are stepped, observed and started anew."""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robobt.learning.envs.episodes import Episodes
from robobt.learning.envs.perception import Perception
from robobt.learning.envs.progress import PROGRESS, progress_at
from robobt.learning.envs.randomiser import Randomiser
from robobt.learning.envs.settings import TaskSettings
from robobt.learning.envs.starts import START_COLUMNS, StartPool
from robobt.learning.envs.task import SUCCESS, TRUNCATED, BoolArray, FloatArray, IntArray, StepResult
from robobt.models.actions import fill_commands
from robobt.sim.arenas import Arenas
from robobt.sim.columns import COMMAND
from robobt.world.compiled import numbers_of
from robobt.world.features import ObservationSpec


class ArenaTask(ABC):
    """``n`` arenas with one robot and a ball each; see :class:`~robobt.learning.envs.task.VectorTask`.

    ``seed`` is that of everything drawn from the first ``reset`` on; None for another each time.

    Attributes:
        arenas: the simulator, from the first ``reset`` on.
        observation: what is observed.
        ended: the episodes that the last step ended; None without any.
    """

    observation: ObservationSpec

    def __init__(self, settings: TaskSettings, n: int, seed: int | None) -> None:
        if n < 1:
            raise ValueError(f"n must be at least 1, not {n}")
        self.settings = settings
        self.n = n
        self.action = settings.action
        self.observation_size = self.observation.size
        self.action_size = self.action.size
        self.ended: Episodes | None = None
        self.arenas: Arenas
        self._numbers = numbers_of(settings)
        self._scaling = numbers_of(self.action)
        self._drives = self.action.kind == "drive"
        self._seed: int | None = seed
        self._seeded = False
        self._all = np.arange(n)

    @abstractmethod
    def sample(self, rng: np.random.Generator, count: int) -> FloatArray:
        """Draw ``count`` starts (count, 10), columns ``START_COLUMNS``."""

    @abstractmethod
    def observe(self, robots: FloatArray, balls: FloatArray) -> FloatArray:
        """Compute the observations (m, O) of robots (m, 1, 6) and balls (m, 4)."""

    @abstractmethod
    def _judge(self, actions: FloatArray, rewards: FloatArray, ends: BoolArray) -> bool:
        """Fill ``rewards`` (n,) and ``ends`` (3, n) after a tick; return whether any episode ended."""

    @abstractmethod
    def _optimum(self, starts: FloatArray, which: IntArray) -> FloatArray:
        """Return the shortest possible times from the starts [s]; nan where there is none."""

    def sample_starts(self, seed: int, count: int) -> FloatArray:
        """Draw ``count`` starts (count, 10) from a seed of their own; the task's state stays as it is."""
        return self.sample(np.random.default_rng(seed), count)

    def reset(self, seed: int | None = None) -> FloatArray:
        """See :meth:`robobt.learning.envs.task.VectorTask.reset`."""
        if seed is not None or not self._seeded:
            self._seed_all(self._seed if seed is None else seed)
        self._build()
        return self._begin(self._all)

    def reset_to(self, starts: ArrayLike, seed: int | None = None) -> FloatArray:
        """Start from given starts in a new simulator; arenas that get none, or end later, go on as ever.

        Args:
            starts: (m, 10), columns ``START_COLUMNS``, handed out in order, first
                to the arenas and then to those whose episode ends.
            seed: of noise, randomisation and of starts drawn afterwards.

        Raises:
            ValueError: wrong shape, a number that is not finite, or a place outside the walls.
        """
        rows = np.atleast_2d(np.array(starts, dtype=np.float64))
        self._check_starts(rows)
        if seed is not None or not self._seeded:
            self._seed_all(self._seed if seed is None else seed)
        self._build()
        self._pool.give(rows)
        return self._begin(self._all)

    def restart(self) -> FloatArray:
        """Start all arenas anew in the simulator there is, faster than :meth:`reset`; (n, O)."""
        self.ended = None
        return self._begin(self._all)

    def step(self, actions: FloatArray) -> StepResult:
        """See :meth:`robobt.learning.envs.task.VectorTask.step`.

        Raises:
            ValueError: wrong shape, or an action that is not finite.
        """
        result = self.advance(actions)
        if self.ended is not None:
            which = np.flatnonzero(result.terminated | result.truncated)
            result.observation[which] = self._begin(which)
        return result

    def advance(self, actions: FloatArray) -> StepResult:
        """Do as :meth:`step`, but leave an episode that has ended as it is, to be started anew by a reset."""
        given = np.ascontiguousarray(actions, dtype=np.float64)
        if given.shape != (self.n, self.action_size):
            raise ValueError(f"actions must have the shape {(self.n, self.action_size)}, not {given.shape}")
        if not fill_commands(given, self._scaling, self._drives, self._randomiser.kick, self._command_rows):
            raise ValueError("an action is not finite")
        self.arenas.step(self._randomiser.delayed(self._commands))
        rewards = np.empty(self.n)
        ends: BoolArray = np.empty((3, self.n), dtype=np.bool_)
        ended = self._judge(given, rewards, ends)
        final = self._perception.look(self.arenas.robots, self.arenas.balls)
        terminated, truncated, success = ends
        self.ended = self._collect(np.flatnonzero(terminated | truncated), ends) if ended else None
        return StepResult(final.copy(), rewards, terminated, truncated, final, success)

    def _seed_all(self, seed: int | None) -> None:
        starts, noise, parameters = np.random.SeedSequence(seed).spawn(3)
        self._start_rng = np.random.default_rng(starts)
        self._noise_rng = np.random.default_rng(noise)
        self._parameter_rng = np.random.default_rng(parameters)
        self._seeded = True

    def _build(self) -> None:
        """Build anew everything that a run changes."""
        settings, n = self.settings, self.n
        limits = settings.robot_limits
        self.arenas = Arenas(settings.field, [limits], settings.stepped_simulator, settings.period, n)
        self._pool = StartPool(self.sample, self._start_rng, max(n, 64))
        self._perception = Perception(settings, self.observe, self.observation_size, n, self._noise_rng)
        self._randomiser = Randomiser(settings, self.arenas, self._parameter_rng)
        self._commands = np.zeros((n, 1, COMMAND))
        self._command_rows = self._commands[:, 0]
        self._progress: NDArray[np.void] = np.zeros(n, dtype=PROGRESS)
        self._progress_rows: FloatArray = self._progress.view(np.float64).reshape(n, -1)
        self._starts: IntArray = np.full(n, -1, dtype=np.int64)
        self._optimal_time = np.full(n, np.nan)
        self.ended = None

    def _begin(self, which: IntArray) -> FloatArray:
        """Start the episodes of these arenas; their first observations (m, O)."""
        rows, index = self._pool.take(len(which))
        self._starts[which] = index
        self._randomiser.draw(which)
        self.arenas.place(rows[:, None, :6], rows[:, 6:], which)
        self._progress[which] = progress_at(rows)
        self._optimal_time[which] = self._optimum(rows, which)
        return self._perception.start(self.arenas.robots, self.arenas.balls, which)

    def _collect(self, which: IntArray, ends: BoolArray) -> Episodes:
        progress, period = self._progress[which], self.settings.period
        kick, ticks = progress["kick_tick"], progress["ticks"]
        return Episodes(
            start=self._starts[which],
            success=ends[SUCCESS, which],
            truncated=ends[TRUNCATED, which],
            ticks=ticks.astype(np.int64),
            time=ticks * period,
            optimum=self._optimal_time[which],
            kick_time=np.where(kick < 0, np.nan, kick * period),
            total_reward=progress["total_reward"],
        )

    def _check_starts(self, rows: FloatArray) -> None:
        if rows.ndim != 2 or rows.shape[1] != len(START_COLUMNS):
            raise ValueError(f"starts must have the shape (m, {len(START_COLUMNS)}), not {rows.shape}")
        if not np.isfinite(rows).all():
            raise ValueError("a start is not finite")
        most = self.settings.field.outer
        if (np.abs(rows[:, [0, 6]]) > most[0]).any() or (np.abs(rows[:, [1, 7]]) > most[1]).any():
            raise ValueError(f"a start lies outside the walls at ({most[0]:g}, {most[1]:g})")
