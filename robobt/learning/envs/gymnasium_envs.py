"""The environments as Gymnasium knows them, single and vectorised."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from typing import Any

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray

from robobt.learning.envs.bounds import action_space, observation_space
from robobt.learning.envs.episodes import Episodes
from robobt.learning.envs.go_to_ball import GoToBallTask
from robobt.learning.envs.render import Picture, Renderer
from robobt.learning.envs.settings import GoToBallSettings, ShootSettings
from robobt.learning.envs.shoot import ShootTask
from robobt.learning.envs.task import BoolArray, FloatArray
from robobt.world.geometry import Point

Observation = NDArray[np.float32]
Action = NDArray[np.float32]
Info = dict[str, Any]

_TRAIL = 400


class _SingleEnv(gymnasium.Env[Observation, Action]):
    """One arena behind Gymnasium's interface."""

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 33}  # noqa: RUF012

    def __init__(self, task: GoToBallTask | ShootTask, render_mode: str | None) -> None:
        _check_render_mode(render_mode)
        self.render_mode = render_mode
        self.task = task
        self.observation_space = observation_space(task)
        self.action_space = action_space(task)
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
        """The field as (height, width, 3) pixels in mode ``rgb_array``; None without a mode."""
        if self.render_mode is None:
            return None
        if not self._begun:
            raise gymnasium.error.ResetNeeded("call reset before render")
        if self._renderer is None:
            self._renderer = _renderer(self.task)
        arenas = self.task.arenas
        return self._renderer.draw(
            arenas.robots[0, 0], arenas.balls[0], _reach(self.task), self._robot_trail, self._ball_trail
        )

    def _leave_trail(self) -> None:
        arenas = self.task.arenas
        self._robot_trail.append((float(arenas.robots[0, 0, 0]), float(arenas.robots[0, 0, 1])))
        self._ball_trail.append((float(arenas.balls[0, 0]), float(arenas.balls[0, 1])))


class GoToBallEnv(_SingleEnv):
    """Go-To-Ball: drive an omnidirectional robot to the ball.

    Source: "Machine Learning Approaches for Attacking Behaviors in Robot Soccer",
    with the choices of the authors' published code where the paper is silent. The
    equations of the reward are its Eqs. 7 to 9. What is given here are the
    defaults of :class:`~robobt.learning.envs.GoToBallSettings`, where all of it
    can be changed.

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

    **Reward** a step, with d the distance [m] and theta the angle to the ball
    [rad] that the step led to:

    | term | value | equation |
    | --- | --- | --- |
    | contact | 100 where d <= 0.2 m | 7 |
    | distance | 5 / sqrt(2 pi) exp(-d^2 / 2) - 2 | 8 |
    | orientation | 1 / sqrt(2 pi) exp(-2 abs(theta) / pi^2) | 9 |

    Hovering just outside 0.2 m, facing the ball, earns 0.354 a step: with a
    discount below 0.996 that is worth less than the contact. The undiscounted
    return rewards hovering; compare policies by success and time.

    **Start**: ball and robot each anywhere inside the lines less 0.1 m, the two at
    least 0.2 m apart, heading in [-pi, pi), all at rest.

    **End**: terminated by contact, which is success; truncated after 330 steps
    (9.9 s).

    Args:
        settings: a :class:`~robobt.learning.envs.GoToBallSettings` or the mapping
            that makes one, as out of a YAML file.
        render_mode: None or "rgb_array".
    """

    def __init__(
        self, settings: GoToBallSettings | Mapping[str, Any] | None = None, render_mode: str | None = None
    ) -> None:
        super().__init__(GoToBallTask(_go_to_ball_settings(settings)), render_mode)


