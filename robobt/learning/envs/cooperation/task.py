"""Score a goal by two robots, with points counted by the cooperation challenge's own class."""

from __future__ import annotations

from math import pi
from typing import Self

import numpy as np
from pydantic import Field, model_validator

from robobt.challenges.cooperation import BALL_START, FAST_BALL, PLACES
from robobt.challenges.handover import JUNIOR_ROW, MAJOR_ROW, Handover
from robobt.learning.envs.judging import goals
from robobt.learning.envs.scripted import TAKEN_DISTANCE
from robobt.learning.envs.soccer.rewards import REWARD_MEMORY, SoccerReward
from robobt.learning.envs.soccer.settings import LEARNER, Role, SoccerRules, SoccerSettings
from robobt.learning.envs.soccer.task import SoccerTask
from robobt.learning.envs.starts import MOUTH_GAP, places_of, start_parts
from robobt.learning.envs.task import BoolArray, EpisodeEnds, FloatArray, IntArray
from robobt.learning.envs.task_parts import Policy
from robobt.models.actions import SCORE_ACTION, ActionScaling
from robobt.world.compiled import numbers_of
from robobt.world.geometry import Point
from robobt.world.rules import against_hulls
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS
from robobt.world.team_view import BALL_INDEX


class CooperationSettings(SoccerSettings):
    """Two robots score together: the first shoots the ball, then the other shoots it into the empty goal.

    Success is a goal of the second robot with no rule of the challenge broken, after the first has shot.
    Until then the second robot stands still whatever its policy says, and the first from then on. Any other
    goal, a ball out, a ball faster than 3.5 m/s or carried for more than 1 m, and a robot that touches a
    defence area end the episode.

    Of the reward's terms ``sent`` is for the first robot's shot, ``passed`` for the second's first touch
    after it, and ``goal`` for a success; ``shot`` is for the second robot only. Both robots earn all terms.
    """

    blue: tuple[Role, ...] = (LEARNER, LEARNER)
    action: ActionScaling = SCORE_ACTION.model_copy(update={"max_speed": 1.2, "kick_speed": 3.0})
    time_limit: int = 500
    spread: float = Field(
        0.5,
        ge=0,
        le=1.0,
        description="radius around the challenge's places of robots and ball at the start [m]",
    )
    shot: float = Field(
        0.0,
        ge=0,
        le=1,
        description="share of starts with the ball in the second robot's mouth, after the first has shot",
    )
    held: float = Field(
        0.3, ge=0, le=1, description="share of starts with the ball in the first robot's mouth"
    )
    rules: SoccerRules = SoccerRules(held_by=None, dribbling=1.0, let_go=0.9)
    reward: SoccerReward = SoccerReward(fault=0.5, approach=0.1, sent=1.0, passed=2.0, shot=2.0, shared=1.0)

    @model_validator(mode="after")
    def _two_learners(self) -> Self:
        if self.blue != (LEARNER, LEARNER) or self.yellow:
            raise ValueError("blue, yellow: the challenge is for two learners of blue alone")
        return self


