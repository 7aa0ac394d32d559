"""Go-To-Ball over many arenas."""

from __future__ import annotations

from functools import partial
from math import atan2, cos, hypot, inf, sin

import numpy as np

from robobt.learning.envs.arena_task import ArenaTask, Policy
from robobt.learning.envs.bounds import BUMP, farthest, seen_speed, seen_turn
from robobt.learning.envs.episodes import straight_line_time
from robobt.learning.envs.go_to_ball.rewards import GoToBallReward, GoToBallTerms, reward
from robobt.learning.envs.go_to_ball.settings import (
    ContactRule,
    GoToBallAmongRobotsSettings,
    GoToBallSettings,
)
from robobt.learning.envs.go_to_ball.starts import columns_of, go_to_ball_starts
from robobt.learning.envs.judging import begin_tick, end_tick, is_over
from robobt.learning.envs.progress import PROGRESS, Progress
from robobt.learning.envs.scripted import BEHIND, drive_and_face, drive_to_shoot, freest_way
from robobt.learning.envs.task import BoolArray, FloatArray, IntArray
from robobt.learning.opponents.patrols import TRAITS, Patrols
from robobt.skills.ball.go_to_ball import GoToBall
from robobt.skills.base import Skill
from robobt.world.avoiding import GO_TO_BALL_AMONG_ROBOTS, among_robots_rows
from robobt.world.compiled import compiled, numbers_dtype, numbers_of, record_dtype
from robobt.world.features import (
    GO_TO_BALL,
    GO_TO_BALL_TO_SHOOT,
    ObservationSpec,
    go_to_ball_rows,
)
from robobt.world.geometry import wrap_angle
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

_RULES = ("distance", "distance_facing", "infrared", "held")
_DISTANCE, _FACING, _INFRARED, _HELD = range(4)
_KICK_SPEED = 6.0
"""Kick that is thought of when the ball is fetched in order to shoot [m/s]; that of the shipped Shoot."""
_FROM_POST = 0.15
"""How far inside the posts it has to cross the line [m]."""
TOUCHING = 2.0 * ROBOT_RADIUS + 0.005
"""Robots whose centres are nearer touch [m]: contact is seen once a tick."""
_SETTINGS, _CONTACT = numbers_dtype(GoToBallSettings), numbers_dtype(ContactRule)
_WEIGHTS, _TERMS = numbers_dtype(GoToBallReward), record_dtype(GoToBallTerms)


class GoToBallTask(ArenaTask):
    """Drive to the ball; :class:`~robobt.learning.envs.GoToBallEnv` is the specification."""

    terms = _TERMS
    Settings = GoToBallSettings
    played_by = "GoToBall"
    observation: ObservationSpec = GO_TO_BALL
    settings: GoToBallSettings

    def __init__(self, settings: GoToBallSettings | None = None, n: int = 1, seed: int | None = None) -> None:
        settings = self.Settings() if settings is None else settings
        self._to_shoot = settings.to_shoot
        if settings.to_shoot:
            self.observation = GO_TO_BALL_TO_SHOOT
        elif settings.others.count:
            self.observation = GO_TO_BALL_AMONG_ROBOTS
        self.robots = 1 + settings.others.count
        self.start_columns = columns_of(settings)
        super().__init__(settings, n, seed)
        self._goal = (self.settings.field.half_length, self.settings.field.goal_width / 2)
        self._contact = numbers_of(self.settings.contact)
        self._rule = _RULES.index(self.settings.contact.rule)
        self._weights = numbers_of(self.settings.reward)

    def sample(self, rng: np.random.Generator, count: int) -> FloatArray:
        """See :func:`~robobt.learning.envs.go_to_ball.starts.go_to_ball_starts`."""
        return go_to_ball_starts(self.settings, rng, count)

    def observe(self, robots: FloatArray, balls: FloatArray) -> FloatArray:
        """See :attr:`observation`."""
        if self.robots > 1:
            return among_robots_rows(robots, balls)
        return go_to_ball_rows(robots[:, 0], balls, self._goal[0], self.observation_size)

    @property
    def ranges(self) -> dict[str, float]:
        """See :attr:`ArenaTask.ranges`."""
        settings = self.settings
        limits, starts = settings.robot_limits, settings.starts
        fastest = limits.max_speed * settings.randomisation.top_speed[1]
        speed = max(min(fastest, settings.action.max_speed), starts.robot_speed[1]) + BUMP
        speed += max(0.0, starts.ball_speed[1])
        turn = max(
            min(limits.max_turn, settings.action.max_turn),
            abs(starts.robot_turn[0]),
            abs(starts.robot_turn[1]),
        )
        # Sliding along a wall turns a robot, at most until it rolls along it.
        turn += speed / ROBOT_RADIUS
        return {
            "far": farthest(settings),
            "speed": seen_speed(settings, speed, settings.noise.robot_position),
            "turn": seen_turn(settings, turn),
        }

    @property
    def reach(self) -> float | None:
        """See :attr:`ArenaTask.reach`."""
        contact = self.settings.contact
        return contact.distance if contact.rule.startswith("distance") else None

    def script(self) -> Policy:
        """See :meth:`ArenaTask.script`."""
        if self._to_shoot:
            return partial(drive_to_shoot, max_turn=self.action.max_turn)
        return freest_way if self.robots > 1 else partial(drive_and_face, max_turn=self.action.max_turn)

    def skill(self) -> Skill:
        """See :meth:`ArenaTask.skill`."""
        return GoToBall(goalkeeper=True)

    def _build(self) -> None:
        settings = self.settings
        self._patrols = Patrols(settings.simulator.limits, settings.period, self.n, self.robots - 1)
        super()._build()

    def begin(self, starts: FloatArray, which: IntArray) -> None:
        """See :meth:`ArenaTask.begin`."""
        traits = starts[:, 6 * self.robots + 4 :]
        self._patrols.restart(which, traits.reshape(len(which), self.robots - 1, len(TRAITS)))

    def oppose(self, commands: FloatArray) -> None:
        """See :meth:`ArenaTask.oppose`."""
        if self.robots > 1:
            self._patrols.decide(self.arenas.robots, commands[:, 1:])

    def _judge(self, actions: FloatArray, rewards: FloatArray, ends: BoolArray) -> bool:
        arenas = self.arenas
        return _judge(
            self._numbers,
            self._contact,
            self._weights,
            self._rule,
            self.action.dribbler,
            self._to_shoot,
            *self._goal,
            actions,
            arenas.robots,
            arenas.balls,
            arenas.contact,
            self._progress_rows,
            self._term_rows,
            rewards,
            ends,
        )

    def _optimum(self, starts: FloatArray, which: IntArray) -> FloatArray:
        settings = self.settings
        rule, limits, body = settings.contact, settings.robot_limits, settings.simulator.body
        reach = rule.distance
        if rule.rule in ("infrared", "held"):
            reach = body.face + BALL_RADIUS + body.sensor_depth
        balls = starts[:, 6 * self.robots :]
        way = np.hypot(balls[:, 0] - starts[:, 0], balls[:, 1] - starts[:, 1]) - reach
        way = np.maximum(way, 0.0)
        way[np.any(starts[:, (3, 4)] != 0.0, axis=1) | np.any(balls[:, 2:4] != 0.0, axis=1)] = np.nan
        fastest = max(limits.acceleration, limits.lateral_acceleration) * self._randomiser.acceleration[which]
        top_speed = limits.max_speed * self._randomiser.top_speed[which]
        return straight_line_time(way, np.minimum(top_speed, settings.action.max_speed), fastest)


