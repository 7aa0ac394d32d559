"""Go-To-Ball over many arenas."""

from __future__ import annotations

from math import inf
from typing import ClassVar

import numpy as np

from robobt.learning.envs import kernels as k
from robobt.learning.envs.arena_task import ArenaTask
from robobt.learning.envs.episodes import straight_line_time
from robobt.learning.envs.settings import GoToBallSettings
from robobt.learning.envs.starts import go_to_ball_starts
from robobt.learning.envs.task import BoolArray, FloatArray, IntArray
from robobt.world.features import GO_TO_BALL, ObservationSpec
from robobt.world.state import BALL_RADIUS

_RULES = {
    "distance": k.DISTANCE_RULE,
    "distance_facing": k.FACING_RULE,
    "infrared": k.INFRARED_RULE,
    "held": k.HELD_RULE,
}


class GoToBallTask(ArenaTask):
    """Drive to the ball; :class:`~robobt.learning.envs.GoToBallEnv` is the specification.

    Args:
        settings: of the environment.
        n: number of arenas.
        seed: of everything drawn; None for another each time.
    """

    observation: ClassVar[ObservationSpec] = GO_TO_BALL

    def __init__(self, settings: GoToBallSettings | None = None, n: int = 1, seed: int | None = None) -> None:
        self.settings = GoToBallSettings() if settings is None else settings
        super().__init__(self.settings, self.settings.action, n, seed)
        self._parameters = _parameters(self.settings)

    def sample(self, rng: np.random.Generator, count: int) -> FloatArray:
        """See :func:`~robobt.learning.envs.starts.go_to_ball_starts`."""
        return go_to_ball_starts(self.settings, rng, count)

    def observe(self, robots: FloatArray, balls: FloatArray) -> FloatArray:
        """:data:`robobt.world.features.GO_TO_BALL`."""
        seen = np.empty((len(balls), self.observation_size))
        k.observe_go_to_ball(robots, balls, seen)
        return seen

    def _command(self, actions: FloatArray) -> bool:
        scaling = self.action
        return k.drive_commands(
            actions, scaling.max_speed, scaling.max_turn, float(scaling.dribbler), self._commands
        )

    def _judge(
        self,
        actions: FloatArray,  # noqa: ARG002 - the robot's motion says all
        reward: FloatArray,
        terminated: BoolArray,
        truncated: BoolArray,
        success: BoolArray,
    ) -> bool:
        arenas = self.arenas
        return k.judge_go_to_ball(
            arenas.robots,
            arenas.balls,
            arenas.contact,
            self._commands,
            self._parameters,
            self._counters,
            self._sums,
            reward,
            terminated,
            truncated,
            success,
        )

    def _at_best(self, starts: FloatArray, which: IntArray) -> tuple[FloatArray, FloatArray]:
        settings = self.settings
        rule, limits, body = settings.contact, settings.robot_limits, settings.simulator.body
        reach = rule.distance
        if rule.rule in ("infrared", "held"):
            reach = body.face + BALL_RADIUS + body.sensor_depth
        way = np.hypot(starts[:, 6] - starts[:, 0], starts[:, 7] - starts[:, 1]) - reach
        way = np.maximum(way, 0.0)
        way[np.any(starts[:, (3, 4, 8, 9)] != 0.0, axis=1)] = np.nan
        fastest = max(limits.acceleration, limits.lateral_acceleration) * self._randomiser.acceleration[which]
        return way, straight_line_time(way, min(limits.max_speed, settings.action.max_speed), fastest)


def _parameters(settings: GoToBallSettings) -> FloatArray:
    rule, reward = settings.contact, settings.reward
    p = np.zeros(k.G_PARAMETERS)
    p[k.G_RULE] = _RULES[rule.rule]
    p[k.G_DISTANCE] = rule.distance
    p[k.G_ANGLE] = rule.angle
    p[k.G_HOLD] = rule.ticks
    p[k.G_SPEED] = inf if rule.max_speed is None else rule.max_speed
    p[k.G_LIMIT] = settings.time_limit
    p[k.G_W_CONTACT] = reward.contact
    p[k.G_W_DISTANCE] = reward.distance
    p[k.G_W_ORIENTATION] = reward.orientation
    p[k.G_W_TIME] = reward.time
    return p
