"""Go-To-Ball over many arenas."""

from __future__ import annotations

from functools import partial
from math import atan2, cos, hypot, inf, sin
from typing import Protocol

import numpy as np

from robobt.learning.envs.arena_task import ArenaTask
from robobt.learning.envs.bounds import BUMP, farthest, seen_speed, seen_turn
from robobt.learning.envs.episodes import straight_line_time
from robobt.learning.envs.go_to_ball.rewards import GoToBallReward, GoToBallTerms, reward
from robobt.learning.envs.go_to_ball.settings import (
    ContactRule,
    GoToBallSettings,
)
from robobt.learning.envs.go_to_ball.starts import columns_of, go_to_ball_starts
from robobt.learning.envs.judging import (
    PROGRESS,
    EpisodeProgress,
    Ledger,
    Report,
    begin_tick,
    end_tick,
    is_over,
    parameters,
    report_of,
)
from robobt.learning.envs.scripted import BEHIND, drive_and_face, drive_to_shoot, freest_way, steady_gain
from robobt.learning.envs.starts import split, start_parts
from robobt.learning.envs.task import EpisodeEnds, FloatArray, IntArray
from robobt.learning.envs.task_parts import Policy
from robobt.learning.opponents.patrols import PATROL_TRAITS, Patrols
from robobt.skills.ball.go_to_ball import GoToBall
from robobt.skills.base import Skill
from robobt.world.avoiding import GO_TO_BALL_AMONG_ROBOTS, among_robots_rows
from robobt.world.compiled import Index, compilable, compiled_lean, record_dtype
from robobt.world.features import (
    GO_TO_BALL,
    GO_TO_BALL_TO_SHOOT,
    ObservationSpec,
    go_to_ball_rows,
)
from robobt.world.field import FieldGeometry
from robobt.world.geometry import wrap_angle
from robobt.world.records import BALL, ROBOT, Ball, Robot
from robobt.world.state import BALL_RADIUS, ROBOT_RADIUS

_CONTACT_RULES = ("distance", "distance_facing", "infrared", "held")
_DISTANCE_RULE, _FACING_RULE, _INFRARED_RULE = (_CONTACT_RULES.index(rule) for rule in _CONTACT_RULES[:3])
_KICK_SPEED = 6.0
"""Speed of the kick assumed when fetching the ball in order to shoot [m/s]; that of the shipped Shoot."""
_FROM_POST = 0.15
"""Distance inside the posts at which that kick has to cross the line [m]."""
TOUCHING = 2.0 * ROBOT_RADIUS + 0.005
"""Robots whose centres are closer than this touch [m]; contact is checked once per tick."""


class _GoToBallJudging(Protocol):
    """Parameters for judging a tick.

    ``rule`` is an index in ``_CONTACT_RULES``, ``dribbler`` says whether it is on,
    ``to_shoot`` whether the ball is fetched in order to shoot.
    """

    settings: GoToBallSettings
    field: FieldGeometry
    contact: ContactRule
    weights: GoToBallReward
    rule: Index
    dribbler: float
    to_shoot: float


_GO_TO_BALL_JUDGING, _GO_TO_BALL_TERMS = record_dtype(_GoToBallJudging), record_dtype(GoToBallTerms)


