"""The environments behind Gymnasium's interfaces, whatever the task."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from typing import Any

import gymnasium
import numpy as np
from gymnasium.spaces import Box
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import ArrayLike, NDArray

from robobt.learning.envs.arena_task import ArenaTask
from robobt.learning.envs.episodes import Episodes
from robobt.learning.envs.render import Picture, Renderer
from robobt.learning.envs.task import BoolArray, FloatArray
from robobt.world.geometry import Point

Observation = NDArray[np.float32]
Action = NDArray[np.float32]
Info = dict[str, Any]

_TRAIL = 400


class SingleEnv(gymnasium.Env[Observation, Action]):
    """One arena behind Gymnasium's interface.

    Args:
        task: with that one arena.
        observation_space: of it.
        render_mode: None or "rgb_array".
        reach: distance at which the ball counts as reached, for the picture [m].
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 33}  # noqa: RUF012

    def __init__(
        self,
        task: ArenaTask,
        observation_space: Box[np.float32],
        render_mode: str | None,
        reach: float | None = None,
    ) -> None:
        _check_render_mode(render_mode)
        self.render_mode = render_mode
        self.task = task
        self.observation_space = observation_space
        self.action_space = _action_space(task)
        self._reach = reach
        self._begun = False
        self._renderer: Renderer | None = None
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
        self._begun = True
        self._robot_trail.clear()
        self._ball_trail.clear()
        self._leave_trail()
        return observation[0].astype(np.float32), {}

    def step(self, action: Action) -> tuple[Observation, float, bool, bool, Info]:
        """Let one control period pass; the last step's info holds what became of the episode.

        Its keys: ``is_success``, ``time`` [s], ``optimum`` (the straight line's
        time [s], nan without one), ``kick_time`` (nan without a kick [s]).
        """
        if not self._begun:
            raise gymnasium.error.ResetNeeded("call reset before step")
        result = self.task.advance(np.asarray(action, dtype=np.float64).reshape(1, -1))
        if self.render_mode is not None:
            self._leave_trail()
        return (
            result.observation[0].astype(np.float32),
            float(result.reward[0]),
            bool(result.terminated[0]),
            bool(result.truncated[0]),
            {} if self.task.ended is None else _episode_info(self.task.ended),
        )

    def render(self) -> Picture | None:
        """Draw the field as (height, width, 3) pixels in mode ``rgb_array``; None without a mode."""
        if self.render_mode is None:
            return None
        if not self._begun:
            raise gymnasium.error.ResetNeeded("call reset before render")
        if self._renderer is None:
            self._renderer = _renderer(self.task)
        arenas = self.task.arenas
        return self._renderer.draw(
            arenas.robots[0, 0], arenas.balls[0], self._reach, self._robot_trail, self._ball_trail
        )

    def _leave_trail(self) -> None:
        arenas = self.task.arenas
        self._robot_trail.append((float(arenas.robots[0, 0, 0]), float(arenas.robots[0, 0, 1])))
        self._ball_trail.append((float(arenas.balls[0, 0]), float(arenas.balls[0, 1])))


class ManyEnv(VectorEnv[Observation, Action, Any]):
    """Many arenas in one simulator behind Gymnasium's vector interface.

    Args:
        task: with these arenas.
        observation_space: of one of them.
        render_mode: None or "rgb_array".
        reach: distance at which the ball counts as reached, for the pictures [m].
    """

    metadata: dict[str, Any] = {  # noqa: RUF012 - Gymnasium declares it so
        "render_modes": ["rgb_array"],
        "render_fps": 33,
        "autoreset_mode": AutoresetMode.SAME_STEP,
    }

    def __init__(
        self,
        task: ArenaTask,
        observation_space: Box[np.float32],
        render_mode: str | None,
        reach: float | None = None,
    ) -> None:
        _check_render_mode(render_mode)
        self.render_mode = render_mode
        self.task = task
        self.num_envs = task.n
        self.single_observation_space = observation_space
        self.single_action_space = _action_space(task)
        self._reach = reach
        self.observation_space = batch_space(self.single_observation_space, task.n)
        self.action_space = batch_space(self.single_action_space, task.n)
        self._begun = False
        self._renderer: Renderer | None = None

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
        if not self._begun:
            raise gymnasium.error.ResetNeeded("call reset before step")
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
        if not self._begun:
            raise gymnasium.error.ResetNeeded("call reset before render")
        if self._renderer is None:
            self._renderer = _renderer(self.task)
        arenas = self.task.arenas
        return tuple(
            self._renderer.draw(robots[0], ball, self._reach)
            for robots, ball in zip(arenas.robots, arenas.balls, strict=True)
        )


def _action_space(task: ArenaTask) -> Box[np.float32]:
    return Box(-1.0, 1.0, (task.action_size,), np.float32)


def _check_render_mode(mode: str | None) -> None:
    if mode not in (None, "rgb_array"):
        raise ValueError(f"render_mode must be None or 'rgb_array', not {mode!r}")


def _start_of(options: Mapping[str, Any] | None) -> ArrayLike | None:
    unknown = set(options or ()) - {"start"}
    if unknown:
        raise ValueError(f"reset has no option {', '.join(sorted(map(repr, unknown)))}; there is 'start'")
    return (options or {}).get("start")


def _episode_info(ended: Episodes) -> Info:
    return {
        "is_success": bool(ended.success[0]),
        "time": float(ended.time[0]),
        "optimum": float(ended.optimum[0]),
        "kick_time": float(ended.kick_time[0]),
    }


def _spread(episodes: Episodes, ended: BoolArray) -> Info:
    info: Info = {}
    for key, values in (
        ("is_success", episodes.success),
        ("time", episodes.time),
        ("optimum", episodes.optimum),
        ("kick_time", episodes.kick_time),
    ):
        whole = np.zeros(len(ended), dtype=values.dtype)
        whole[ended] = values
        info[key] = whole
        info[f"_{key}"] = ended.copy()
    return info


def _renderer(task: ArenaTask) -> Renderer:
    return Renderer(task.settings.field, task.settings.simulator.body.face)
