"""Shoot-Towards-Goal over many arenas."""

from __future__ import annotations

from math import inf
from typing import ClassVar

import numpy as np

from robobt.learning.envs import kernels as k
from robobt.learning.envs.arena_task import ArenaTask
from robobt.learning.envs.settings import ShootSettings
from robobt.learning.envs.starts import shoot_starts
from robobt.learning.envs.task import BoolArray, FloatArray, IntArray
from robobt.world.features import SHOOT, ObservationSpec


class ShootTask(ArenaTask):
    """Turn and kick the ball into the goal; the specification is
    :class:`~robobt.learning.envs.ShootTowardsGoalEnv`.

    Args:
        settings: of the environment.
        n: number of arenas.
        seed: of everything drawn; None for another each time.
    """

    observation: ClassVar[ObservationSpec] = SHOOT

    def __init__(self, settings: ShootSettings | None = None, n: int = 1, seed: int | None = None) -> None:
        self.settings = ShootSettings() if settings is None else settings
        super().__init__(self.settings, self.settings.action, n, seed)
        self._parameters = _parameters(self.settings)

    def sample(self, rng: np.random.Generator, count: int) -> FloatArray:
        """See :func:`~robobt.learning.envs.starts.shoot_starts`."""
        return shoot_starts(self.settings, rng, count)

    def observe(self, robots: FloatArray, balls: FloatArray) -> FloatArray:
        """:data:`robobt.world.features.SHOOT`."""
        seen = np.empty((len(balls), self.observation_size))
        p = self._parameters
        k.observe_shoot(robots, balls, p[k.S_LINE], p[k.S_POST], seen)
        return seen

    def _command(self, actions: FloatArray) -> bool:
        scaling = self.action
        return k.kick_commands(
            actions,
            scaling.max_turn,
            scaling.kick_speed,
            float(scaling.dribbler),
            self._randomiser.kick,
            self._commands,
        )

    def _judge(
        self,
        actions: FloatArray,
        reward: FloatArray,
        terminated: BoolArray,
        truncated: BoolArray,
        success: BoolArray,
    ) -> bool:
        arenas = self.arenas
        return k.judge_shoot(
            arenas.robots,
            arenas.balls,
            arenas.kicked,
            actions,
            self._parameters,
            self._counters,
            self._sums,
            reward,
            terminated,
            truncated,
            success,
        )

    def _at_best(
        self,
        starts: FloatArray,  # noqa: ARG002 - there is no straight line to a goal
        which: IntArray,
    ) -> tuple[FloatArray, FloatArray]:
        none = np.full((2, len(which)), np.nan)
        return none[0], none[1]


def _parameters(settings: ShootSettings) -> FloatArray:
    field, reward = settings.field, settings.reward
    p = np.zeros(k.S_PARAMETERS)
    p[k.S_LINE] = field.half_length
    p[k.S_POST] = field.goal_width / 2
    p[k.S_HALF_WIDTH] = field.half_width
    p[k.S_AREA_X] = field.half_length - field.defense_depth
    p[k.S_AREA_Y] = field.defense_width / 2
    p[k.S_LIMIT] = settings.time_limit
    p[k.S_LOST] = inf if settings.lost_distance is None else settings.lost_distance
    p[k.S_W_FACE] = reward.face_goal
    p[k.S_INSIDE] = reward.inside_share
    p[k.S_W_KICK] = reward.kick
    p[k.S_FIRED] = float(reward.kick_counts == "fired")
    p[k.S_W_WAITING] = reward.waiting
    p[k.S_W_GOAL] = reward.goal
    p[k.S_W_TIME] = reward.time
    return p
