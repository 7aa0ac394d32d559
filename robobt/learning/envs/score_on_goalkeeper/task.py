"""Score-On-Goalkeeper over many arenas."""

from __future__ import annotations

from math import hypot, isnan, nan

import numpy as np

from robobt.learning.envs.arena_task import ArenaTask
from robobt.learning.envs.bounds import BUMP, farthest, seen_speed, seen_turn
from robobt.learning.envs.judging import begin_tick, end_tick, goal_of, is_over
from robobt.learning.envs.progress import PROGRESS, Progress
from robobt.learning.envs.score_on_goalkeeper.rewards import ScoreReward, ScoreTerms, reward
from robobt.learning.envs.score_on_goalkeeper.settings import ScoreOnGoalkeeperSettings
from robobt.learning.envs.score_on_goalkeeper.starts import COLUMNS, score_starts
from robobt.learning.envs.task import BoolArray, FloatArray, IntArray
from robobt.learning.opponents.keepers import TRAITS, Keepers
from robobt.world.compiled import compiled, numbers_dtype, numbers_of, record_dtype
from robobt.world.features import ObservationSpec
from robobt.world.field import FieldGeometry
from robobt.world.rules import in_area, is_out
from robobt.world.scoring import SCORE_ON_GOALKEEPER, score_on_goalkeeper_rows
from robobt.world.state import ROBOT_RADIUS

_SETTINGS, _FIELD = numbers_dtype(ScoreOnGoalkeeperSettings), numbers_dtype(FieldGeometry)
_WEIGHTS, _TERMS = numbers_dtype(ScoreReward), record_dtype(ScoreTerms)


class ScoreOnGoalkeeperTask(ArenaTask):
    """Get the ball and score; :class:`~robobt.learning.envs.ScoreOnGoalkeeperEnv` is the specification."""

    terms = _TERMS
    Settings = ScoreOnGoalkeeperSettings
    played_by = "Score"
    observation: ObservationSpec = SCORE_ON_GOALKEEPER
    robots = 2
    start_columns = COLUMNS
    settings: ScoreOnGoalkeeperSettings

    def __init__(
        self, settings: ScoreOnGoalkeeperSettings | None = None, n: int = 1, seed: int | None = None
    ) -> None:
        super().__init__(settings, n, seed)
        field = self.settings.field
        self._goal = field.half_length, field.goal_width / 2
        self._field = numbers_of(field)
        self._weights = numbers_of(self.settings.reward)

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
        far, fastest = farthest(settings), limits.max_speed * settings.randomisation.top_speed[1]
        driven = max(min(fastest, settings.action.max_speed), starts.robot_speed[1]) + BUMP
        turned = min(limits.max_turn, settings.action.max_turn) + driven / ROBOT_RADIUS
        # A ball comes off a robot that drives and turns at most so much faster than it was kicked.
        kicked = settings.simulator.kicker.max_speed + driven + turned * ROBOT_RADIUS + BUMP
        keeper = settings.simulator.limits.max_speed + BUMP
        return {
            "far": far,
            "goal": far + settings.field.goal_width,
            "speed": seen_speed(settings, driven, noise.robot_position),
            "turn": seen_turn(settings, turned),
            "ball_speed": seen_speed(settings, max(kicked, starts.ball_speed[1]), noise.ball_position),
            "keeper_speed": seen_speed(settings, keeper, noise.robot_position),
        }

    def _build(self) -> None:
        settings = self.settings
        self._keepers = Keepers(settings.field, settings.simulator.limits, settings.period, self.n)
        super()._build()

    def begin(self, starts: FloatArray, which: IntArray) -> None:
        """See :meth:`ArenaTask.begin`."""
        self._keepers.restart(which, starts[:, -len(TRAITS) :])

    def oppose(self, commands: FloatArray) -> None:
        """See :meth:`ArenaTask.oppose`."""
        arenas = self.arenas
        self._keepers.decide(arenas.robots, arenas.balls, arenas.contact, commands[:, 1])

    def _judge(self, actions: FloatArray, rewards: FloatArray, ends: BoolArray) -> bool:  # noqa: ARG002
        arenas = self.arenas
        return _judge(
            self._numbers,
            self._field,
            self._weights,
            arenas.robots,
            arenas.balls,
            arenas.contact,
            arenas.kicked,
            arenas.touch,
            self._keepers.kept,
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
    robots: FloatArray,
    balls: FloatArray,
    contact: BoolArray,
    kicked: BoolArray,
    touch: IntArray,
    kept: BoolArray,
    progress: FloatArray,
    terms_: FloatArray,
    rewards: FloatArray,
    ends: BoolArray,
) -> bool:
    settings: ScoreOnGoalkeeperSettings = settings_.view(_SETTINGS)[0]
    field: FieldGeometry = field_.view(_FIELD)[0]
    weights: ScoreReward = weights_.view(_WEIGHTS)[0]
    episodes, terms = progress.view(PROGRESS), terms_.view(_TERMS)
    half_length, half_width, post = field.length / 2, field.width / 2, field.goal_width / 2
    depth, width = field.defense_depth, field.defense_width
    any_ended = False
    for i in range(len(balls)):
        if is_over(ends, i):
            any_ended = True
            continue
        robot, ball, held, fired = robots[i, 0], balls[i], contact[i, 0], kicked[i, 0]
        episode: Progress = episodes[i, 0]
        begin_tick(episode, fired)
        episode.ticks_held = episode.ticks_held + 1 if contact[i, 1] else 0.0
        goal = goal_of(episode, ball, half_length, half_width, post) > 0
        lost = is_out(ball[0], ball[1], half_length, half_width) or kept[i]
        lost = lost or episode.ticks_held >= settings.held_by_keeper or (settings.saved and touch[i] == 1)
        # The rules: no touching the ball in their defence area, not even partly inside.
        lost = lost or in_area(robot[0], robot[1], half_length, depth, width)
        lost = lost or (held and in_area(robot[0], robot[1], half_length, depth, width, ROBOT_RADIUS))
        if not held:
            episode.carried_x = episode.carried_y = nan
        elif isnan(episode.carried_x):
            episode.carried_x, episode.carried_y = ball[0], ball[1]
        elif settings.dribbling is not None:
            way = hypot(ball[0] - episode.carried_x, ball[1] - episode.carried_y)
            lost = lost or way > settings.dribbling
        lost = lost and not goal
        posts = half_length, post
        earned = reward(weights, posts, robots[i], ball, held, fired, goal, lost, episode, terms[i, 0])
        if end_tick(episode, earned, goal, lost, settings.time_limit, i, rewards, ends):
            any_ended = True
    return any_ended
