"""Teams of learned and scripted robots over many arenas."""

from __future__ import annotations

from typing import ClassVar, cast

import numpy as np

from robobt.learning.envs.arena_task import ArenaTask
from robobt.learning.envs.central import central_view
from robobt.learning.envs.judging import fresh, parameters, report_of
from robobt.learning.envs.soccer.judge import JUDGED, MIND, TERMS, JudgedPlay, judge
from robobt.learning.envs.soccer.letting_go import let_go
from robobt.learning.envs.soccer.restarts import Restarts
from robobt.learning.envs.soccer.rewards import REWARD_MEMORY, SoccerReward
from robobt.learning.envs.soccer.settings import AIMS, GOALKEEPER, PLAY_ROLE, SoccerSettings
from robobt.learning.envs.soccer.starts import columns_of, soccer_starts
from robobt.learning.envs.starts import split
from robobt.learning.envs.task import BoolArray, EpisodeEnds, FloatArray, IntArray, StepResult
from robobt.learning.opponents.challengers import Challengers
from robobt.learning.opponents.field_players import FieldPlayers
from robobt.learning.opponents.keepers import GOALKEEPER_TRAITS, Keepers
from robobt.learning.opponents.plays import PlayedRobots
from robobt.learning.opponents.restart_players import RestartPlayers
from robobt.sim.records import RecordArray, size
from robobt.world.game import GameState
from robobt.world.team_view import AWAY, team_view, team_view_rows

_NEW_MIND = fresh(MIND, last=-1)
_NEW_MEMORY = fresh(REWARD_MEMORY, to_goal=np.nan, to_ball=np.nan)


