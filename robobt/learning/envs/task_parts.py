"""What makes a task: its observation, starts, reward, ends and opponents."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import ClassVar, Literal

import numpy as np
from gymnasium.spaces import Box

from robobt.learning.envs.bounds import bounded, ranges_of, scale_of
from robobt.learning.envs.central import TURNED, states_of
from robobt.learning.envs.settings import TaskSettings
from robobt.learning.envs.starts import START_COLUMNS
from robobt.learning.envs.task import BoolArray, FloatArray, IntArray
from robobt.learning.envs.tick import Tick
from robobt.models.actions import ActionScaling
from robobt.sim.arenas import Arenas
from robobt.sim.records import size
from robobt.skills.base import Skill
from robobt.world.features import ObservationSpec
from robobt.world.limits import RobotLimits
from robobt.world.observation import Observation, Seen, seen
from robobt.world.records import BALL

Policy = Callable[[FloatArray], FloatArray]
"""Observations (n, O) to actions (n, A)."""


class TaskParts:
    """What a task defines; :class:`~robobt.learning.envs.arena_task.ArenaTask` plays it.

    Five parts make a task, and a subclass can replace each alone: the observation (:attr:`observation`), the
    starts of episodes (:meth:`sample`), the reward (:meth:`reward`), the ends of episodes (:meth:`ends`), and
    the robots that do not learn (:meth:`oppose`).

    Attributes:
        name: name under which it is registered. Settings: class of the task's settings, one for each task; a
            subclass without one gets its own.
        played_by: the skill that uses a model of this task.
        timed: the time of an episode that measures how fast a success was.
        central: whether a central critic can be used.
        terms: record type of the reward's terms, one number each.
        settings: the task's settings.
        n: number of arenas.
        action: what a learner does, in [-1, 1], and what that means.
        arenas: the simulator, from the first ``reset`` on.
        observation: specification of the observation, with its memory.
        seen_size: number of its entries without the memory.
        robots: number of robots in an arena; a start's first columns are their states.
        blue: number of robots in the learner's team, which come first.
        learners: indices of the robots that learn.
        start_columns: columns of a start: each robot, the ball, and the task's further columns.
    """

    name: ClassVar[str] = ""
    Settings: ClassVar[type[TaskSettings]] = TaskSettings
    played_by: ClassVar[str] = "LearnedSkill"
    timed: ClassVar[Literal["time", "kick_time"]] = "time"
    central: ClassVar[bool] = False
    terms: ClassVar[np.dtype[np.void]] = np.dtype([])
    observation: ObservationSpec
    robots: int = 1
    blue: int = 1
    learners: tuple[int, ...] = (0,)
    start_columns: tuple[str, ...] = START_COLUMNS
    settings: TaskSettings
    n: int
    action: ActionScaling
    seen_size: int
    arenas: Arenas
    _without_memory: ObservationSpec
    _rewards: FloatArray

    def sample(self, rng: np.random.Generator, count: int) -> FloatArray:
        """Sample ``count`` starts (count, S), columns :attr:`start_columns`, from ``rng``; return them.

        :func:`~robobt.learning.envs.starts.start_parts` gives access to their columns by name.
        """
        raise NotImplementedError(f"{type(self).__name__}: has no starts")

    def observe(self, robots: FloatArray, balls: FloatArray) -> FloatArray:
        """Compute the observations (m, O) of robots (m, R, 6) and balls (m, 4)."""
        maker = self._without_memory
        if not isinstance(maker, Observation):
            raise NotImplementedError(f"{type(self).__name__}: nothing makes its observation")
        made: FloatArray = np.asarray(
            maker.rows(seen(robots, balls, self.blue, self.settings.field)), dtype=np.float64
        )
        if made.shape != (len(balls), self.seen_size):
            raise ValueError(f"makes {made.shape} of {(len(balls), self.seen_size)}")
        if not np.isfinite(made).all():
            entry = self.observation.entries[int(np.flatnonzero(~np.isfinite(made).all(axis=0))[0])]
            raise ValueError(f"the entry {entry.name!r} is not finite")
        return made

    def reward(self, tick: Tick) -> Mapping[str, FloatArray]:
        """Return the terms of a tick's reward by name, (n,) each; their sum is the reward."""
        return tick.terms

    def ends(self, tick: Tick) -> tuple[BoolArray, BoolArray]:
        """Return which episodes end in this tick with success, and which without, (n,) each.

        The time limit applies automatically, see ``time_limit``.
        """
        return tick.success, tick.failed

    def oppose(self, commands: FloatArray) -> None:
        """Fill in the ``commands`` (n, R, 7) of the robots that do not learn, for one tick.

        ``commands.view(COMMAND)[..., 0]`` gives their fields by name (:class:`robobt.sim.records.Command`),
        :attr:`now` the robots and balls.
        """

    def begin(self, starts: FloatArray, which: IntArray) -> None:
        """Read the columns after robots and ball from the ``starts`` (m, S) of the arenas ``which``."""

    def _optimum(self, starts: FloatArray, which: IntArray) -> FloatArray:  # noqa: ARG002
        """Return the shortest possible times from the starts [s]; nan where unknown."""
        return np.full(len(which), np.nan)

    def _announce(self, seen: FloatArray, which: IntArray) -> None:
        """Fill entries of observations (m, O) of the arenas ``which`` beyond robots and ball."""

    @property
    def ranges(self) -> dict[str, float]:
        """Largest values of the quantities that entries of the observation name as their range.

        They follow from walls, limits, kicker and noise.
        """
        return ranges_of(self.settings)

    @property
    def space(self) -> Box[np.float32]:
        """What each learner can observe."""
        return bounded(self.observation, self.ranges)

    @property
    def scale(self) -> tuple[float, ...]:
        """Typical size of each entry of a learner's observation, in its unit."""
        return scale_of(self.observation, self.action)

    @property
    def central_scale(self) -> tuple[float, ...]:
        """Typical size of each additional entry for a central critic; empty without one."""
        return ()

    def central_view(self) -> FloatArray:
        """Return the additional input of a central critic for each learner, (n, L, entries)."""
        return np.zeros((self.n, len(self.learners), 0))

    @property
    def state_size(self) -> int:
        """Number of entries of an arena's :meth:`state`."""
        return size(TURNED) * self.robots + size(BALL)

    def state(self) -> FloatArray:
        """Return the arenas' true states, (n, 7 R + 4), for learning from them.

        For each robot they have x, y, the heading's cosine and sine, vx, vy, omega, then the ball's x, y, vx,
        vy, in field coordinates.
        """
        robots = states_of(self.arenas.robots).reshape(self.n, -1)
        return np.concatenate((robots, self.arenas.balls), axis=1)

    @property
    def shares(self) -> FloatArray:
        """Each learner's reward in the last decision, (n, L); their mean is the arena's reward."""
        return np.repeat(self._rewards[:, None], len(self.learners), axis=1)

    @property
    def reach(self) -> float | None:
        """Distance at which the ball counts as reached, for pictures [m]; None for none."""
        return None

    def script(self) -> Policy | None:
        """Return a hand-written policy on the observations for the task, or None."""
        return None

    def skill(self) -> Skill | None:
        """Return a skill for the task, for demonstrations, or None."""
        return None

    @property
    def _robot_limits(self) -> list[RobotLimits | None]:
        """The limits of each robot; None for the simulator's own."""
        own = self.settings.robot_limits
        return [own if index in self.learners else None for index in range(self.robots)]

    @property
    def now(self) -> Seen:
        """Robots and balls in field coordinates; ``now.me`` is the first robot."""
        return seen(self.arenas.robots, self.arenas.balls, self.blue, self.settings.field)

    def jointly(self, policy: Policy) -> Policy:
        """Return a policy for whole arenas that applies ``policy`` to each learner."""
        each = len(self.learners)
        if each == 1:
            return policy

        def decide(observation: FloatArray) -> FloatArray:
            arenas = len(observation)
            return policy(observation.reshape(arenas * each, -1)).reshape(arenas, -1)

        return decide

    def _check(self, settings: TaskSettings, n: int) -> None:
        """Raise ValueError or TypeError unless the parts, the settings and ``n`` arenas fit each other."""
        if n < 1:
            raise ValueError(f"n must be at least 1, not {n}")
        if not isinstance(getattr(self, "observation", None), ObservationSpec):
            raise TypeError(f"{type(self).__name__}: has no observation")
        if self.robots < 1:
            raise ValueError(f"{type(self).__name__}: robots must be at least 1, not {self.robots}")
        if not set(self.learners) <= set(range(self.robots)):
            known = ", ".join(str(index) for index in range(self.robots))
            raise ValueError(
                f"{type(self).__name__}: learners must be of the robots {known}, not {self.learners}"
            )
        if tuple(self.learners) != tuple(settings.learners):
            raise ValueError(
                f"{type(self).__name__}: learners must be {settings.learners}, not {self.learners}; several "
                "robots learn in subclasses of SoccerTask"
            )
        if settings.decide_every < 1 or settings.time_limit < 1:
            raise ValueError(f"{type(self).__name__}: decide_every and time_limit must be at least 1")
