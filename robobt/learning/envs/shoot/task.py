"""Shoot-Towards-Goal over many arenas."""

from __future__ import annotations

from functools import partial
from math import hypot, sqrt
from typing import Protocol

import numpy as np

from robobt.learning.envs.arena_task import ArenaTask
from robobt.learning.envs.bounds import BUMP, farthest, seen_speed, seen_turn
from robobt.learning.envs.judging import (
    PROGRESS,
    EpisodeProgress,
    Ledger,
    Report,
    begin_tick,
    end_tick,
    goal_of,
    is_over,
    parameters,
    report_of,
)
from robobt.learning.envs.scripted import steady_gain, turn_and_kick
from robobt.learning.envs.shoot.rewards import ShootReward, ShootTerms, reward
from robobt.learning.envs.shoot.settings import ShootSettings
from robobt.learning.envs.shoot.starts import shoot_starts
from robobt.learning.envs.starts import start_parts
from robobt.learning.envs.task import EpisodeEnds, FloatArray, IntArray
from robobt.learning.envs.task_parts import Policy
from robobt.sim.records import COMMAND
from robobt.skills.ball.kick_to_target import KickToTarget
from robobt.skills.base import Skill
from robobt.world.compiled import compilable, compiled_lean, record_dtype
from robobt.world.features import SHOOT, ObservationSpec, shoot_rows
from robobt.world.field import FieldGeometry
from robobt.world.records import BALL, ROBOT, Ball, Robot
from robobt.world.rules import in_area, is_out
from robobt.world.state import ROBOT_RADIUS, TOUCH_DISTANCE

_HOLDING_SHARE = 0.9
"""Share of the dribbler's holding force that the script uses for turning."""
_ROBOT_BACK_LIMIT = -0.2
"""A robot farther back than this ends an episode [m]. Source: the authors' code."""


class _ShootJudging(Protocol):
    """Parameters for judging a tick; ``firing_counts`` says whether a kick is the kicker's firing."""

    settings: ShootSettings
    field: FieldGeometry
    weights: ShootReward
    firing_counts: float


class _Action(Protocol):
    """Turning rate and kick, in [-1, 1]."""

    turn: float
    kick: float


_SHOOT_JUDGING, _ACTION, _SHOOT_TERMS = (
    record_dtype(_ShootJudging),
    record_dtype(_Action),
    record_dtype(ShootTerms),
)


