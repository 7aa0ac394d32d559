"""Tasks with several robots behind PettingZoo's parallel API: one agent per learner."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from robobt.config.extras import need

need("agents", "pettingzoo")

import numpy as np  # noqa: E402
from gymnasium.spaces import Box  # noqa: E402
from numpy.typing import NDArray  # noqa: E402
from pettingzoo import ParallelEnv  # noqa: E402

from robobt.config.errors import unknown_name  # noqa: E402
from robobt.learning.envs.gymnasium_base import (  # noqa: E402
    Picture,
    checked_action,
    need_reset,
    picture_of,
    settings_for,
)
from robobt.learning.envs.make import make_task  # noqa: E402
from robobt.learning.envs.settings import TaskSettings  # noqa: E402
from robobt.learning.envs.task import FloatArray  # noqa: E402

Observation = NDArray[np.float32]
Info = dict[str, Any]


class SoccerParallelEnv(ParallelEnv[str, Observation, Observation]):
    """One arena of a task with an agent for each learner, named by team and number: ``blue_0``, ``yellow_1``.

    An agent's observation, action and reward are those of a learner in
    :class:`~robobt.learning.envs.gymnasium_base.TaskVectorEnv`; episodes end for all agents together. The
    last step's infos hold ``is_success``, for blue, and ``time`` [s].

    Args:
        task: name in :data:`~robobt.learning.tasks.TASKS`, or its Gymnasium id.
        settings: that task's settings, or a mapping of their fields.
        render_mode: None or "rgb_array".

    Raises:
        KeyError: there is no such task.
        ValueError: the settings are wrong.
    """

    def __init__(
        self,
        task: str,
        settings: TaskSettings | Mapping[str, object] | None = None,
        render_mode: str | None = None,
    ) -> None:
        self.task = made = make_task(settings_for(task, settings, render_mode), 1)
        self.metadata = {"render_modes": ["rgb_array"], "render_fps": 33, "name": task}
        self.render_mode = render_mode
        blue = made.blue
        self.possible_agents = [
            f"blue_{index}" if index < blue else f"yellow_{index - blue}" for index in made.learners
        ]
        self.agents: list[str] = []
        space, action = made.space, Box(-1.0, 1.0, (made.action.size,), np.float32)
        self.observation_spaces = dict.fromkeys(self.possible_agents, space)
        self.action_spaces = dict.fromkeys(self.possible_agents, action)
        high = np.full(made.state_size, np.inf, dtype=np.float32)
        self.state_space = Box(-high, high, dtype=np.float32)
        self._begun = False

    def observation_space(self, agent: str) -> Box[np.float32]:
        """Return the space of an agent's observations, always the same object.

        Raises:
            ValueError: there is no such agent.
        """
        self._check_known([agent])
        return self.observation_spaces[agent]

    def action_space(self, agent: str) -> Box[np.float32]:
        """Return the space of its actions, always the same object.

        Raises:
            ValueError: there is no such agent.
        """
        self._check_known([agent])
        return self.action_spaces[agent]

    def reset(
        self, seed: int | None = None, options: Mapping[str, Any] | None = None
    ) -> tuple[dict[str, Observation], dict[str, Info]]:
        """Start an episode; ``seed`` seeds everything that follows, ``options`` may hold a ``start`` (S,).

        Raises:
            ValueError: an invalid start.
        """
        start = (options or {}).get("start")
        if start is not None:
            seen = self.task.reset_to(start, seed)
        elif seed is not None or not self._begun:
            seen = self.task.reset(seed)
        else:
            seen = self.task.restart()
        self._begun = True
        self.agents = list(self.possible_agents)
        return self._by_agent(seen), {agent: {} for agent in self.agents}

    def step(
        self, actions: Mapping[str, NDArray[Any]]
    ) -> tuple[dict[str, Observation], dict[str, float], dict[str, bool], dict[str, bool], dict[str, Info]]:
        """Advance one decision with the actions of all ``agents``.

        Raises:
            ResetNeeded: no episode has begun, or it is over.
            ValueError: an agent's action is missing, has another shape or is not finite, or there is no such
                agent.
        """
        need_reset(self._begun, "step", self._begun and not self.agents)
        agents = self.agents
        if not isinstance(actions, Mapping):
            raise ValueError(f"actions must map each agent to its action, not be a {type(actions).__name__}")
        self._check_known(actions)
        if missing := [agent for agent in agents if agent not in actions]:
            raise ValueError(
                f"there is no action for {', '.join(missing)}; step needs one for each of {', '.join(agents)}"
            )
        size = self.task.action.size
        given = [checked_action(actions[agent], size, f"{agent}: the action") for agent in agents]
        result, ended = self.task.advance(np.concatenate(given)[None]), self.task.ended
        info: Info = {}
        if ended is not None:
            info = {"is_success": bool(ended.success[0]), "time": float(ended.time[0])}
            self.agents = []
        rewards = dict(zip(agents, self.task.shares[0].tolist(), strict=True))
        return (
            self._by_agent(result.observation),
            rewards,
            dict.fromkeys(agents, bool(result.terminated[0])),
            dict.fromkeys(agents, bool(result.truncated[0])),
            {agent: dict(info) for agent in agents},
        )

    def state(self) -> Observation:
        """Return the arena's true state for a central critic, see :meth:`SoccerTask.state`.

        Raises:
            ResetNeeded: no episode has begun.
        """
        need_reset(self._begun, "state")
        state: Observation = self.task.state()[0].astype(np.float32)
        return state

    def render(self) -> Picture | None:
        """Draw the field as (height, width, 3) pixels in mode ``rgb_array``; None without a mode."""
        if self.render_mode is None:
            return None
        need_reset(self._begun, "render")
        return picture_of(self.task, 0)

    def _check_known(self, agents: Iterable[str]) -> None:
        for agent in agents:
            if agent not in self.possible_agents:
                raise ValueError(f"no agent is called {agent!r}: {unknown_name(agent, self.possible_agents)}")

    def _by_agent(self, seen: FloatArray) -> dict[str, Observation]:
        rows = seen.astype(np.float32).reshape(len(self.possible_agents), -1)
        return dict(zip(self.possible_agents, rows, strict=True))
