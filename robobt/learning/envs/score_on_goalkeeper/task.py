"""Score-On-Goalkeeper over many arenas."""

from __future__ import annotations

from functools import partial
from math import hypot, isnan, nan
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
from robobt.learning.envs.score_on_goalkeeper.rewards import ScoreReward, ScoreTerms, end_reward, reward
from robobt.learning.envs.score_on_goalkeeper.settings import ScoreOnGoalkeeperSettings
from robobt.learning.envs.score_on_goalkeeper.starts import SCORE_START_COLUMNS, score_starts
from robobt.learning.envs.scripted import drive_and_kick, steady_gain
from robobt.learning.envs.task import BoolArray, EpisodeEnds, FloatArray, IntArray
from robobt.learning.envs.task_parts import Policy
from robobt.learning.opponents.keepers import GOALKEEPER_TRAITS, Keepers
from robobt.world.compiled import compilable, compiled_lean, record_dtype
from robobt.world.features import ObservationSpec
from robobt.world.field import FieldGeometry
from robobt.world.records import BALL, ROBOT, Ball, Robot
from robobt.world.rules import in_area, is_out
from robobt.world.scoring import SCORE_ON_GOALKEEPER, score_on_goalkeeper_rows
from robobt.world.state import ROBOT_RADIUS

_ATTACKER, _KEEPER = 0, 1
"""Indices of the robots."""


class _ScoreJudging(Protocol):
    """Parameters for judging a tick."""

    settings: ScoreOnGoalkeeperSettings
    field: FieldGeometry
    weights: ScoreReward


_SCORE_JUDGING, _SCORE_TERMS = record_dtype(_ScoreJudging), record_dtype(ScoreTerms)


class ScoreOnGoalkeeperTask(ArenaTask):
    """Get the ball and score on a goalkeeper.

    The values below are the defaults of :class:`~robobt.learning.envs.ScoreOnGoalkeeperSettings`, where all
    of them can be changed.

    One step is a decision that holds for two control periods of 30 ms, each of 4 physics steps. The
    dribbler is on all the time and holds the ball with limited force.

    **Observation**, float32, :data:`robobt.world.scoring.SCORE_ON_GOALKEEPER`; the frame is the robot's, x
    ahead and y to its left; velocities are relative to the field:

    | entry | meaning | unit |
    | --- | --- | --- |
    | 0, 1, 2 | the robot's velocity and turning rate | m/s, rad/s |
    | 3, 4 | position of the ball | m |
    | 5, 6 | its velocity | m/s |
    | 7, 8 | sine and cosine of the angle from the heading to the middle of the goal | 1 |
    | 9, 10 | position of the goal's left post | m |
    | 11, 12 | that of the right one | m |
    | 13, 14 | position of the goalkeeper | m |
    | 15, 16 | its velocity | m/s |
    | 17 | where a kick would cross the goal line, from its middle, at most 1 m either way | m |
    | 18 | how far to the left of that shot the goalkeeper is, at most 0.5 m either way | m |

    **Action**, float32, :data:`robobt.models.actions.SCORE_ACTION`:

    | entry | meaning | of 1 | range |
    | --- | --- | --- | --- |
    | 0, 1 | velocity ahead and to the left, shortened to 3 m/s together | 3 m/s | [-1, 1] |
    | 2 | turning rate | 6 rad/s | [-1, 1] |
    | 3 | kick where above 0, with 6 m/s, if the ball is in the mouth | - | [-1, 1] |

    **Goalkeeper**: drawn for each episode, with a top speed of 1 to 3 m/s and a place 0.12 to 0.6 m in front
    of the line. There are four kinds, which before a shot follow the ball, the line from ball to goal, or the
    attacker's heading, or come out towards the ball (:mod:`robobt.learning.opponents.keepers`). The shipped
    play ``goalkeeper`` is the kind ``shipped``. It is left out of training, so that it can be used in
    evaluations.

    **Reward** per period of 30 ms; the weights are in
    :class:`~robobt.learning.envs.score_on_goalkeeper.rewards.ScoreReward`:

    | term | value |
    | --- | --- |
    | goal | 5 on a goal |
    | lost | -0.5 where the episode ends without one |
    | time | -0.005 |
    | aimed | 0.1 on a kick between the posts |
    | unreached | up to 2 on such a kick: a quarter where it just passes out of the goalkeeper's reach, diving at 6 m/s^2, all of it 0.23 m farther off, nothing 0.08 m nearer |
    | miss | -0.2 on a kick that will not go between the posts |
    | approach, advance, facing | what the state is worth more than the one before, but for a shot on its way: -0.5 for each metre from robot to ball, -0.6 for each from robot to goal down to 1.5 m, 0.5 (1 + cos) of the heading to the goal with the ball in the mouth |

    **Start**: the attacker is in the attacked half, up to 0.4 m in front of the defence area, more often near
    the goal and turned towards it. In six of ten episodes the ball is in its mouth; otherwise it is anywhere
    there, at up to 0.5 m/s.

    **End**: terminated by a goal, which is success; terminated by a ball over a line, a ball that the
    goalkeeper has held for 8 periods or that rests where the goalkeeper may take it, and by an attacker in
    the defence area, or partly inside with the ball; truncated after 334 periods (10 s).
    """  # noqa: E501 - a table's row is a line

    terms = _SCORE_TERMS
    Settings = ScoreOnGoalkeeperSettings
    played_by = "Score"
    observation: ObservationSpec = SCORE_ON_GOALKEEPER
    robots = 2
    start_columns = SCORE_START_COLUMNS
    settings: ScoreOnGoalkeeperSettings

    def __init__(
        self, settings: ScoreOnGoalkeeperSettings | None = None, n: int = 1, seed: int | None = None
    ) -> None:
        super().__init__(settings, n, seed)
        field = self.settings.field
        self._goal = field.half_length, field.goal_width / 2
        self._judged_by = parameters(
            _SCORE_JUDGING, settings=self.settings, field=field, weights=self.settings.reward
        )

    def sample(self, rng: np.random.Generator, count: int) -> FloatArray:
        """See :func:`~robobt.learning.envs.score_on_goalkeeper.starts.score_starts`."""
        return score_starts(self.settings, rng, count)

    def observe(self, robots: FloatArray, balls: FloatArray) -> FloatArray:
        """See :data:`robobt.world.scoring.SCORE_ON_GOALKEEPER`."""
        return score_on_goalkeeper_rows(robots, balls, *self._goal)

    @property
    def ranges(self) -> dict[str, float]:
        """See :attr:`ArenaTask.ranges`."""
        settings, noise = self.settings, self.settings.noise
        limits, starts = settings.robot_limits, settings.starts
        far, fastest = farthest(settings), limits.max_speed * max(settings.randomisation.top_speed)
        driven = max(min(fastest, settings.action.max_speed), *starts.robot_speed) + BUMP
        turned = min(limits.max_turn, settings.action.max_turn) + driven / ROBOT_RADIUS
        # A moving, turning robot can add at most this speed to a kicked ball.
        kicked = settings.simulator.kicker.max_speed + driven + turned * ROBOT_RADIUS + BUMP
        keeper = settings.simulator.limits.max_speed + BUMP
        return {
            "far": far,
            "goal": far + settings.field.goal_width,
            "speed": seen_speed(settings, driven, noise.robot_position),
            "turn": seen_turn(settings, turned),
            "ball_speed": seen_speed(settings, max(kicked, *starts.ball_speed), noise.ball_position),
            "keeper_speed": seen_speed(settings, keeper, noise.robot_position),
        }

    def script(self) -> Policy:
        """See :meth:`ArenaTask.script`."""
        return partial(drive_and_kick, scaling=self.action, gain=steady_gain(self.settings.longest_delay))

    def _build(self) -> None:
        settings = self.settings
        self._keepers = Keepers(settings.field, settings.simulator.limits, settings.period, self.n)
        super()._build()

    def begin(self, starts: FloatArray, which: IntArray) -> None:
        """See :meth:`ArenaTask.begin`."""
        self._keepers.restart(which, starts[:, -len(GOALKEEPER_TRAITS) :])

    def oppose(self, commands: FloatArray) -> None:
        """See :meth:`ArenaTask.oppose`."""
        arenas = self.arenas
        self._keepers.decide(arenas.robots, arenas.balls, arenas.contact, commands)

    def _judge(self, actions: FloatArray, rewards: FloatArray, ends: EpisodeEnds) -> bool:  # noqa: ARG002
        return _judge(
            self._judged_by, self._keepers.kept, report_of(self.arenas), self._ledger(rewards, ends)
        )