class ShootTask(ArenaTask):
    """Turn and kick the ball into the goal.

    Source: "Machine Learning Approaches for Attacking Behaviors in Robot Soccer",
    with the choices of the authors' published code where the paper is silent. The
    equations of the reward are its Eqs. 12 and 13. The values below are the defaults of
    :class:`~robobt.learning.envs.ShootSettings`, where all of them can be changed.

    One step is one control period of 30 ms, in 4 physics steps with walls, goals
    and ball contacts. The dribbler is on all the time. It holds the ball with limited force: a robot that
    turns too fast loses it.

    **Observation**, float32, :data:`robobt.world.features.SHOOT`; the frame is the
    robot's, x ahead and y to its left:

    | entry | meaning | unit | range |
    | --- | --- | --- | --- |
    | 0, 1 | position of the ball | m | diagonal inside the walls, either way |
    | 2, 3 | velocity of the ball over the field | m/s | fastest kick + 2.3, either way |
    | 4 | the robot's turning rate, counter-clockwise | rad/s | top rate + 5.6, either way |
    | 5 | distance to the middle of the goal | m | [0, diagonal inside the walls] |
    | 6, 7 | sine and cosine of the angle from the heading to the left post | 1 | [-1, 1] |
    | 8, 9 | sine and cosine of the angle to the right post | 1 | [-1, 1] |

    **Action**, float32, :data:`robobt.models.actions.SHOOT_ACTION`:

    | entry | meaning | of 1 | range |
    | --- | --- | --- | --- |
    | 0 | turning rate | 10 rad/s | [-1, 1] |
    | 1 | kick where above 0, with 5 m/s, if the ball is in the mouth | - | [-1, 1] |

    **Reward** per step. alpha is the angle between the posts seen from the robot, beta the larger of the
    angles from the heading to the posts, v the ball's speed; the robot faces the goal where alpha >= beta:

    | term | value | equation |
    | --- | --- | --- |
    | facing the goal | 0.05 (alpha - beta) v where it faces it, else (alpha - beta) v | 12 |
    | kick | +10 on the first step with a kick action, if facing | 13 |
    | waiting | -0.25 before the first kick action, and whenever not facing | 13 |
    | goal | +20 instead of all the above, on the step that ends in a goal | - |

    The goal term is only in the authors' code. A step that ends out of play earns 0. As in that code, the +10
    is paid for the kick action, with or without the ball or a goal. Turning with the ball by D costs about
    3.2 (D - alpha)^2 / 2 at any rate, while never kicking costs 0.25 per step, so not kicking is a local
    optimum.

    **Start**: x from 0.3 m to 0.3 m in front of the defence area, y at least 0.1 m inside the touch lines,
    heading in [-pi, pi), at rest; the ball is in the mouth, where the dribbler holds it after 3 steps of
    warm-up.

    **End**, checked in this order: terminated by a goal, which is success (the whole ball crosses the goal
    line between the posts, as :mod:`robobt.world.rules` decides it for matches); terminated out of play (the
    whole ball over a line of the field, its centre behind the halfway line, or the robot 0.2 m behind the
    halfway line, over a touch line or in the defence area); truncated after 100 steps (3 s).
    """

    terms = _SHOOT_TERMS
    Settings = ShootSettings
    played_by = "Shoot"
    timed = "kick_time"
    observation: ObservationSpec = SHOOT
    settings: ShootSettings

    def __init__(self, settings: ShootSettings | None = None, n: int = 1, seed: int | None = None) -> None:
        super().__init__(settings, n, seed)
        settings, field, weights = self.settings, self.settings.field, self.settings.reward
        self._goal = field.half_length, field.goal_width / 2
        # Commanded to robots that brake gently, in field coordinates [m/s].
        self._velocity = np.zeros((self.n, 2))
        firing_counts = weights.kick_counts == "fired"
        self._judged_by = parameters(
            _SHOOT_JUDGING, settings=settings, field=field, weights=weights, firing_counts=firing_counts
        )

    def sample(self, rng: np.random.Generator, count: int) -> FloatArray:
        """See :func:`~robobt.learning.envs.shoot.starts.shoot_starts`."""
        return shoot_starts(self.settings, rng, count)

    def observe(self, robots: FloatArray, balls: FloatArray) -> FloatArray:
        """See :data:`robobt.world.features.SHOOT`."""
        return shoot_rows(robots[:, 0], balls, *self._goal)

    def begin(self, starts: FloatArray, which: IntArray) -> None:
        """See :meth:`ArenaTask.begin`."""
        robots, _, _ = start_parts(starts, 1)
        self._velocity[which] = np.column_stack((robots["vx"][:, 0], robots["vy"][:, 0]))

    def _carried(self) -> FloatArray:
        """Return the commands, gentler if the settings say so.

        They are then as gentle as those of :class:`robobt.skills.Shoot` with a model that has a memory.
        """
        commands = super()._carried()
        if not self.settings.gentle:
            return commands
        # Turning and braking pull at the ball at right angles.
        held, period = self.settings.robot_limits.hold_acceleration * sqrt(0.5), self.settings.period
        gentle = commands.copy()
        rows, heading = gentle.view(COMMAND)[:, 0, 0], self.arenas.robots.view(ROBOT)["heading"][:, 0, 0]
        fastest = sqrt(held / TOUCH_DISTANCE)
        rows["omega"] = np.clip(rows["omega"], -fastest, fastest)
        # Braking follows from the commands alone: a late robot's own speed would let it brake too slowly.
        speed = np.maximum(np.hypot(*self._velocity.T), 1e-9)
        self._velocity *= np.maximum(1.0 - held * period / speed, 0.0)[:, None]
        (vx, vy), c, s = self._velocity.T, np.cos(heading), np.sin(heading)
        rows["vx"], rows["vy"] = c * vx + s * vy, c * vy - s * vx
        return gentle

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
        pull = np.inf if dribbler.kind == "glue" else _HOLDING_SHARE * held
        gain = steady_gain(self.settings.longest_delay)
        return partial(turn_and_kick, scaling=self.action, pull=pull, gain=gain)

    def skill(self) -> Skill:
        """See :meth:`ArenaTask.skill`."""
        return KickToTarget(target=self.settings.field.their_goal, kick_speed=self.action.kick_speed)

    def _judge(self, actions: FloatArray, rewards: FloatArray, ends: EpisodeEnds) -> bool:
        return _judge(self._judged_by, actions, report_of(self.arenas), self._ledger(rewards, ends))


@compiled_lean
def _judge(task_: FloatArray, actions_: FloatArray, report_: Report, ledger_: Ledger) -> bool:
    task: _ShootJudging = task_.view(_SHOOT_JUDGING)[0]
    arenas, ledger = Report(*report_), Ledger(*ledger_)
    robots, balls = arenas.robots.view(ROBOT)[..., 0], arenas.balls.view(BALL)[..., 0]
    episodes, terms = ledger.progress.view(PROGRESS)[..., 0], ledger.terms.view(_SHOOT_TERMS)[..., 0]
    actions, any_ended = actions_.view(_ACTION)[..., 0], False
    for i in range(len(balls)):
        if is_over(ledger, i):
            any_ended = True
            continue
        episode: EpisodeProgress = episodes[i]
        robot, ball, fired = robots[i, 0], balls[i], arenas.kicked[i, 0]
        begin_tick(episode, fired)
        goal = goal_of(episode, ball, task.field) > 0
        out = _left(task, robot, ball, episode)
        kick = fired if task.firing_counts else actions[i].kick > 0.0
        earned = reward(task.weights, task.field, robot, ball, kick, goal, out, episode, terms[i])
        if end_tick(ledger, i, earned, goal, out, task.settings.time_limit):
            any_ended = True
    return any_ended


@compilable
def _left(task: _ShootJudging, robot: Robot, ball: Ball, episode: EpisodeProgress) -> bool:
    """Return whether robot or ball have left the area of the task."""
    field, settings = task.field, task.settings
    half_length, half_width = field.length / 2, field.width / 2
    out = is_out(ball.x, ball.y, half_length, half_width) or ball.x < 0.0
    out = out or robot.x < _ROBOT_BACK_LIMIT or abs(robot.y) > half_width
    out = out or in_area(robot.x, robot.y, half_length, field.defense_depth, field.defense_width)
    if settings.lost_distance is not None and episode.kick_tick < 0:
        out = out or hypot(ball.x - robot.x, ball.y - robot.y) > settings.lost_distance
    return out
