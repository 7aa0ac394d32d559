"""Many arenas as the vector of environments that Stable-Baselines3 trains on."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from robobt.config.extras import need

need("sb3", "stable_baselines3")

import numpy as np  # noqa: E402
from numpy.typing import NDArray  # noqa: E402
from stable_baselines3.common.vec_env import VecEnv  # noqa: E402

from robobt.learning.envs.gymnasium_base import Info, TaskVectorEnv  # noqa: E402

_Indices = None | int | Iterable[int]


class ArenasVecEnv(VecEnv):
    """A vector environment behind Stable-Baselines3's interface: one simulator instead of many processes.

    ``ArenasVecEnv(gymnasium.make_vec("GoToBall-v0", 64, vectorization_mode="vector_entry_point"))``. An
    episode that ends restarts in the same step; its infos hold ``terminal_observation``,
    ``TimeLimit.truncated``, ``is_success`` and ``episode`` with the return ``r``, the length in decisions
    ``l`` and the time ``t`` [s].

    Args:
        envs: the Gymnasium vector environment.
    """

    def __init__(self, envs: TaskVectorEnv) -> None:
        self.envs = envs
        super().__init__(envs.num_envs, envs.single_observation_space, envs.single_action_space)
        self._actions: NDArray[Any] = np.zeros(0)
        self._returns, self._lengths = np.zeros(envs.num_envs), np.zeros(envs.num_envs, dtype=np.int64)

    def reset(self) -> NDArray[np.float32]:
        """Restart all episodes; a seed set by ``seed`` before seeds everything that follows."""
        seen, _ = self.envs.reset(seed=self._seeds[0])
        self._reset_seeds()
        self._returns[:], self._lengths[:] = 0.0, 0
        return seen

    def step_async(self, actions: NDArray[Any]) -> None:
        """Take the actions of the next step."""
        self._actions = actions

    def step_wait(self) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.bool_], list[Info]]:
        """Advance one decision."""
        seen, reward, terminated, truncated, info = self.envs.step(self._actions)
        self._returns += reward
        self._lengths += 1
        done = terminated | truncated
        infos: list[Info] = [{} for _ in range(self.num_envs)]
        for k in np.flatnonzero(done).tolist():
            infos[k] = {
                "terminal_observation": info["final_obs"][k],
                "TimeLimit.truncated": bool(truncated[k] and not terminated[k]),
                "is_success": bool(info["final_info"]["is_success"][k]),
                "episode": {
                    "r": float(self._returns[k]),
                    "l": int(self._lengths[k]),
                    "t": float(info["final_info"]["time"][k]),
                },
            }
        self._returns[done], self._lengths[done] = 0.0, 0
        return seen, reward.astype(np.float32), done, infos

    def close(self) -> None:
        """Close the environment."""
        self.envs.close()

    def get_attr(self, attr_name: str, indices: _Indices = None) -> list[Any]:
        """Return an attribute of the environment, once for each of those asked for."""
        return [getattr(self.envs, attr_name)] * len(list(self._get_indices(indices)))

    def set_attr(self, attr_name: str, value: Any, indices: _Indices = None) -> None:  # noqa: ARG002
        """Set an attribute of the environment, which is one for all arenas."""
        setattr(self.envs, attr_name, value)

    def env_method(
        self, method_name: str, *method_args: Any, indices: _Indices = None, **method_kwargs: Any
    ) -> list[Any]:
        """Call a method of the environment once; return what it returns, for each of those asked for."""
        answer = getattr(self.envs, method_name)(*method_args, **method_kwargs)
        return [answer] * len(list(self._get_indices(indices)))

    def env_is_wrapped(self, wrapper_class: type[Any], indices: _Indices = None) -> list[bool]:  # noqa: ARG002
        """Return False for each of the ``indices``, whatever ``wrapper_class``: nothing is wrapped."""
        return [False] * len(list(self._get_indices(indices)))

    def get_images(self) -> Sequence[NDArray[np.uint8] | None]:
        """Return a picture of each arena in mode ``rgb_array``."""
        return self.envs.render() or [None]
