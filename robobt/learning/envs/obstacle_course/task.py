"""Drive through courses of the obstacle challenge, judged by the challenge's own function."""

from __future__ import annotations

import numpy as np
from pydantic import Field

from robobt.challenges.obstacle_course import unseen
from robobt.challenges.obstacles import COURSE_TIME, REACHED
from robobt.challenges.touching import CourseTouch, touched
from robobt.config.validation import Settings
from robobt.learning.envs.arena_task import ArenaTask
from robobt.learning.envs.settings import TaskSettings
from robobt.learning.envs.starts import columns_of, places_of, start_parts
from robobt.learning.envs.task import BoolArray, FloatArray, IntArray
from robobt.learning.envs.tick import Tick
from robobt.models.actions import GO_TO_BALL_ACTION, ActionScaling
from robobt.plays.challenges.obstacle_run import OBSTACLE_TARGET
from robobt.sim import COMMAND
from robobt.skills.base import Skill
from robobt.skills.keep_clear import KeepClear
from robobt.world.observation import Seen, entries, own_observation

MOST_OBSTACLES = 10
"""Obstacles in an arena; a course with fewer has the others at its far end."""

_OBSTACLE_ACCELERATION = 1.0
"""Acceleration of a moving obstacle [m/s^2], as in the challenge."""

_PATROL_COLUMNS = tuple(
    f"{name}_{index}" for index in range(MOST_OBSTACLES) for name in ("to_x", "to_y", "pace")
)
"""Columns of a start after robots and ball: where each obstacle drives to and fro [m], and how fast [m/s]."""


def _far_places() -> FloatArray:
    places = [(-4.2, 0.5 * index - 2.25) for index in range(MOST_OBSTACLES)]
    return np.array(places)


def course_rows(seen: Seen) -> FloatArray:
    """Observe target, own velocity, corner of the area and obstacles, nearest first, from the robot."""
    me, others, field = seen.me, seen.opponents, seen.field
    order = np.argsort(np.hypot(others["x"] - me["x"][:, None], others["y"] - me["y"][:, None]), axis=1)
    corner = field.half_length - field.defense_depth, np.copysign(field.defense_width / 2.0, me["y"])
    columns = [
        *seen.in_frame_of_me(OBSTACLE_TARGET[0] - me["x"], OBSTACLE_TARGET[1] - me["y"]),
        *seen.in_frame_of_me(me["vx"], me["vy"]),
        *seen.in_frame_of_me(corner[0] - me["x"], corner[1] - me["y"]),
    ]
    for place in range(MOST_OBSTACLES):
        other = np.take_along_axis(others, order[:, place : place + 1], axis=1)[:, 0]
        columns += seen.in_frame_of_me(other["x"] - me["x"], other["y"] - me["y"])
        columns += seen.in_frame_of_me(other["vx"], other["vy"])
    return np.column_stack(columns)


OBSTACLE_COURSE = own_observation(
    "obstacle_course",
    1,
    *entries("target_x target_y", "m", "far", 2.0),
    *entries("vx vy", "m/s", "speed", "max_speed"),
    *entries("area_x area_y", "m", "far", 1.0),
    *(
        entry
        for index in range(MOST_OBSTACLES)
        for entry in (
            *entries(f"x_{index} y_{index}", "m", "far", 1.0),
            *entries(f"vx_{index} vy_{index}", "m/s", "speed", 1.0),
        )
    ),
)(course_rows)
"""What the robot observes, see :func:`course_rows`."""


class CourseReward(Settings):
    """Weights of the reward."""

    reached: float = Field(5.0, description="for the target")
    touch: float = Field(-5.0, description="for a touch, which ends the episode")
    nearer: float = Field(1.0, description="for each metre nearer to the target as the crow flies")
    time: float = Field(-0.2, description="for each second")


class ObstacleCourseSettings(TaskSettings):
    """The settings of the task."""

    action: ActionScaling = GO_TO_BALL_ACTION
    time_limit: int = Field(
        int(COURSE_TIME / 0.03), ge=1, le=100_000, description="ticks to the end of an episode"
    )
    reward: CourseReward = CourseReward()