class CooperationTask(SoccerTask):
    """Score a goal by two robots that each touch the ball, as in the cooperation challenge of 2026.

    The first robot shoots, then the second shoots into the empty goal. Both are robobt's and have one policy;
    each stands still while it is the other's turn. :class:`CooperationSettings` is the specification.
    """

    Settings = CooperationSettings
    settings: CooperationSettings
    _handover: Handover
    _balls: FloatArray

    def __init__(
        self, settings: CooperationSettings | None = None, n: int = 1, seed: int | None = None
    ) -> None:
        super().__init__(settings, n, seed)
        self.start_columns = (*self.start_columns, "shot")

    @property
    def points(self) -> FloatArray:
        """The points of each arena's try so far, without what broken rules cost, (n,)."""
        return self._handover.points

    def _judged_weights(self, weights: SoccerReward) -> SoccerReward:
        # The challenge's class says when the first robot has shot, the second has the ball, and it scores.
        return weights.model_copy(update={"sent": 0.0, "passed": 0.0, "goal": 0.0})

    def _build(self) -> None:
        self._handover = Handover(self.n, self.settings.field)
        super()._build()

    def sample(self, rng: np.random.Generator, count: int) -> FloatArray:
        """Draw starts, one row each."""
        rows = np.zeros((count, len(self.start_columns)))
        robots, balls, rest = start_parts(rows, self.robots)
        spread = self.settings.spread

        def near(place: Point) -> tuple[FloatArray, FloatArray]:
            far, towards = spread * np.sqrt(rng.random(count)), rng.uniform(-pi, pi, count)
            return place[0] + far * np.cos(towards), place[1] + far * np.sin(towards)

        for index, place in enumerate(PLACES):
            robots["x"][:, index], robots["y"][:, index] = near(place)
            robots["heading"][:, index] = rng.uniform(-pi, pi, count)
        balls["x"], balls["y"] = near(BALL_START)
        shot, held = rng.random((2, count)) < np.array([[self.settings.shot], [self.settings.held]])
        rest[:, 0] = shot
        ahead = self.settings.simulator.body.face + BALL_RADIUS + MOUTH_GAP
        for index, which in ((MAJOR_ROW, held & ~shot), (JUNIOR_ROW, shot)):
            me = robots[which, index]
            balls["x"][which] = me["x"] + ahead * np.cos(me["heading"])
            balls["y"][which] = me["y"] + ahead * np.sin(me["heading"])
        return rows

    def begin(self, starts: FloatArray, which: IntArray) -> None:
        """See :meth:`ArenaTask.begin`."""
        super().begin(starts, which)
        self._handover.restart(which)
        _, _, rest = start_parts(np.ascontiguousarray(starts), self.robots)
        self._handover.shot[which] = rest[:, 0] > 0.0
        # The first robot's kicks at the goal are not to be rewarded: it is to pass.
        self._memories.view(REWARD_MEMORY)["shots"][which, MAJOR_ROW] = np.inf

    def oppose(self, commands: FloatArray) -> None:
        """Let the second robot stand still until the first has shot, and the first from then on."""
        super().oppose(commands)
        self._balls = self.arenas.balls.copy()
        commands[self._all, np.where(self._handover.shot, MAJOR_ROW, JUNIOR_ROW)] = 0.0

    def _judge(self, actions: FloatArray, rewards: FloatArray, ends: EpisodeEnds) -> bool:
        told, reward, going = self._handover, self.settings.reward, ~ends.over
        shot, touched = told.shot.copy(), told.touched.copy()
        super()._judge(actions, rewards, ends)
        self._see(going)
        scored = going & ~np.isnan(told.scored) & ~told.early
        broken = going & self._breaks()
        self._pay("sent", reward.sent, going & told.shot & ~shot, rewards)
        self._pay("passed", reward.passed, going & told.touched & ~touched, rewards)
        self._pay("goal", reward.goal, scored & ~broken, rewards)
        self._pay("fault", -reward.fault, broken & ~ends.terminated, rewards)
        ends.success[going] = (scored & ~broken)[going]
        ends.terminated[broken], ends.truncated[broken] = True, False
        return bool(ends.over.any())

    def _see(self, going: BoolArray) -> None:
        """Let the challenge's class see the tick in the arenas whose episodes go on."""
        now = self.now
        dx, dy = (now.balls[axis][:, None] - now.robots[axis] for axis in "xy")
        self._handover.see(
            np.hypot(now.robots["vx"], now.robots["vy"]),
            self.arenas.contact | against_hulls(dx, dy, now.robots["heading"]),
            np.where(going, self.arenas.touch, -1),
            places_of(now.balls),
            np.hypot(now.balls["vx"], now.balls["vy"]),
            goals(self._balls, self.arenas.balls, numbers_of(self.settings.field)) > 0,
            self.ticks * self.settings.period,
        )

    def _breaks(self) -> BoolArray:
        """Return where the ball is too fast or a robot touches a defence area."""
        field, now = self.settings.field, self.now
        ahead = np.maximum(0.0, field.half_length - field.defense_depth - np.abs(now.robots["x"]))
        aside = np.maximum(0.0, np.abs(now.robots["y"]) - field.defense_width / 2.0)
        near = (np.hypot(ahead, aside) < ROBOT_RADIUS).any(axis=1)
        broken: BoolArray = near | (np.hypot(now.balls["vx"], now.balls["vy"]) > FAST_BALL)
        return broken

    def script(self) -> Policy:
        """Return a script by which the first robot shoots at the other, and that at the goal."""
        return self._pass_and_shoot

    def _pass_and_shoot(self, observation: FloatArray) -> FloatArray:
        """Get the ball, turn to the aim and kick, (n, 2 * size of a team's view) -> (n, 8)."""
        now, actions = self.now, np.full((len(observation), 2, self.action.size), -1.0)
        actions[..., :3] = 0.0
        goal = np.tile([self.settings.field.half_length, 0.0], (self.n, 1))
        aims = {MAJOR_ROW: places_of(now.robots)[:, JUNIOR_ROW], JUNIOR_ROW: goal}
        for index, aim in aims.items():
            view = observation.reshape(self.n, 2, -1)[:, index]
            ball, robot = view[:, BALL_INDEX : BALL_INDEX + 2], now.robots[:, index]
            far = np.hypot(*ball.T)
            held = far < TAKEN_DISTANCE
            bearing = np.arctan2(aim[:, 1] - robot["y"], aim[:, 0] - robot["x"]) - robot["heading"]
            bearing = (bearing + pi) % (2.0 * pi) - pi
            off = np.where(held, bearing, np.arctan2(ball[:, 1], ball[:, 0]))
            speed = np.where(held, 0.0, np.clip(1.5 * (far - 0.1), 0.3, 1.2)) / self.action.max_speed
            actions[:, index, :2] = speed[:, None] * ball / far[:, None]
            actions[:, index, 2] = np.clip(3.0 * off, -2.0, 2.0) / self.action.max_turn
            actions[:, index, 3] = np.where(held & (np.abs(off) < 0.05), 1.0, -1.0)
        return actions.reshape(len(observation), -1)
