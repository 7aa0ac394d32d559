"""Teams of learned and scripted robots over many arenas."""

from __future__ import annotations

import numpy as np

from robobt.learning.envs.arena_task import ArenaTask
from robobt.learning.envs.soccer.central import states_of
from robobt.learning.envs.soccer.judge import GOAL, LAST, MIND, judge
from robobt.learning.envs.soccer.settings import AIMS, GOALKEEPER, PLAY, SoccerSettings
from robobt.learning.envs.soccer.starts import columns_of, soccer_starts
from robobt.learning.envs.task import BoolArray, FloatArray, IntArray, StepResult
from robobt.learning.opponents.challengers import Challengers
from robobt.learning.opponents.field_players import FieldPlayers
from robobt.learning.opponents.keepers import TRAITS
from robobt.learning.opponents.plays import PlayedRobots
from robobt.learning.opponents.team_keeper import TeamKeeper
from robobt.world.compiled import numbers_of
from robobt.world.limits import RobotLimits
from robobt.world.team_view import team_view, team_view_rows


class SoccerTask(ArenaTask):
    """Any mix of learned and scripted robots; see :mod:`robobt.learning.envs.soccer.suite` for tasks of it.

    The observations of an arena are those of its learners one after the other, and so are the actions;
    :class:`~robobt.learning.envs.soccer.per_robot.PerRobot` has a row for each learner instead.

    Attributes:
        shares: (n, L) what each learner earned in the last decision; their mean is the arena's reward.
    """

    settings: SoccerSettings

    def __init__(self, settings: SoccerSettings | None = None, n: int = 1, seed: int | None = None) -> None:
        settings = SoccerSettings() if settings is None else settings
        self.robots = len(settings.roles)
        self.learners = settings.learners
        self.observation = team_view(*settings.places)
        self.start_columns = columns_of(settings)
        super().__init__(settings, n, seed)
        field = settings.field
        self._who = np.array(settings.learners, dtype=np.int64)
        self.blue = len(settings.blue)
        self._goal = field.half_length, field.goal_width / 2
        self._field = numbers_of(field)
        self._weights = numbers_of(settings.reward)
        self._rules = numbers_of(settings.rules)
        self._aim = AIMS.index(settings.aim)
        self.shares = np.zeros((n, len(self.learners)))

    def sample(self, rng: np.random.Generator, count: int) -> FloatArray:
        """See :func:`~robobt.learning.envs.soccer.starts.soccer_starts`."""
        return soccer_starts(self.settings, rng, count)

    def observe(self, robots: FloatArray, balls: FloatArray) -> FloatArray:
        """See :func:`robobt.world.team_view.team_view`."""
        return team_view_rows(robots, balls, self._who, self.blue, *self.settings.places, *self._goal)

    def state(self) -> FloatArray:
        """Return the arenas' true states, (n, 7 R + 4), for whatever learns from them.

        For each robot x, y, the heading's cosine and sine, vx, vy, omega, then the ball's x, y, vx, vy, in
        field coordinates.
        """
        each = states_of(self.arenas.robots)
        return np.concatenate((each.reshape(self.n, -1), self.arenas.balls), axis=1)

    @property
    def goals(self) -> FloatArray:
        """Who has scored in each arena, (n,): 1 blue, -1 yellow, 0 nobody; until the next episode starts."""
        return self._minds[:, GOAL]

    def advance(self, actions: FloatArray) -> StepResult:
        """See :meth:`ArenaTask.advance`."""
        self.shares = np.zeros_like(self.shares)
        return super().advance(actions)

    @property
    def _robot_limits(self) -> list[RobotLimits | None]:
        own = self.settings.robot_limits
        return [own if index in self.learners else None for index in range(self.robots)]

    def _build(self) -> None:
        settings, n = self.settings, self.n
        limits, period = settings.simulator.limits, settings.period
        self._players = FieldPlayers(
            settings.field, limits, period, settings.roles, self.blue, settings.player_speed
        )
        self._challengers = Challengers(
            settings.field, limits, period, n, settings.roles, self.blue, settings.player_speed
        )
        self._keepers = [
            TeamKeeper(settings.field, limits, period, n, index, self.blue)
            for index, role in enumerate(settings.roles)
            if role == GOALKEEPER
        ]
        played = [index for index, role in enumerate(settings.roles) if role == PLAY]
        self._played = PlayedRobots(
            dict(zip(played, settings.plays, strict=True)),
            self.blue,
            [own or limits for own in self._robot_limits],
            n,
        )
        self._minds = np.zeros((n, MIND))
        self._before = np.zeros((n, len(self.learners), 2))
        super()._build()

    def _starting(self, starts: FloatArray, which: IntArray) -> None:
        self._minds[which] = 0.0
        self._minds[which, LAST] = -1.0
        self._before[which] = np.nan
        traits = starts[:, 6 * self.robots + 4 :]
        for k, keeper in enumerate(self._keepers):
            keeper.restart(which, traits[:, len(TRAITS) * k : len(TRAITS) * (k + 1)])
        self._challengers.restart(which)
        self._played.restart(self.arenas, which)

    def _oppose(self) -> None:
        arenas = self.arenas
        self._players.decide(arenas.robots, arenas.balls, arenas.contact, self._commands)
        self._challengers.decide(arenas.robots, arenas.balls, arenas.contact, self._commands)
        for keeper in self._keepers:
            keeper.decide(arenas.robots, arenas.balls, arenas.contact, self._commands)
        self._played.decide(arenas, self._commands)

    def _judge(self, actions: FloatArray, rewards: FloatArray, ends: BoolArray) -> bool:  # noqa: ARG002
        arenas = self.arenas
        kept = np.zeros(self.n, dtype=np.bool_)
        for keeper in self._keepers:
            if keeper.index >= self.blue:
                kept |= keeper.kept
        return judge(
            self._numbers,
            self._field,
            self._weights,
            self._rules,
            self._aim,
            self._who,
            self.blue,
            arenas.robots,
            arenas.balls,
            arenas.contact,
            arenas.kicked,
            arenas.touch,
            kept,
            self._minds,
            self._before,
            self.shares,
            self._progress_rows,
            rewards,
            ends,
        )

    def _optimum(self, starts: FloatArray, which: IntArray) -> FloatArray:  # noqa: ARG002
        # Nobody knows the shortest way past a team.
        return np.full(len(which), np.nan)