class ObstacleCourseTask(ArenaTask):
    """Drive to the target of the obstacle challenge of 2025 and touch neither robots nor the defence area.

    Courses are drawn as for ``robobt challenge obstacles_unseen``, without a ball that is being placed and
    without the line between two robots, which no observation shows.
    """

    Settings = ObstacleCourseSettings
    settings: ObstacleCourseSettings
    observation = OBSTACLE_COURSE
    robots = 1 + MOST_OBSTACLES
    start_columns = (*columns_of(1 + MOST_OBSTACLES), *_PATROL_COLUMNS)
    _homes: FloatArray
    _ends: FloatArray
    _paces: FloatArray
    _back: BoolArray

    def sample(self, rng: np.random.Generator, count: int) -> FloatArray:
        """Draw courses, one row each."""
        rows = np.zeros((count, len(self.start_columns)))
        robots, balls, rest = start_parts(rows, self.robots)
        balls["x"], balls["y"] = -4.3, 2.8
        paths = rest.reshape(count, MOST_OBSTACLES, 3)
        for row in range(count):
            course = unseen(rng, placing=False)
            places = _far_places()
            standing = [one for one in course.obstacles if one.number != 3]
            places[: len(standing)] = [one.at for one in standing]
            robots[row]["x"][1:], robots[row]["y"][1:] = places.T
            robots[row]["x"][0], robots[row]["y"][0] = course.start
            paths[row, :, :2] = places
            for index, one in enumerate(standing):
                if one.to is not None:
                    paths[row, index] = (*one.to, one.speed)
        return rows

    def begin(self, starts: FloatArray, which: IntArray) -> None:
        """Read where the obstacles drive to and fro."""
        if not hasattr(self, "_homes"):
            self._homes = np.zeros((self.n, MOST_OBSTACLES, 2))
            self._ends, self._paces = self._homes.copy(), np.zeros((self.n, MOST_OBSTACLES))
            self._back = np.zeros((self.n, MOST_OBSTACLES), dtype=np.bool_)
        robots, _, rest = start_parts(np.ascontiguousarray(starts), self.robots)
        paths = rest.reshape(len(starts), MOST_OBSTACLES, 3)
        self._homes[which] = places_of(robots)[:, 1:]
        self._ends[which], self._paces[which] = paths[..., :2], paths[..., 2]
        self._back[which] = False

    def oppose(self, commands: FloatArray) -> None:
        """Drive the obstacles to and fro."""
        others = self.now.opponents
        here = places_of(others)
        target = np.where(self._back[..., None], self._homes, self._ends)
        way = target - here
        gap = np.linalg.norm(way, axis=2)
        self._back ^= (gap < 0.03) & (self._paces > 0.0)
        # It brakes in time, and speeds up from where it turned.
        speed = np.minimum(self._paces, np.sqrt(2.0 * _OBSTACLE_ACCELERATION * gap))
        wanted = way * (speed / np.maximum(gap, 1e-9))[..., None]
        now = np.stack((others["vx"], others["vy"]), axis=-1)
        most = _OBSTACLE_ACCELERATION * self.settings.period
        change = np.clip(wanted - now, -most, most)
        vx, vy = np.moveaxis(np.where(self._paces[..., None] > 0.0, now + change, 0.0), -1, 0)
        c, s = np.cos(others["heading"]), np.sin(others["heading"])
        orders = commands.view(COMMAND)[..., 0][:, 1:]
        orders["vx"], orders["vy"] = c * vx + s * vy, c * vy - s * vx

    def ends(self, tick: Tick) -> tuple[BoolArray, BoolArray]:
        """End an episode at the target, and at a touch."""
        touch = self.touches(tick)
        reached = (_gap(tick.now) <= REACHED) & (touch == CourseTouch.NOTHING)
        return reached, touch != CourseTouch.NOTHING

    def skill(self) -> Skill:
        """Return the skill of the challenge's own play."""
        return KeepClear(target=OBSTACLE_TARGET)

    def touches(self, tick: Tick) -> IntArray:
        """Return what each robot touches, by the function of the challenge's judge."""
        nothing = np.full((self.n, 2), np.nan)
        me, others = places_of(tick.now.me), places_of(tick.now.opponents)
        line = np.full((self.n, 2, 2), np.nan)
        return touched(me, others, nothing, nothing, line, self.settings.field)

    def reward(self, tick: Tick) -> dict[str, FloatArray]:
        """Return the terms of :class:`CourseReward`."""
        weights = self.settings.reward
        return {
            "reached": weights.reached * tick.success,
            "touch": weights.touch * tick.failed,
            "nearer": weights.nearer * (_gap(tick.before) - _gap(tick.now)),
            "time": np.full(self.n, weights.time * self.settings.period),
        }


def _gap(seen: Seen) -> FloatArray:
    """Return the distance to the target [m]."""
    x, y = OBSTACLE_TARGET
    gap: FloatArray = np.hypot(seen.me["x"] - x, seen.me["y"] - y)
    return gap
