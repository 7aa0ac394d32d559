"""Tasks behind Gymnasium's interfaces."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

import gymnasium
import numpy as np
from gymnasium.spaces import Box
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import ArrayLike, NDArray

from robobt.config.errors import one_line, short_repr
from robobt.learning.envs.arena_task import ArenaTask
from robobt.learning.envs.episodes import Episodes
from robobt.learning.envs.make import find_task, learners_of, make_rows, make_task
from robobt.learning.envs.per_robot import PerRobot
from robobt.learning.envs.settings import TaskSettings
from robobt.learning.envs.task import BoolArray, FloatArray
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import Point
from robobt.world.painting import Painter

Observation = NDArray[np.float32]
Picture = NDArray[np.uint8]
Action = NDArray[np.float32]
Info = dict[str, Any]

_TRAIL_LENGTH = 400

_INFO = {"is_success": "success", "time": "time", "optimum": "optimum", "kick_time": "kick_time"}
"""The infos of an ended episode, and their names in :class:`Episodes`."""


def settings_for(
    task: str, settings: TaskSettings | Mapping[str, object] | None, render_mode: str | None
) -> TaskSettings:
    """Return the settings of the named task; its defaults for None.

    Raises:
        KeyError: there is no such task.
        ValueError: there is no such render mode, or the settings are wrong.
    """
    if render_mode not in (None, "rgb_array"):
        raise ValueError(f"render_mode must be None or 'rgb_array', not {render_mode!r}")
    kind = find_task(task).Settings
    return kind() if settings is None else kind.model_validate(settings)


class _OverArenas:
    """The common part of both interfaces; ``task`` are the task's arenas."""

    task: ArenaTask | PerRobot
    _begun = False

    def _need_reset(self, what: str) -> None:
        need_reset(self._begun, what)

    def _picture(self, arena: int, *trails: Sequence[Point]) -> Picture:
        self._need_reset("render")
        return picture_of(self.task, arena, *trails)


def need_reset(begun: bool, what: str, over: bool = False) -> None:
    """Raise an error if there is no running episode.

    Raises:
        ResetNeeded: no episode has begun, or the last one is ``over``.
    """
    if over:
        raise gymnasium.error.ResetNeeded(f"the episode is over; call reset before {what}")
    if not begun:
        raise gymnasium.error.ResetNeeded(f"call reset before {what}")


def checked_action(action: ArrayLike, size: int, whose: str = "the action") -> FloatArray:
    """Return an action of ``size`` finite numbers, (size,); errors name it by ``whose``.

    Raises:
        ValueError: it is something else.
    """
    try:
        given = np.asarray(action, dtype=np.float64)
    except (TypeError, ValueError):
        raise ValueError(f"{whose} must be {size} numbers, not {one_line(short_repr(action))}") from None
    if given.size != size:
        raise ValueError(f"{whose} must have the shape {(size,)}, not {given.shape}")
    if not np.isfinite(given).all():
        raise ValueError(f"{whose} is not finite: {short_repr(given.tolist())}")
    return given.reshape(size)


@cache
def _painter(field: FieldGeometry, face: float) -> Painter:
    return Painter(field, face)


def picture_of(task: ArenaTask | PerRobot, arena: int, *trails: Sequence[Point]) -> Picture:
    """Return an arena as (height, width, 3) pixels; ``trails`` are as for :meth:`Painter.paint`."""
    settings, arenas = task.settings, task.arenas
    x, y = arenas.balls[arena, :2].tolist()
    robots = [
        (Team.BLUE if index < task.blue else Team.YELLOW, "", *pose)
        for index, pose in enumerate(arenas.robots[arena, :, :3].tolist())
    ]
    painter = _painter(settings.field, settings.simulator.body.face)
    return np.asarray(painter.paint(robots, (x, y), task.reach, *trails))