class SoccerTask(ArenaTask):
    """Play with any mix of learned and scripted robots.

    :mod:`robobt.learning.envs.soccer.suite` has such tasks.

    An arena's observations and actions are those of its learners, concatenated;
    :class:`~robobt.learning.envs.per_robot.PerRobot` has a row for each learner instead.
    """

    terms = TERMS
    Settings: ClassVar[type[SoccerSettings]] = SoccerSettings
    central = True
    settings: SoccerSettings

    def __init__(self, settings: SoccerSettings | None = None, n: int = 1, seed: int | None = None) -> None:
        settings = self.Settings() if settings is None else settings
        self.robots = len(settings.roles)
        self.learners = settings.learners
        self.observation = team_view(*settings.places, settings.rules.told)
        self.start_columns = columns_of(settings)
        super().__init__(settings, n, seed)
        field = settings.field
        self._who = np.array(settings.learners, dtype=np.int64)
        self.blue = len(settings.blue)
        self._goal = field.half_length, field.goal_width / 2
        self._judged_by = parameters(
            JUDGED,
            settings=settings,
            field=field,
            weights=self._judged_weights(settings.reward),
            rules=settings.rules,
            aim=AIMS.index(settings.aim),
            blue=self.blue,
        )
        self._shares = np.zeros((n, len(self.learners)))

    def sample(self, rng: np.random.Generator, count: int) -> FloatArray:
        """See :func:`~robobt.learning.envs.soccer.starts.soccer_starts`."""
        return soccer_starts(self.settings, rng, count)

    def observe(self, robots: FloatArray, balls: FloatArray) -> FloatArray:
        """See :func:`robobt.world.team_view.team_view`."""
        settings = self.settings
        return team_view_rows(
            robots, balls, self._who, self.blue, *settings.places, *self._goal, settings.rules.told
        )

    @property
    def ranges(self) -> dict[str, float]:
        """See :attr:`ArenaTask.ranges`."""
        known = super().ranges
        return {**known, "away": known["far"] + AWAY}

    @property
    def shares(self) -> FloatArray:
        """See :attr:`ArenaTask.shares`."""
        return self._shares

    @property
    def central_scale(self) -> tuple[float, ...]:
        """See :attr:`ArenaTask.central_scale`."""
        speed, turn = self.action.max_speed, self.action.max_turn
        each = (3.0, 2.0, 1.0, 1.0, speed, speed, turn)
        return (*each * sum(self.settings.sides), 3.0, 2.0, 3.0, 3.0)

    def central_view(self) -> FloatArray:
        """See :func:`~robobt.learning.envs.central.central_view`."""
        arenas = self.arenas
        return central_view(arenas.robots, arenas.balls, self.learners, self.blue, *self.settings.sides)

    @property
    def state_size(self) -> int:
        """See :attr:`ArenaTask.state_size`."""
        return super().state_size + 2 * self.settings.rules.restarts

    def state(self) -> FloatArray:
        """Return the arenas' true states, see :meth:`ArenaTask.state`.

        With restarts two entries follow: the team of the restart (1 blue, -1 yellow, 0 in play), and the
        robot that may not touch the ball after its restart (-1 for none).
        """
        restarts = self._restarts.states
        told = (restarts["team"], restarts["taker"]) if self.settings.rules.restarts else ()
        return np.column_stack((super().state(), *told))

    def game(self, arena: int) -> GameState:
        """Return the state of the game in an arena as a referee would send it, in field coordinates."""
        return self._restarts.game(arena)

    @property
    def goals(self) -> FloatArray:
        """The team that scored in each arena, (n,): 1 blue, -1 yellow, 0 none; until the next episode."""
        goals: FloatArray = self._states["goal"]
        return goals

    @property
    def _states(self) -> RecordArray:
        """The state of the episodes, (n,) of :class:`~robobt.learning.envs.soccer.judge.Mind`."""
        return self._minds.view(MIND)[:, 0]

    def advance(self, actions: FloatArray) -> StepResult:
        """See :meth:`ArenaTask.advance`."""
        self._shares = np.zeros_like(self._shares)
        return super().advance(actions)

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
            Keepers(settings.field, limits, period, n, index, self.blue)
            for index, role in enumerate(settings.roles)
            if role == GOALKEEPER
        ]
        played = [index for index, role in enumerate(settings.roles) if role == PLAY_ROLE]
        self._played = PlayedRobots(
            dict(zip(played, settings.plays, strict=True)),
            self.blue,
            [own or limits for own in self._robot_limits],
            n,
            self.game,
        )
        self._restarts = Restarts(settings, n)
        self._at_restarts = RestartPlayers(
            settings.field, limits, settings.roles, self.blue, settings.player_speed
        )
        self._minds = np.zeros((n, size(MIND)))
        self._memories = np.zeros((n, len(self.learners), size(REWARD_MEMORY)))
        super()._build()

    def begin(self, starts: FloatArray, which: IntArray) -> None:
        """See :meth:`ArenaTask.begin`."""
        self._minds[which] = _NEW_MIND
        self._memories[which] = _NEW_MEMORY
        self._restarts.begin(which)
        _, _, traits = split(starts, self.robots)
        for k, keeper in enumerate(self._keepers):
            keeper.restart(which, traits[:, len(GOALKEEPER_TRAITS) * k : len(GOALKEEPER_TRAITS) * (k + 1)])
        self._challengers.restart(which)
        self._played.restart(self.arenas, which)

    def oppose(self, commands: FloatArray) -> None:
        """See :meth:`ArenaTask.oppose`."""
        arenas = self.arenas
        self._players.decide(arenas.robots, arenas.balls, arenas.contact, commands)
        self._challengers.decide(arenas.robots, arenas.balls, arenas.contact, commands)
        for keeper in self._keepers:
            keeper.decide(arenas.robots, arenas.balls, arenas.contact, commands)
        if self.settings.rules.restarts:
            self._at_restarts.decide(self._restarts.rows, arenas.robots, arenas.balls, commands)
        self._played.decide(arenas, commands)
        limit = self.settings.rules.let_go
        if limit is not None and self.learners:
            # Learners' actions hold for several ticks, a forced release for one.
            commands[:, self.learners] = self._filled.reshape(self.n, len(self.learners), -1)
            let_go(limit, self._who, self.blue, arenas.robots, arenas.balls, self._minds, commands)

    def _judge(self, actions: FloatArray, rewards: FloatArray, ends: EpisodeEnds) -> bool:  # noqa: ARG002
        arenas, restarts, progress = self.arenas, self._restarts, self._progress
        on = self.settings.rules.restarts
        kept = np.zeros(self.n, dtype=np.bool_)
        for keeper in self._keepers:
            if keeper.index >= self.blue:
                kept |= keeper.kept
        if on:
            put = restarts.watch(arenas, ends.over)
            before = np.column_stack((progress["ball_x"], progress["ball_y"]))
        play = (self._who, kept, restarts.fouls, restarts.stops, self._minds, self._memories, self._shares)
        ended = judge(self._judged_by, report_of(arenas), cast(JudgedPlay, play), self._ledger(rewards, ends))
        if on:
            self._go_on(np.flatnonzero(restarts.stops * ~ends.over), before)
            self._perception.put(arenas.robots, arenas.balls, put)
        return ended

    def _judged_weights(self, weights: SoccerReward) -> SoccerReward:
        """Return the weights of the terms that are judged here; a subclass may :meth:`_pay` others itself."""
        return weights

    def _pay(self, term: str, weight: float, which: BoolArray, rewards: FloatArray) -> None:
        """Add a term's ``weight`` to all learners' rewards and to ``rewards`` (n,), where ``which`` (n,)."""
        earned: FloatArray = np.where(which, weight, 0.0)
        rewards += earned
        self._shares += earned[:, None]
        self._progress["total_reward"] += earned
        self._term_rows.view(TERMS)[term][:, 0] += earned

    def _go_on(self, which: IntArray, before: FloatArray) -> None:
        """Continue stopped play with a restart; balls were at ``before`` (n, 2) [m]."""
        if len(which) == 0:
            return
        restarts, minds = self._restarts.states, self._states
        carried = np.column_stack((minds["taken_x"], minds["taken_y"]))
        self._restarts.place(self.arenas, which, before[which], carried[which])
        # No robot has had this ball yet or has brought it nearer to a goal.
        minds["last"][which] = -1
        minds["blue_ticks"][which] = minds["yellow_ticks"][which] = 0.0
        memories = self._memories.view(REWARD_MEMORY)
        memories["to_goal"][which] = memories["to_ball"][which] = np.nan
        for axis in "xy":
            self._progress[f"ball_{axis}"][which] = restarts[f"spot_{axis}"][which]

    def _announce(self, seen: FloatArray, which: IntArray) -> None:
        if self.settings.rules.restarts and self.learners:
            self._restarts.tell(seen, which, self._who)

    def _optimum(self, starts: FloatArray, which: IntArray) -> FloatArray:  # noqa: ARG002
        # The shortest way past a team is unknown.
        return np.full(len(which), np.nan)