class GoToBallAmongRobotsTask(GoToBallTask):
    """Drive to the ball among others; :class:`~robobt.learning.envs.GoToBallAmongRobotsEnv` specifies it."""

    Settings = GoToBallAmongRobotsSettings


@compiled
def _would_score(heading: float, ball: FloatArray, goal_x: float, post_y: float) -> bool:
    """Return whether the ball would go in, kicked now: along the heading, with its sideways velocity."""
    c, s = cos(heading), sin(heading)
    sideways = c * ball[3] - s * ball[2]
    vx, vy = _KICK_SPEED * c - sideways * s, _KICK_SPEED * s + sideways * c
    crossing = ball[1] + vy / vx * (goal_x - ball[0]) if vx > 0.0 else inf
    return bool(abs(crossing) <= post_y - _FROM_POST)


@compiled
def _judge(
    settings_: FloatArray,
    contact_: FloatArray,
    weights_: FloatArray,
    rule: int,
    dribbler: bool,
    to_shoot: bool,
    goal_x: float,
    post_y: float,
    actions: FloatArray,
    robots: FloatArray,
    balls: FloatArray,
    in_mouth: BoolArray,
    progress: FloatArray,
    terms_: FloatArray,
    rewards: FloatArray,
    ends: BoolArray,
) -> bool:
    settings: GoToBallSettings = settings_.view(_SETTINGS)[0]
    contact: ContactRule = contact_.view(_CONTACT)[0]
    weights: GoToBallReward = weights_.view(_WEIGHTS)[0]
    episodes, terms = progress.view(PROGRESS), terms_.view(_TERMS)
    any_ended = False
    for i in range(len(balls)):
        if is_over(ends, i):
            any_ended = True
            continue
        robot, ball = robots[i, 0], balls[i]
        episode: Progress = episodes[i, 0]
        begin_tick(episode, False)
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
        place_x, place_y = ball[0], ball[1]
        facing = atan2(ball[1] - robot[1], ball[0] - robot[0])
        if to_shoot:
            facing = atan2(-ball[1], goal_x - ball[0])
            place_x -= BEHIND * cos(facing)
            place_y -= BEHIND * sin(facing)
            reached = reached and _would_score(robot[2], ball, goal_x, post_y)
        if contact.max_speed is not None:
            reached = reached and hypot(robot[3], robot[4]) <= contact.max_speed
        nearest = inf
        for other in range(1, robots.shape[1]):
            nearest = min(nearest, hypot(robots[i, other, 0] - robot[0], robots[i, other, 1] - robot[1]))
        touched = nearest < TOUCHING
        reached = reached and not touched
        gap = nearest - 2.0 * ROBOT_RADIUS
        place = place_x, place_y
        earned = reward(weights, robot, ball, actions[i], reached, place, facing, gap, touched, terms[i, 0])
        if end_tick(episode, earned, reached, touched, settings.time_limit, i, rewards, ends):
            any_ended = True
    return any_ended