class GoToBallTask(ArenaTask):
    """Drive to the ball.

    Source: "Machine Learning Approaches for Attacking Behaviors in Robot Soccer",
    with the choices of the authors' published code where the paper is silent. The equations of the reward are
    its Eqs. 7 to 9. The values below are the defaults of :class:`~robobt.learning.envs.GoToBallSettings`,
    where all of them can be changed.

    One step is one control period of 30 ms, in 4 physics steps with walls, goals
    and ball contacts.

    **Observation**, float32, :data:`robobt.world.features.GO_TO_BALL`; the frame
    is the robot's, x ahead and y to its left:

    | entry | meaning | unit | range |
    | --- | --- | --- | --- |
    | 0 | sine of the angle from the heading to the ball | 1 | [-1, 1] |
    | 1 | cosine of it | 1 | [-1, 1] |
    | 2 | distance of the centres of robot and ball | m | [0, diagonal inside the walls] |
    | 3 | the robot's velocity ahead | m/s | top speed + 0.5, either way |
    | 4 | the robot's velocity to the left | m/s | top speed + 0.5, either way |
    | 5 | its turning rate, counter-clockwise | rad/s | top rate + what a wall may add |

    **Action**, float32, :data:`robobt.models.actions.GO_TO_BALL_ACTION`:

    | entry | meaning | of 1 | range |
    | --- | --- | --- | --- |
    | 0 | velocity ahead | 1.5 m/s | [-1, 1] |
    | 1 | velocity to the left | 1.5 m/s | [-1, 1] |
    | 2 | turning rate | 1.395 rad/s | [-1, 1] |

    The velocity is shortened to 1.5 m/s; the robot follows within its
    accelerations.

    **Reward** per step, with d the distance [m] and theta the angle to the ball [rad] after the step:

    | term | value | equation |
    | --- | --- | --- |
    | contact | 100 where d <= 0.2 m | 7 |
    | distance | 5 / sqrt(2 pi) exp(-d^2 / 2) - 2 | 8 |
    | orientation | 1 / sqrt(2 pi) exp(-2 abs(theta) / pi^2) | 9 |

    Hovering just outside 0.2 m, facing the ball, earns 0.354 a step: with a
    discount below 0.996 that is worth less than the contact. The undiscounted
    return rewards hovering; compare policies by success and time.

    **Start**: ball and robot are anywhere at least 0.1 m inside the lines and at least 0.2 m apart, with any
    heading in [-pi, pi), at rest.

    **End**: terminated by contact, which is success; truncated after 330 steps
    (9.9 s).
    """

    terms = _GO_TO_BALL_TERMS
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
        self._judged_by = parameters(
            _GO_TO_BALL_JUDGING,
            settings=settings,
            field=settings.field,
            contact=settings.contact,
            weights=settings.reward,
            rule=_CONTACT_RULES.index(settings.contact.rule),
            dribbler=self.action.dribbler,
            to_shoot=settings.to_shoot,
        )

    def sample(self, rng: np.random.Generator, count: int) -> FloatArray:
        """See :func:`~robobt.learning.envs.go_to_ball.starts.go_to_ball_starts`."""
        return go_to_ball_starts(self.settings, rng, count)

    def observe(self, robots: FloatArray, balls: FloatArray) -> FloatArray:
        """See :attr:`observation`."""
        if self.robots > 1:
            return among_robots_rows(robots, balls)
        return go_to_ball_rows(robots[:, 0], balls, self.settings.field.half_length, self.seen_size)

    @property
    def ranges(self) -> dict[str, float]:
        """See :attr:`ArenaTask.ranges`."""
        settings = self.settings
        limits, starts = settings.robot_limits, settings.starts
        fastest = limits.max_speed * max(settings.randomisation.top_speed)
        speed = max(min(fastest, settings.action.max_speed), *starts.robot_speed) + BUMP
        speed += max(0.0, *starts.ball_speed)
        turn = max(min(limits.max_turn, settings.action.max_turn), *map(abs, starts.robot_turn))
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
        if self.robots > 1:
            return freest_way
        gain = steady_gain(self.settings.longest_delay)
        return partial(drive_and_face, max_turn=self.action.max_turn, gain=gain)

    def skill(self) -> Skill:
        """See :meth:`ArenaTask.skill`."""
        return GoToBall(goalkeeper=True)

    def _build(self) -> None:
        settings = self.settings
        self._patrols = Patrols(settings.simulator.limits, settings.period, self.n, self.robots - 1)
        super()._build()

    def begin(self, starts: FloatArray, which: IntArray) -> None:
        """See :meth:`ArenaTask.begin`."""
        _, _, traits = split(starts, self.robots)
        self._patrols.restart(which, traits.reshape(len(which), self.robots - 1, len(PATROL_TRAITS)))

    def oppose(self, commands: FloatArray) -> None:
        """See :meth:`ArenaTask.oppose`."""
        if self.robots > 1:
            self._patrols.decide(self.arenas.robots, commands)

    def _judge(self, actions: FloatArray, rewards: FloatArray, ends: EpisodeEnds) -> bool:
        return _judge(self._judged_by, actions, report_of(self.arenas), self._ledger(rewards, ends))

    def _optimum(self, starts: FloatArray, which: IntArray) -> FloatArray:
        settings = self.settings
        rule, limits, body = settings.contact, settings.robot_limits, settings.simulator.body
        reach = rule.distance
        if rule.rule in ("infrared", "held"):
            reach = body.face + BALL_RADIUS + body.sensor_depth
        robots, ball, _ = start_parts(starts, self.robots)
        robot = robots[:, 0]
        way = np.hypot(ball["x"] - robot["x"], ball["y"] - robot["y"]) - reach
        way = np.maximum(way, 0.0)
        for axis in ("vx", "vy"):
            way[(robot[axis] != 0.0) | (ball[axis] != 0.0)] = np.nan
        fastest = max(limits.acceleration, limits.lateral_acceleration) * self._randomiser.acceleration[which]
        top_speed = limits.max_speed * self._randomiser.top_speed[which]
        return straight_line_time(way, np.minimum(top_speed, settings.action.max_speed), fastest)


