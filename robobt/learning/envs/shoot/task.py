"""Shoot-Towards-Goal over many arenas."""

from __future__ import annotations

from functools import partial
from math import hypot

import numpy as np

from robobt.learning.envs.arena_task import ArenaTask, Policy
from robobt.learning.envs.bounds import BUMP, farthest, seen_speed, seen_turn
from robobt.learning.envs.judging import begin_tick, end_tick, goal_of, is_over
from robobt.learning.envs.progress import PROGRESS, Progress
from robobt.learning.envs.scripted import turn_and_kick
from robobt.learning.envs.shoot.rewards import ShootReward, ShootTerms, reward
from robobt.learning.envs.shoot.settings import ShootSettings
from robobt.learning.envs.shoot.starts import shoot_starts
from robobt.learning.envs.task import BoolArray, FloatArray
from robobt.skills.ball.kick_to_target import KickToTarget
from robobt.skills.base import Skill
from robobt.world.compiled import compiled, numbers_dtype, numbers_of, record_dtype
from robobt.world.features import SHOOT, ObservationSpec, shoot_rows
from robobt.world.field import FieldGeometry
from robobt.world.rules import in_area, is_out
from robobt.world.state import ROBOT_RADIUS

_SETTINGS, _FIELD = numbers_dtype(ShootSettings), numbers_dtype(FieldGeometry)
_WEIGHTS, _TERMS = numbers_dtype(ShootReward), record_dtype(ShootTerms)

_CAREFUL = 0.9
"""Share of what the dribbler can hold that the script turns with."""
_ROBOT_BACK_LIMIT = -0.2
"""A robot farther back than this ends an episode [m]. Source: the authors' code."""


class ShootTask(ArenaTask):
    """Turn and kick the ball into the goal; see :class:`~robobt.learning.envs.ShootTowardsGoalEnv`."""

    terms = _TERMS
    Settings = ShootSettings
    played_by = "Shoot"
    timed = "kick_time"
    observation: ObservationSpec = SHOOT
    settings: ShootSettings

    def __init__(self, settings: ShootSettings | None = None, n: int = 1, seed: int | None = None) -> None:
        super().__init__(settings, n, seed)
        field = self.settings.field
        self._goal = field.half_length, field.goal_width / 2
        self._field = numbers_of(field)
        self._weights = numbers_of(self.settings.reward)
        self._firing_counts = self.settings.reward.kick_counts == "fired"

    def sample(self, rng: np.random.Generator, count: int) -> FloatArray:
        """See :func:`~robobt.learning.envs.shoot.starts.shoot_starts`."""
        return shoot_starts(self.settings, rng, count)

    def observe(self, robots: FloatArray, balls: FloatArray) -> FloatArray:
        """See :data:`robobt.world.features.SHOOT`."""
        return shoot_rows(robots[:, 0], balls, *self._goal)

    @property
    def ranges(self) -> dict[str, float]:
        """See :attr:`ArenaTask.ranges`."""
        settings, starts = self.settings, self.settings.starts
        turn = max(settings.action.max_turn, *map(abs, starts.robot_turn))
        speed = settings.simulator.kicker.max_speed + turn * ROBOT_RADIUS * 2.0 + BUMP
        return {
            "far": farthest(settings),
            "ball_speed": seen_speed(settings, speed, settings.noise.ball_position),
            "turn": seen_turn(settings, turn + BUMP / ROBOT_RADIUS),
        }

    def script(self) -> Policy:
        """See :meth:`ArenaTask.script`."""
        simulator = self.settings.simulator
        dribbler = simulator.dribbler
        held = dribbler.pull if dribbler.kind == "force" else simulator.limits.hold_acceleration
        pull = np.inf if dribbler.kind == "glue" else _CAREFUL * held
        return partial(turn_and_kick, scaling=self.action, pull=pull)

    def skill(self) -> Skill:
        """See :meth:`ArenaTask.skill`."""
        return KickToTarget(target=self.settings.field.their_goal, kick_speed=self.action.kick_speed)

    def _judge(self, actions: FloatArray, rewards: FloatArray, ends: BoolArray) -> bool:
        arenas = self.arenas
        return _judge(
            self._numbers,
            self._field,
            self._weights,
            self._firing_counts,
            actions,
            arenas.robots,
            arenas.balls,
            arenas.kicked,
            self._progress_rows,
            self._term_rows,
            rewards,
            ends,
        )


@compiled
def _judge(
    settings_: FloatArray,
    field_: FloatArray,
    weights_: FloatArray,
    firing_counts: bool,
    actions: FloatArray,
    robots: FloatArray,
    balls: FloatArray,
    kicked: BoolArray,
    progress: FloatArray,
    terms_: FloatArray,
    rewards: FloatArray,
    ends: BoolArray,
) -> bool:
    settings: ShootSettings = settings_.view(_SETTINGS)[0]
    field: FieldGeometry = field_.view(_FIELD)[0]
    weights: ShootReward = weights_.view(_WEIGHTS)[0]
    episodes, terms = progress.view(PROGRESS), terms_.view(_TERMS)
    half_length, half_width, post = field.length / 2, field.width / 2, field.goal_width / 2
    any_ended = False
    for i in range(len(balls)):
        if is_over(ends, i):
            any_ended = True
            continue
        robot, ball, fired = robots[i, 0], balls[i], kicked[i, 0]
        episode: Progress = episodes[i, 0]
        begin_tick(episode, fired)
        goal = goal_of(episode, ball, half_length, half_width, post) > 0
        out = is_out(ball[0], ball[1], half_length, half_width) or ball[0] < 0.0
        out = out or robot[0] < _ROBOT_BACK_LIMIT or abs(robot[1]) > half_width
        out = out or in_area(robot[0], robot[1], half_length, field.defense_depth, field.defense_width)
        if settings.lost_distance is not None and episode.kick_tick < 0:
            out = out or hypot(ball[0] - robot[0], ball[1] - robot[1]) > settings.lost_distance
        kick = fired if firing_counts else actions[i, 1] > 0.0
        earned = reward(weights, half_length, post, robot, ball, kick, goal, out, episode, terms[i, 0])
        if end_tick(episode, earned, goal, out, settings.time_limit, i, rewards, ends):
            any_ended = True
    return any_ended
