"""Go-To-Ball over many arenas."""

from __future__ import annotations

from math import atan2, hypot
from typing import ClassVar

import numpy as np

from robobt.learning.envs.arena_task import ArenaTask
from robobt.learning.envs.episodes import straight_line_time
from robobt.learning.envs.go_to_ball.rewards import GoToBallReward, reward
from robobt.learning.envs.go_to_ball.settings import ContactRule, GoToBallSettings
from robobt.learning.envs.go_to_ball.starts import go_to_ball_starts
from robobt.learning.envs.progress import PROGRESS, Progress
from robobt.learning.envs.task import SUCCESS, TERMINATED, TRUNCATED, BoolArray, FloatArray, IntArray
from robobt.world.compiled import compiled, numbers_dtype, numbers_of
from robobt.world.features import GO_TO_BALL, ObservationSpec, go_to_ball_rows
from robobt.world.geometry import wrap_angle
from robobt.world.state import BALL_RADIUS

_RULES = ("distance", "distance_facing", "infrared", "held")
_DISTANCE, _FACING, _INFRARED, _HELD = range(4)
_SETTINGS, _CONTACT = numbers_dtype(GoToBallSettings), numbers_dtype(ContactRule)
_WEIGHTS = numbers_dtype(GoToBallReward)


class GoToBallTask(ArenaTask):
    """Drive to the ball; :class:`~robobt.learning.envs.GoToBallEnv` is the specification."""

    observation: ClassVar[ObservationSpec] = GO_TO_BALL
    settings: GoToBallSettings

    def __init__(self, settings: GoToBallSettings | None = None, n: int = 1, seed: int | None = None) -> None:
        super().__init__(GoToBallSettings() if settings is None else settings, n, seed)
        self._contact = numbers_of(self.settings.contact)
        self._rule = _RULES.index(self.settings.contact.rule)
        self._weights = numbers_of(self.settings.reward)

    def sample(self, rng: np.random.Generator, count: int) -> FloatArray:
        """See :func:`~robobt.learning.envs.go_to_ball.starts.go_to_ball_starts`."""
        return go_to_ball_starts(self.settings, rng, count)

    def observe(self, robots: FloatArray, balls: FloatArray) -> FloatArray:
        """See :data:`robobt.world.features.GO_TO_BALL`."""
        return go_to_ball_rows(robots[:, 0], balls)

    def _judge(self, actions: FloatArray, rewards: FloatArray, ends: BoolArray) -> bool:
        arenas = self.arenas
        return _judge(
            self._numbers,
            self._contact,
            self._weights,
            self._rule,
            self.action.dribbler,
            actions,
            arenas.robots,
            arenas.balls,
            arenas.contact,
            self._progress_rows,
            rewards,
            ends,
        )

    def _optimum(self, starts: FloatArray, which: IntArray) -> FloatArray:
        settings = self.settings
        rule, limits, body = settings.contact, settings.robot_limits, settings.simulator.body
        reach = rule.distance
        if rule.rule in ("infrared", "held"):
            reach = body.face + BALL_RADIUS + body.sensor_depth
        way = np.hypot(starts[:, 6] - starts[:, 0], starts[:, 7] - starts[:, 1]) - reach
        way = np.maximum(way, 0.0)
        way[np.any(starts[:, (3, 4, 8, 9)] != 0.0, axis=1)] = np.nan
        fastest = max(limits.acceleration, limits.lateral_acceleration) * self._randomiser.acceleration[which]
        return straight_line_time(way, min(limits.max_speed, settings.action.max_speed), fastest)


@compiled
def _judge(
    settings_: FloatArray,
    contact_: FloatArray,
    weights_: FloatArray,
    rule: int,
    dribbler: bool,
    actions: FloatArray,
    robots: FloatArray,
    balls: FloatArray,
    in_mouth: BoolArray,
    progress: FloatArray,
    rewards: FloatArray,
    ends: BoolArray,
) -> bool:
    settings: GoToBallSettings = settings_.view(_SETTINGS)[0]
    contact: ContactRule = contact_.view(_CONTACT)[0]
    weights: GoToBallReward = weights_.view(_WEIGHTS)[0]
    episodes = progress.view(PROGRESS)
    any_ended = False
    for i in range(len(balls)):
        robot, ball = robots[i, 0], balls[i]
        episode: Progress = episodes[i, 0]
        episode.ticks += 1
        episode.ticks_held = episode.ticks_held + 1 if in_mouth[i, 0] and dribbler else 0.0
        if rule in (_DISTANCE, _FACING):
            dx, dy = ball[0] - robot[0], ball[1] - robot[1]
            reached = hypot(dx, dy) <= contact.distance
            if reached and rule == _FACING:
                reached = abs(wrap_angle(atan2(dy, dx) - robot[2])) <= contact.angle
        elif rule == _INFRARED:
            reached = in_mouth[i, 0]
        else:
            reached = episode.ticks_held >= contact.ticks
        if contact.max_speed is not None:
            reached = reached and hypot(robot[3], robot[4]) <= contact.max_speed
        rewards[i] = reward(weights, robot, ball, actions[i], reached)
        episode.total_reward += rewards[i]
        ends[TERMINATED, i] = ends[SUCCESS, i] = reached
        ends[TRUNCATED, i] = not reached and episode.ticks >= settings.time_limit
        any_ended = any_ended or reached or ends[TRUNCATED, i]
    return any_ended