@compiled_lean
def _judge(task_: FloatArray, kept: BoolArray, report_: Report, ledger_: Ledger) -> bool:
    task: _ScoreJudging = task_.view(_SCORE_JUDGING)[0]
    arenas, ledger = Report(*report_), Ledger(*ledger_)
    robots, balls = arenas.robots.view(ROBOT)[..., 0], arenas.balls.view(BALL)[..., 0]
    episodes, terms = ledger.progress.view(PROGRESS)[..., 0], ledger.terms.view(_SCORE_TERMS)[..., 0]
    settings = task.settings
    any_ended = False
    for i in range(len(balls)):
        if is_over(ledger, i):
            any_ended = True
            continue
        episode: EpisodeProgress = episodes[i]
        robot, keeper, ball = robots[i, _ATTACKER], robots[i, _KEEPER], balls[i]
        held, fired = arenas.contact[i, _ATTACKER], arenas.kicked[i, _ATTACKER]
        begin_tick(episode, fired)
        episode.ticks_held = episode.ticks_held + 1 if arenas.contact[i, _KEEPER] else 0.0
        goal = goal_of(episode, ball, task.field) > 0
        lost = kept[i] or (settings.saved and arenas.touch[i] == _KEEPER)
        lost = _breaks_a_rule(task, robot, ball, held, episode) or lost
        lost = lost and not goal
        earned = reward(task.weights, task.field, robot, keeper, ball, held, fired, episode, terms[i])
        earned += end_reward(task.weights, goal, lost, terms[i])
        if end_tick(ledger, i, earned, goal, lost, settings.time_limit):
            any_ended = True
    return any_ended


@compilable
def _breaks_a_rule(
    task: _ScoreJudging, robot: Robot, ball: Ball, held: bool, episode: EpisodeProgress
) -> bool:
    """Track the carried distance; return whether the ball is out or the attacker breaks a rule."""
    field, settings = task.field, task.settings
    half_length, half_width = field.length / 2, field.width / 2
    depth, width = field.defense_depth, field.defense_width
    lost = is_out(ball.x, ball.y, half_length, half_width) or episode.ticks_held >= settings.held_by_keeper
    # By the rules the attacker must not touch the ball while even partly inside their defence area.
    lost = lost or in_area(robot.x, robot.y, half_length, depth, width)
    lost = lost or (held and in_area(robot.x, robot.y, half_length, depth, width, ROBOT_RADIUS))
    if not held:
        episode.carried_x = episode.carried_y = nan
    elif isnan(episode.carried_x):
        episode.carried_x, episode.carried_y = ball.x, ball.y
    elif settings.dribbling is not None:
        way = hypot(ball.x - episode.carried_x, ball.y - episode.carried_y)
        lost = lost or way > settings.dribbling
    return lost
