"""The environments behind Gymnasium's interfaces, whatever the task."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, Protocol

import gymnasium
import numpy as np
from gymnasium.spaces import Box
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import ArrayLike, NDArray

from robobt.config.errors import one_line, short_repr
from robobt.learning.envs.episodes import Episodes
from robobt.learning.envs.settings import TaskSettings
from robobt.learning.envs.task import BoolArray, FloatArray, StepResult
from robobt.sim.arenas import Arenas
from robobt.world.field import FieldGeometry
from robobt.world.game import Team
from robobt.world.geometry import Point
from robobt.world.painting import Painter

Observation = NDArray[np.float32]
Picture = NDArray[np.uint8]
Action = NDArray[np.float32]
Info = dict[str, Any]

_TRAIL = 400

_INFO = {"is_success": "success", "time": "time", "optimum": "optimum", "kick_time": "kick_time"}
"""What the infos say of an episode that has ended, and where :class:`Episodes` has it."""


class Stepped(Protocol):
    """What the interfaces need: a :class:`~robobt.learning.envs.arena_task.ArenaTask`, or one like it."""

    n: int
    blue: int
    action_size: int

    @property
    def settings(self) -> TaskSettings:
        """Of the task."""

    @property
    def arenas(self) -> Arenas:
        """The simulator."""

    @property
    def ended(self) -> Episodes | None:
        """The episodes that the last step ended; None without any."""

    def reset(self, seed: int | None = None) -> FloatArray:
        """See :meth:`ArenaTask.reset`."""

    def reset_to(self, starts: ArrayLike, seed: int | None = None) -> FloatArray:
        """See :meth:`ArenaTask.reset_to`."""

    def restart(self) -> FloatArray:
        """See :meth:`ArenaTask.restart`."""

    def step(self, actions: FloatArray) -> StepResult:
        """See :meth:`ArenaTask.step`."""

    def advance(self, actions: FloatArray) -> StepResult:
        """See :meth:`ArenaTask.advance`."""


def _nowhere(_: TaskSettings) -> None:
    return None


@dataclass(frozen=True)
class EnvKind:
    """What Gymnasium has to know of a task.

    Attributes:
        task: makes so many arenas with given settings; None for the task's defaults.
        settings: their class.
        space: the observations of an arena with such settings.
        reach: distance at which the ball counts as reached, for pictures [m]; None for none.
    """

    task: Callable[[Any, int], Stepped]
    settings: type[TaskSettings]
    space: Callable[[Any], Box[np.float32]]
    reach: Callable[[Any], float | None] = _nowhere


class _OverArenas:
    """What both interfaces do with the arenas of a task."""

    kind: EnvKind

    def _set_up(
        self, settings: TaskSettings | Mapping[str, object] | None, n: int, render_mode: str | None
    ) -> Box[np.float32]:
        """Make the arenas and return the space of one of them's observations."""
        if render_mode not in (None, "rgb_array"):
            raise ValueError(f"render_mode must be None or 'rgb_array', not {render_mode!r}")
        given = None if settings is None else self.kind.settings.model_validate(settings)
        self.render_mode = render_mode
        self.task = self.kind.task(given, n)
        self._reach = self.kind.reach(self.task.settings)
        self._begun = False
        return self.kind.space(self.task.settings)

    def _need_reset(self, what: str) -> None:
        need_reset(self._begun, what)

    def _picture(self, arena: int, *trails: Sequence[Point]) -> Picture:
        self._need_reset("render")
        return picture_of(self.task, arena, self._reach, *trails)


def need_reset(begun: bool, what: str, over: bool = False) -> None:
    """Raise where a call needs an episode and there is none.

    Raises:
        ResetNeeded: none has begun, or the last one is ``over``.
    """
    if over:
        raise gymnasium.error.ResetNeeded(f"the episode is over; call reset before {what}")
    if not begun:
        raise gymnasium.error.ResetNeeded(f"call reset before {what}")