@compiled_lean
def _judge(task_: FloatArray, actions: FloatArray, report_: Report, ledger_: Ledger) -> bool:
    task: _GoToBallJudging = task_.view(_GO_TO_BALL_JUDGING)[0]
    arenas, ledger = Report(*report_), Ledger(*ledger_)
    robots, balls = arenas.robots.view(ROBOT)[..., 0], arenas.balls.view(BALL)[..., 0]
    episodes, terms = ledger.progress.view(PROGRESS)[..., 0], ledger.terms.view(_GO_TO_BALL_TERMS)[..., 0]
    any_ended = False
    for i in range(len(balls)):
        if is_over(ledger, i):
            any_ended = True
            continue
        robot, ball, in_mouth = robots[i, 0], balls[i], arenas.contact[i, 0]
        episode: EpisodeProgress = episodes[i]
        begin_tick(episode, False)
        episode.ticks_held = episode.ticks_held + 1 if in_mouth and task.dribbler else 0.0
        nearest = inf
        for k in range(1, robots.shape[1]):
            other = robots[i, k]
            nearest = min(nearest, hypot(other.x - robot.x, other.y - robot.y))
        touched = nearest < TOUCHING
        reached = _reached(task, robot, ball, in_mouth, episode.ticks_held) and not touched
        gap = nearest - 2.0 * ROBOT_RADIUS
        place = _place(task, robot, ball)
        earned = reward(task.weights, robot, ball, actions[i], reached, place, gap, touched, terms[i])
        if end_tick(ledger, i, earned, reached, touched, task.settings.time_limit):
            any_ended = True
    return any_ended


@compilable
def _reached(task: _GoToBallJudging, robot: Robot, ball: Ball, in_mouth: bool, ticks_held: float) -> bool:
    """Return whether the robot has reached the ball, whether or not it touches another robot."""
    contact = task.contact
    if task.rule in (_DISTANCE_RULE, _FACING_RULE):
        dx, dy = ball.x - robot.x, ball.y - robot.y
        reached = hypot(dx, dy) <= contact.distance
        if reached and task.rule == _FACING_RULE:
            reached = abs(wrap_angle(atan2(dy, dx) - robot.heading)) <= contact.angle
    elif task.rule == _INFRARED_RULE:
        reached = in_mouth
    else:
        reached = ticks_held >= contact.ticks
    if task.to_shoot:
        reached = reached and _would_score(robot.heading, ball, task.field)
    if contact.max_speed is not None:
        reached = reached and hypot(robot.vx, robot.vy) <= contact.max_speed
    return reached


@compilable
def _place(task: _GoToBallJudging, robot: Robot, ball: Ball) -> tuple[float, float, float]:
    """Return the robot's target [m] and its final heading [rad]."""
    if not task.to_shoot:
        return ball.x, ball.y, atan2(ball.y - robot.y, ball.x - robot.x)
    facing = atan2(-ball.y, task.field.length / 2 - ball.x)
    return ball.x - BEHIND * cos(facing), ball.y - BEHIND * sin(facing), facing


@compilable
def _would_score(heading: float, ball: Ball, field: FieldGeometry) -> bool:
    """Return whether a kick now would go in, along the heading and with the ball's sideways velocity."""
    c, s = cos(heading), sin(heading)
    sideways = c * ball.vy - s * ball.vx
    vx, vy = _KICK_SPEED * c - sideways * s, _KICK_SPEED * s + sideways * c
    crossing = ball.y + vy / vx * (field.length / 2 - ball.x) if vx > 0.0 else inf
    return bool(abs(crossing) <= field.goal_width / 2 - _FROM_POST)
