"""What the environments have in common: arenas that are stepped, seen, and started anew."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from robobt.learning.envs import kernels as k
from robobt.learning.envs.episodes import Episodes
from robobt.learning.envs.perception import Perception
from robobt.learning.envs.randomiser import Randomiser
from robobt.learning.envs.settings import TaskSettings
from robobt.learning.envs.starts import START_COLUMNS, StartPool
from robobt.learning.envs.task import BoolArray, FloatArray, IntArray, StepResult
from robobt.models.actions import ActionScaling
from robobt.sim.arenas import Arenas
from robobt.sim.kernels import COMMAND
from robobt.world.features import ObservationSpec


class ArenaTask(ABC):
    """``n`` arenas with one robot and a ball each; see :class:`~robobt.learning.envs.task.VectorTask`.

    Args:
        settings: of the environment.
        n: number of arenas.
        seed: of everything drawn from the first ``reset`` on; None for another each time.

    Attributes:
        arenas: the simulator, from the first ``reset`` on.
        ended: the episodes that the last step ended; None without any.

    Raises:
        ValueError: ``n`` is not positive.
    """

    observation: ClassVar[ObservationSpec]

    def __init__(self, settings: TaskSettings, action: ActionScaling, n: int, seed: int | None) -> None:
        if n < 1:
            raise ValueError(f"n must be at least 1, not {n}")
        self.n = n
        self.action = action
        self.observation_size = self.observation.size
        self.action_size = action.size
        self.ended: Episodes | None = None
        self.arenas: Arenas
        self._common = settings
        self._seed: int | None = seed
        self._seeded = False
        self._all = np.arange(n)

    @abstractmethod
    def sample(self, rng: np.random.Generator, count: int) -> FloatArray:
        """Draw ``count`` starts (count, 10), columns ``START_COLUMNS``."""

    @abstractmethod
    def observe(self, robots: FloatArray, balls: FloatArray) -> FloatArray:
        """The observations (m, O) of robots (m, 1, 6) and balls (m, 4)."""

    @abstractmethod
    def _command(self, actions: FloatArray) -> bool:
        """Fill ``_commands``; False where an action is not finite."""

    @abstractmethod
    def _judge(
        self,
        actions: FloatArray,
        reward: FloatArray,
        terminated: BoolArray,
        truncated: BoolArray,
        success: BoolArray,
    ) -> bool:
        """Fill the arrays (n,) after a tick; whether any episode ended."""

    @abstractmethod
    def _at_best(self, starts: FloatArray, which: IntArray) -> tuple[FloatArray, FloatArray]:
        """Straight way [m] and optimal time [s] from the starts; nan where there is none."""

    def sample_starts(self, seed: int, count: int) -> FloatArray:
        """``count`` starts (count, 10) from a seed of their own, to be held out; the task's state stays."""
        return self.sample(np.random.default_rng(seed), count)

    def reset(self, seed: int | None = None) -> FloatArray:
        """See :meth:`robobt.learning.envs.task.VectorTask.reset`."""
        if seed is not None or not self._seeded:
            self._sow(self._seed if seed is None else seed)
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
            self._sow(self._seed if seed is None else seed)
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
        """As :meth:`step`, but an episode that has ended stays as it is; to be started anew by a reset."""
        given = np.ascontiguousarray(actions, dtype=np.float64)
        if given.shape != (self.n, self.action_size):
            raise ValueError(f"actions must have the shape {(self.n, self.action_size)}, not {given.shape}")
        if not self._command(given):
            raise ValueError("an action is not finite")
        self.arenas.step(self._randomiser.delayed(self._commands))
        reward = np.empty(self.n)
        ends: BoolArray = np.empty((3, self.n), dtype=np.bool_)
        terminated, truncated, success = ends
        ended = self._judge(given, reward, terminated, truncated, success)
        final = self._perception.look(self.arenas.robots, self.arenas.balls)
        self.ended = self._collect(np.flatnonzero(terminated | truncated), ends) if ended else None
        return StepResult(final.copy(), reward, terminated, truncated, final, success)

    def _sow(self, seed: int | None) -> None:
        starts, noise, parameters = np.random.SeedSequence(seed).spawn(3)
        self._start_rng = np.random.default_rng(starts)
        self._noise_rng = np.random.default_rng(noise)
        self._parameter_rng = np.random.default_rng(parameters)
        self._seeded = True

    def _build(self) -> None:
        """Everything that a run changes, anew."""
        settings, n = self._common, self.n
        limits = settings.robot_limits
        self.arenas = Arenas(settings.field, [limits], settings.stepped_simulator, settings.period, n)
        self._pool = StartPool(self.sample, self._start_rng, max(n, 64))
        self._perception = Perception(settings, self.observe, self.observation_size, n, self._noise_rng)
        self._randomiser = Randomiser(settings, self.arenas, self._parameter_rng)
        self._commands = np.zeros((n, 1, COMMAND))
        self._counters: IntArray = np.zeros((n, k.COUNTERS), dtype=np.int64)
        self._sums = np.zeros((n, k.SUMS))
        self._starts: IntArray = np.full(n, -1, dtype=np.int64)
        self._optimum = np.full(n, np.nan)
        self._straight = np.full(n, np.nan)
        self.ended = None

    def _begin(self, which: IntArray) -> FloatArray:
        """Start the episodes of these arenas; their first observations (m, O)."""
        rows, index = self._pool.take(len(which))
        self._starts[which] = index
        self._randomiser.draw(which)
        self.arenas.place(rows[:, None, :6], rows[:, 6:], which)
        self._counters[which] = 0
        self._counters[which, k.KICK_TICK] = -1
        self._sums[which] = 0.0
        self._sums[which, k.LAST_X] = rows[:, 0]
        self._sums[which, k.LAST_Y] = rows[:, 1]
        self._straight[which], self._optimum[which] = self._at_best(rows, which)
        return self._perception.start(self.arenas.robots, self.arenas.balls, which)

    def _collect(self, which: IntArray, ends: BoolArray) -> Episodes:
        counters, sums, period = self._counters[which], self._sums[which], self._common.period
        kick = counters[:, k.KICK_TICK]
        return Episodes(
            start=self._starts[which],
            success=ends[2, which],
            truncated=ends[1, which],
            ticks=counters[:, k.TICKS],
            time=counters[:, k.TICKS].astype(np.float64) * period,
            optimum=self._optimum[which],
            kick_time=np.where(kick < 0, np.nan, kick * period),
            way=sums[:, k.WAY],
            straight_way=self._straight[which],
            total_reward=sums[:, k.REWARD],
        )

    def _check_starts(self, rows: FloatArray) -> None:
        if rows.ndim != 2 or rows.shape[1] != len(START_COLUMNS):
            raise ValueError(f"starts must have the shape (m, {len(START_COLUMNS)}), not {rows.shape}")
        if not np.isfinite(rows).all():
            raise ValueError("a start is not finite")
        field = self._common.field
        most = (field.half_length + field.margin, field.half_width + field.margin)
        if (np.abs(rows[:, [0, 6]]) > most[0]).any() or (np.abs(rows[:, [1, 7]]) > most[1]).any():
            raise ValueError(f"a start lies outside the walls at ({most[0]:g}, {most[1]:g})")