def checked_action(action: ArrayLike, size: int, whose: str = "the action") -> FloatArray:
    """Return an action of ``size`` finite numbers, (size,); ``whose`` it is stands in the error.

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


def picture_of(task: Stepped, arena: int, reach: float | None = None, *trails: Sequence[Point]) -> Picture:
    """Return an arena as (height, width, 3) pixels; the rest is as for :meth:`Painter.paint`."""
    settings, arenas = task.settings, task.arenas
    x, y = arenas.balls[arena, :2].tolist()
    robots = [
        (Team.BLUE if index < task.blue else Team.YELLOW, "", *pose)
        for index, pose in enumerate(arenas.robots[arena, :, :3].tolist())
    ]
    painter = _painter(settings.field, settings.simulator.body.face)
    return np.asarray(painter.paint(robots, (x, y), reach, *trails))


class SingleEnv(_OverArenas, gymnasium.Env[Observation, Action]):
    """One arena behind Gymnasium's interface; arguments as in the environments themselves."""

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 33}  # noqa: RUF012

    def __init__(
        self, settings: TaskSettings | Mapping[str, object] | None = None, render_mode: str | None = None
    ) -> None:
        self.observation_space = self._set_up(settings, 1, render_mode)
        self.action_space = _action_space(self.task)
        self._over = False
        self._robot_trail: deque[Point] = deque(maxlen=_TRAIL)
        self._ball_trail: deque[Point] = deque(maxlen=_TRAIL)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, Info]:
        """Start an episode.

        Args:
            seed: fixes all that follows; without one, the random numbers go on.
            options: ``{"start": (10,)}`` starts there instead of at a drawn
                place; columns ``robobt.learning.envs.START_COLUMNS``.

        Raises:
            ValueError: an unknown option, or a start that is none.
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
        """Let one control period pass; the last step's info holds what became of the episode.

        Its keys: ``is_success``, ``time`` [s], ``optimum`` (the straight line's
        time [s], nan without one), ``kick_time`` (nan without a kick [s]).

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
            {} if ended is None else {key: getattr(ended, name)[0].item() for key, name in _INFO.items()},
        )

    def render(self) -> Picture | None:
        """Draw the field as (height, width, 3) pixels in mode ``rgb_array``; None without a mode."""
        if self.render_mode is None:
            return None
        return self._picture(0, self._robot_trail, self._ball_trail)

    def _leave_trail(self) -> None:
        arenas = self.task.arenas
        self._robot_trail.append((float(arenas.robots[0, 0, 0]), float(arenas.robots[0, 0, 1])))
        self._ball_trail.append((float(arenas.balls[0, 0]), float(arenas.balls[0, 1])))


class ManyEnv(_OverArenas, VectorEnv[Observation, Action, Any]):
    """Many arenas in one simulator behind Gymnasium's vector interface."""

    metadata: dict[str, Any] = {  # noqa: RUF012 - Gymnasium declares it so
        "render_modes": ["rgb_array"],
        "render_fps": 33,
        "autoreset_mode": AutoresetMode.SAME_STEP,
    }

    def __init__(
        self,
        num_envs: int = 1,
        settings: TaskSettings | Mapping[str, object] | None = None,
        render_mode: str | None = None,
    ) -> None:
        self.single_observation_space = self._set_up(settings, num_envs, render_mode)
        self.single_action_space = _action_space(self.task)
        self.num_envs = num_envs
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, Info]:
        """Start all episodes in a new simulator.

        Args:
            seed: one number for all arenas together; fixes all that follows.
            options: ``{"start": (m, 10)}`` hands these starts out first.

        Raises:
            ValueError: an unknown option, or starts that are none.
        """
        super().reset(seed=seed)
        start = _start_of(options)
        observation = self.task.reset(seed) if start is None else self.task.reset_to(start, seed)
        self._begun = True
        return observation.astype(np.float32), {}

    def step(self, actions: Action) -> tuple[Observation, FloatArray, BoolArray, BoolArray, Info]:
        """Let one control period pass; an episode that ends starts anew in the same step.

        Where one has ended the infos hold ``final_obs`` (n, O) and ``final_info``
        with the single environment's keys as arrays (n,), and which of them count
        in ``_final_obs`` and ``_final_info`` (n,).
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
        """Draw one picture an arena in mode ``rgb_array``; None without a mode."""
        if self.render_mode is None:
            return None
        return tuple(self._picture(arena) for arena in range(len(self.task.arenas.balls)))


def _action_space(task: Stepped) -> Box[np.float32]:
    return Box(-1.0, 1.0, (task.action_size,), np.float32)


def _start_of(options: Mapping[str, Any] | None) -> ArrayLike | None:
    unknown = set(options or ()) - {"start"}
    if unknown:
        raise ValueError(f"reset has no option {', '.join(sorted(map(repr, unknown)))}; there is 'start'")
    return (options or {}).get("start")


def _spread(episodes: Episodes, ended: BoolArray) -> Info:
    info: Info = {}
    for key, name in _INFO.items():
        values = getattr(episodes, name)
        whole = np.zeros(len(ended), dtype=values.dtype)
        whole[ended] = values
        info[key] = whole
        info[f"_{key}"] = ended.copy()
    return info