class TaskEnv(_OverArenas, gymnasium.Env[Observation, Action]):
    """One arena of a task behind Gymnasium's interface.

    Several learners form one agent: their observations and actions are concatenated, and the reward is their
    mean. :class:`~robobt.learning.envs.soccer.parallel.SoccerParallelEnv` has an agent for each learner.

    Args:
        task: name of the task.
        settings: the task's settings, or a mapping of their fields, as from a YAML file.
        render_mode: None or "rgb_array".

    Raises:
        KeyError: there is no such task.
        ValueError: the settings are wrong.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 33}  # noqa: RUF012

    def __init__(
        self,
        task: str,
        settings: TaskSettings | Mapping[str, object] | None = None,
        render_mode: str | None = None,
    ) -> None:
        self.task = make_task(settings_for(task, settings, render_mode), 1)
        self.render_mode = render_mode
        one, count = self.task.space, len(self.task.learners)
        self.observation_space = Box(np.tile(one.low, count), np.tile(one.high, count), dtype=np.float32)
        self.action_space = _action_space(self.task)
        self._over = False
        self._robot_trail: deque[Point] = deque(maxlen=_TRAIL_LENGTH)
        self._ball_trail: deque[Point] = deque(maxlen=_TRAIL_LENGTH)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, Info]:
        """Start an episode.

        Args:
            seed: seed of everything that follows; None continues the random numbers.
            options: ``{"start": (10,)}`` starts there instead of at a drawn
                place; columns ``robobt.learning.envs.START_COLUMNS``.

        Raises:
            ValueError: an unknown option, or an invalid start.
        """
        super().reset(seed=seed)
        start = _start_of(options)
        if start is not None:
            observation = self.task.reset_to(start, seed)
        elif seed is not None or not self._begun:
            observation = self.task.reset(seed)
        else:
            observation = self.task.restart()
        self._begun, self._over = True, False
        self._robot_trail.clear()
        self._ball_trail.clear()
        self._leave_trail()
        return observation[0].astype(np.float32), {}

    def step(self, action: Action) -> tuple[Observation, float, bool, bool, Info]:
        """Advance one control period; the last step's info has the episode's result.

        Its keys: ``is_success``, ``time`` [s], ``optimum`` (the straight line's
        time [s], nan without one), ``kick_time`` (nan without a kick [s]) and, for each term of the reward,
        ``reward/NAME``, its sum over the episode.

        Raises:
            ResetNeeded: no episode has begun, or it is over.
            ValueError: the action has another shape, or is not finite.
        """
        need_reset(self._begun, "step", self._over)
        result = self.task.advance(checked_action(action, self.task.action_size)[None])
        if self.render_mode is not None:
            self._leave_trail()
        ended = self.task.ended
        self._over = ended is not None
        return (
            result.observation[0].astype(np.float32),
            float(result.reward[0]),
            bool(result.terminated[0]),
            bool(result.truncated[0]),
            {} if ended is None else {key: values[0].item() for key, values in _told(ended).items()},
        )

    def render(self) -> Picture | None:
        """Draw the field as (height, width, 3) pixels in mode ``rgb_array``; None without a mode."""
        if self.render_mode is None:
            return None
        return self._picture(0, self._robot_trail, self._ball_trail)

    def _leave_trail(self) -> None:
        arenas = self.task.arenas
        for trail, (x, y, *_) in (
            (self._robot_trail, arenas.robots[0, 0]),
            (self._ball_trail, arenas.balls[0]),
        ):
            trail.append((float(x), float(y)))


class TaskVectorEnv(_OverArenas, VectorEnv[Observation, Action, Any]):
    """Many arenas in one simulator, with Gymnasium's vector interface.

    Each learner is a separate environment. An arena's learners are adjacent, and their episodes end together;
    each has its own reward. Otherwise it is like :class:`TaskEnv`.

    Args:
        task: name of the task.
        num_envs: number of learners in all arenas, a multiple of an arena's learners.
        settings: as for :class:`TaskEnv`.
        render_mode: None or "rgb_array", one picture per arena.

    Raises:
        KeyError: there is no such task.
        ValueError: the settings are wrong, or ``num_envs`` does not fill whole arenas.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012 - Gymnasium declares it so
        "render_modes": ["rgb_array"],
        "render_fps": 33,
        "autoreset_mode": AutoresetMode.SAME_STEP,
    }

    def __init__(
        self,
        task: str,
        num_envs: int = 1,
        settings: TaskSettings | Mapping[str, object] | None = None,
        render_mode: str | None = None,
    ) -> None:
        own = settings_for(task, settings, render_mode)
        if num_envs % learners_of(own):
            raise ValueError(
                f"num_envs must be a multiple of the arena's {learners_of(own)} learners, not {num_envs}"
            )
        self.task = make_rows(own, num_envs)
        self.render_mode = render_mode
        self.single_observation_space = self.task.space
        self.single_action_space = _action_space(self.task)
        self.num_envs = num_envs
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, Info]:
        """Start all episodes in a new simulator.

        Args:
            seed: one seed for all arenas and everything that follows.
            options: ``{"start": (m, 10)}`` uses these starts first.

        Raises:
            ValueError: an unknown option, or invalid starts.
        """
        super().reset(seed=seed)
        start = _start_of(options)
        observation = self.task.reset(seed) if start is None else self.task.reset_to(start, seed)
        self._begun = True
        return observation.astype(np.float32), {}

    def step(self, actions: Action) -> tuple[Observation, FloatArray, BoolArray, BoolArray, Info]:
        """Advance one control period; an episode that ends restarts in the same step.

        If any episode has ended, the infos have ``final_obs`` (n, O) and ``final_info`` with the single
        environment's keys as arrays (n,); ``_final_obs`` and ``_final_info`` (n,) mark the valid entries.
        """
        self._need_reset("step")
        result = self.task.step(np.asarray(actions, dtype=np.float64))
        infos: Info = {}
        if self.task.ended is not None:
            ended = result.terminated | result.truncated
            infos = {
                "final_obs": result.final_observation.astype(np.float32),
                "_final_obs": ended,
                "final_info": _spread(self.task.ended, ended),
                "_final_info": ended.copy(),
            }
        return (
            result.observation.astype(np.float32),
            result.reward,
            result.terminated,
            result.truncated,
            infos,
        )

    def render(self) -> tuple[Picture, ...] | None:
        """Draw one picture per arena in mode ``rgb_array`` and return them; None without a mode."""
        if self.render_mode is None:
            return None
        return tuple(self._picture(arena) for arena in range(len(self.task.arenas.balls)))


def _action_space(task: ArenaTask | PerRobot) -> Box[np.float32]:
    return Box(-1.0, 1.0, (task.action_size,), np.float32)


def _start_of(options: Mapping[str, Any] | None) -> ArrayLike | None:
    unknown = set(options or ()) - {"start"}
    if unknown:
        raise ValueError(f"reset has no option {', '.join(sorted(map(repr, unknown)))}; there is 'start'")
    return (options or {}).get("start")


def _told(episodes: Episodes) -> dict[str, NDArray[Any]]:
    """Return the infos of ended episodes."""
    terms = {f"reward/{name}": episodes.terms[name] for name in episodes.terms.dtype.names or ()}
    return {key: getattr(episodes, name) for key, name in _INFO.items()} | terms


def _spread(episodes: Episodes, ended: BoolArray) -> Info:
    info: Info = {}
    for key, values in _told(episodes).items():
        whole = np.zeros(len(ended), dtype=values.dtype)
        whole[ended] = values
        info[key] = whole
        info[f"_{key}"] = ended.copy()
    return info