class ShootTowardsGoalEnv(_SingleEnv):
    """Shoot-Towards-Goal: turn on the spot with the ball and kick it into the goal.

    Source: "Machine Learning Approaches for Attacking Behaviors in Robot Soccer",
    with the choices of the authors' published code where the paper is silent. The
    equations of the reward are its Eqs. 12 and 13. What is given here are the
    defaults of :class:`~robobt.learning.envs.ShootSettings`, where all of it can
    be changed.

    One step is one control period of 30 ms, in 4 physics steps with walls, goals
    and ball contacts. The dribbler is on all the time. It holds the ball with
    limited force: who turns too fast loses it.

    **Observation**, float32, :data:`robobt.world.features.SHOOT`; the frame is the
    robot's, x ahead and y to its left:

    | entry | meaning | unit | range |
    | --- | --- | --- | --- |
    | 0, 1 | position of the ball | m | diagonal inside the walls, either way |
    | 2, 3 | velocity of the ball over the field | m/s | fastest kick + 2.3, either way |
    | 4 | the robot's turning rate, counter-clockwise | rad/s | top rate + 5.6, either way |
    | 5 | distance to the middle of the goal | m | [0, diagonal inside the walls] |
    | 6, 7 | sine and cosine of the angle from the heading to the left post | 1 | [-1, 1] |
    | 8, 9 | the same of the right post | 1 | [-1, 1] |

    **Action**, float32, :data:`robobt.models.actions.SHOOT_ACTION`:

    | entry | meaning | of 1 | range |
    | --- | --- | --- | --- |
    | 0 | turning rate | 10 rad/s | [-1, 1] |
    | 1 | kick where above 0, with 5 m/s, if the ball is in the mouth | - | [-1, 1] |

    **Reward** a step. alpha is the angle between the posts seen from the robot,
    beta the larger of the angles from the heading to the posts, v the ball's
    speed; the robot faces the goal where alpha >= beta:

    | term | value | equation |
    | --- | --- | --- |
    | facing the goal | 0.05 (alpha - beta) v where it faces it, else (alpha - beta) v | 12 |
    | kick | +10 on the first step with a kick action, if facing | 13 |
    | waiting | -0.25 before the first kick action, and whenever not facing | 13 |
    | goal | +20 instead of all the above, on the step that ends in a goal | - |

    The last is of the authors' code alone. A step that ends out of play earns 0.
    As in that code the +10 is paid for the action, ball or not, goal or not. And
    turning with the ball by D costs about 3.2 (D - alpha)^2 / 2 at whatever rate,
    while never kicking costs 0.25 a step: not kicking is a local optimum.

    **Start**: x from 0.3 m to 0.3 m before the defence area, y inside the touch
    lines less 0.1 m, heading in [-pi, pi), at rest; the ball in the mouth, where
    the dribbler holds it after 3 steps of warm-up.

    **End**, looked at in this order: terminated by a goal, which is success (ball
    behind the goal line between the posts); terminated out of play (ball behind
    the goal line, behind the halfway line or over a touch line, or the robot 0.2 m
    behind the halfway line, over a touch line or in the defence area); truncated
    after 100 steps (3 s).

    Args:
        settings: a :class:`~robobt.learning.envs.ShootSettings` or the mapping that
            makes one, as out of a YAML file.
        render_mode: None or "rgb_array".
    """

    def __init__(
        self, settings: ShootSettings | Mapping[str, Any] | None = None, render_mode: str | None = None
    ) -> None:
        super().__init__(ShootTask(_shoot_settings(settings)), render_mode)


class _ManyEnv(VectorEnv[Observation, Action, Any]):
    """Many arenas in one simulator behind Gymnasium's vector interface."""

    metadata: dict[str, Any] = {  # noqa: RUF012 - Gymnasium declares it so
        "render_modes": ["rgb_array"],
        "render_fps": 33,
        "autoreset_mode": AutoresetMode.SAME_STEP,
    }

    def __init__(self, task: GoToBallTask | ShootTask, render_mode: str | None) -> None:
        _check_render_mode(render_mode)
        self.render_mode = render_mode
        self.task = task
        self.num_envs = task.n
        self.single_observation_space = observation_space(task)
        self.single_action_space = action_space(task)
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
        """One picture an arena in mode ``rgb_array``; None without a mode."""
        if self.render_mode is None:
            return None
        if not self._begun:
            raise gymnasium.error.ResetNeeded("call reset before render")
        if self._renderer is None:
            self._renderer = _renderer(self.task)
        arenas, reach = self.task.arenas, _reach(self.task)
        return tuple(
            self._renderer.draw(robots[0], ball, reach)
            for robots, ball in zip(arenas.robots, arenas.balls, strict=True)
        )


class GoToBallVectorEnv(_ManyEnv):
    """Many arenas of :class:`GoToBallEnv`, which says what is observed, rewarded and ended.

    Args:
        num_envs: number of arenas.
        settings, render_mode: as there.
    """

    def __init__(
        self,
        num_envs: int = 1,
        settings: GoToBallSettings | Mapping[str, Any] | None = None,
        render_mode: str | None = None,
    ) -> None:
        super().__init__(GoToBallTask(_go_to_ball_settings(settings), num_envs), render_mode)


class ShootTowardsGoalVectorEnv(_ManyEnv):
    """Many arenas of :class:`ShootTowardsGoalEnv`, which says what is observed, rewarded and ended.

    Args:
        num_envs: number of arenas.
        settings, render_mode: as there.
    """

    def __init__(
        self,
        num_envs: int = 1,
        settings: ShootSettings | Mapping[str, Any] | None = None,
        render_mode: str | None = None,
    ) -> None:
        super().__init__(ShootTask(_shoot_settings(settings), num_envs), render_mode)


def _go_to_ball_settings(given: GoToBallSettings | Mapping[str, Any] | None) -> GoToBallSettings | None:
    return given if given is None else GoToBallSettings.model_validate(given)


def _shoot_settings(given: ShootSettings | Mapping[str, Any] | None) -> ShootSettings | None:
    return given if given is None else ShootSettings.model_validate(given)


def _check_render_mode(mode: str | None) -> None:
    if mode not in (None, "rgb_array"):
        raise ValueError(f"render_mode must be None or 'rgb_array', not {mode!r}")


def _start_of(options: Mapping[str, Any] | None) -> Any:
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


def _renderer(task: GoToBallTask | ShootTask) -> Renderer:
    return Renderer(task.settings.field, task.settings.simulator.body.face)


def _reach(task: GoToBallTask | ShootTask) -> float | None:
    if isinstance(task, GoToBallTask) and task.settings.contact.rule.startswith("distance"):
        return task.settings.contact.distance
    return None
