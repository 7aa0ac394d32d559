"""Play passes that the passing challenge counts, counted by the challenge's own class."""

from __future__ import annotations

import numpy as np
from pydantic import Field

from robobt.challenges.passes import LEAST_LENGTH, PassCounts
from robobt.learning.envs.soccer.rewards import SoccerReward
from robobt.learning.envs.soccer.settings import (
    LEARNER,
    Aim,
    Role,
    SoccerRules,
    SoccerSettings,
    SoccerStarts,
)
from robobt.learning.envs.soccer.task import SoccerTask
from robobt.learning.envs.starts import places_of
from robobt.learning.envs.task import BoolArray, EpisodeEnds, FloatArray, IntArray
from robobt.models.actions import SCORE_ACTION, ActionScaling
from robobt.world.rules import against_hulls


class PassingSettings(SoccerSettings):
    """Play passes of at least 1 m to a team-mate past an opponent.

    The ball starts in the mouth of blue's first robot. Success is ``passes`` passes as the passing challenge
    of 2025 counts them. A ball that is out, held by yellow for 8 periods or carried for more than 1 m ends
    the episode. The challenge itself is four against four: set ``blue`` and ``yellow``.
    """

    blue: tuple[Role, ...] = (LEARNER, LEARNER)
    yellow: tuple[Role, ...] = ("press",)
    aim: Aim = "keep"
    action: ActionScaling = SCORE_ACTION.model_copy(update={"kick_speed": 4.0})
    passes: int = Field(1, ge=1, le=1000, description="passes for success")
    time_limit: int = 200
    player_speed: float = 1.0
    rules: SoccerRules = SoccerRules(areas=False, dribbling=1.0, pass_length=LEAST_LENGTH)
    reward: SoccerReward = SoccerReward(
        goal=0.0, fault=0.3, advance=0.0, shot=0.0, passed=5.0, sent=3.0, approach=0.1
    )
    starts: SoccerStarts = SoccerStarts(
        blue_x=(-2.0, 2.0), yellow_x=(-2.0, 2.0), y=(-2.0, 2.0), held=1.0, apart=1.1
    )


class PassingTask(SoccerTask):
    """Pass to a team-mate past an opponent, as the passing challenge of 2025 counts passes.

    :class:`PassingSettings` is the specification.
    """

    Settings = PassingSettings
    settings: PassingSettings
    _counts: PassCounts
    _passes: IntArray

    @property
    def passes(self) -> IntArray:
        """Blue's passes in each arena's episode, (n,)."""
        return self._passes

    def _judged_weights(self, weights: SoccerReward) -> SoccerReward:
        # The challenge's class counts passes, not the suite's judge.
        return weights.model_copy(update={"passed": 0.0})

    def _build(self) -> None:
        self._counts = PassCounts(self.n, self.settings.field)
        self._passes = np.zeros(self.n, dtype=np.int64)
        super()._build()

    def begin(self, starts: FloatArray, which: IntArray) -> None:
        """See :meth:`ArenaTask.begin`."""
        super().begin(starts, which)
        touching, balls = self._touching()[which], places_of(self.now.balls)[which]
        holder = np.where(touching.any(axis=1), touching.argmax(axis=1), -1)
        self._counts.restart(which, balls, holder)
        self._passes[which] = 0

    def _judge(self, actions: FloatArray, rewards: FloatArray, ends: EpisodeEnds) -> bool:
        going = ~ends.over
        super()._judge(actions, rewards, ends)
        new = self._count() & going & ~(ends.terminated & ~ends.success)
        self._passes += new
        self._pay("passed", self.settings.reward.passed, new, rewards)
        done = new & (self._passes >= self.settings.passes)
        # Having kept the ball is no success here.
        ends.success[going] = done[going]
        ends.terminated[done], ends.truncated[done] = True, False
        return bool(ends.over.any())

    def _count(self) -> BoolArray:
        """Return in which arenas blue has completed a pass in this tick."""
        now = self.now
        return self._counts.see(
            places_of(now.robots),
            self._touching(),
            places_of(now.balls),
            np.hypot(now.balls["vx"], now.balls["vy"]),
            self.arenas.touch,
            np.arange(self.robots) < self.blue,
            np.ones(self.n, dtype=np.bool_),
        )[:, 0]

    def _touching(self) -> BoolArray:
        """Return which robots touch the ball, (n, R)."""
        now = self.now
        dx, dy = (now.balls[axis][:, None] - now.robots[axis] for axis in "xy")
        return self.arenas.contact | against_hulls(dx, dy, now.robots["heading"])
