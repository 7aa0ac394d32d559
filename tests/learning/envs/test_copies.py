"""Environments can be pickled and copied at any time, and a copy goes on as the environment would."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from typing import Any

import gymnasium
import numpy as np
import pytest

from robobt.learning import TASKS
from robobt.learning.envs.make import learners_of, make_rows, make_task
from robobt.learning.tasks import environment_id

COPIES: dict[str, Callable[[Any], Any]] = {
    "pickled": lambda env: pickle.loads(pickle.dumps(env)),
    "copied": copy.deepcopy,
}
IDS = sorted(name for name in gymnasium.registry if name.startswith("robobt/"))


def go_on_alike(one: Any, other: Any, actions: Callable[[], Any], steps: int) -> None:
    for _ in range(steps):
        given = actions()
        results = [env.step(given) for env in (one, other)]
        np.testing.assert_equal(results[1], results[0])
        if isinstance(results[0][2], bool) and (results[0][2] or results[0][3]):
            np.testing.assert_equal(*[env.reset()[0] for env in (one, other)])


@pytest.mark.parametrize("how", COPIES)
@pytest.mark.parametrize("name", IDS)
def test_a_copy_of_an_environment_goes_on_as_it_would(name: str, how: str) -> None:
    env = gymnasium.make(name)
    COPIES[how](env).reset(seed=1)
    env.reset(seed=0)
    env.action_space.seed(0)
    for _ in range(3):
        env.step(env.action_space.sample())
    go_on_alike(env, COPIES[how](env), env.action_space.sample, 30)


@pytest.mark.parametrize("how", COPIES)
@pytest.mark.parametrize("name", ["go_to_ball", "score_on_goalkeeper", "duel"])
def test_a_copy_of_arenas_with_everything_drawn_goes_on_as_they_would(name: str, how: str) -> None:
    settings = TASKS[name].Settings.model_validate(
        {
            "noise": {"ball_position": 0.01, "robot_position": 0.01},
            "randomisation": {"friction": [0.8, 1.2], "control_delay": [0.0, 0.1], "mass": [0.9, 1.1]},
            "latency": 2,
            "time_limit": 20,
        }
    )
    rows = 2 * learners_of(settings)
    env = make_rows(settings, rows)
    env.reset(3)
    rng = np.random.default_rng(0)
    env.step(rng.uniform(-1, 1, (rows, env.action_size)))
    other = COPIES[how](env)
    for _ in range(50):
        actions = rng.uniform(-1, 1, (rows, env.action_size))
        for one, two in zip(_fields(env.step(actions)), _fields(other.step(actions)), strict=True):
            np.testing.assert_array_equal(one, two)


def _fields(result: Any) -> list[Any]:
    return [getattr(result, name) for name in result.__slots__]


@pytest.mark.parametrize("how", COPIES)
@pytest.mark.parametrize("name", ["Duel", "Attack3v2"])
def test_a_copy_of_an_environment_of_agents_goes_on_as_it_would(name: str, how: str) -> None:
    pytest.importorskip("pettingzoo", reason="needs PettingZoo: pip install 'robobt[agents]'")
    from robobt.learning.envs.soccer.parallel import SoccerParallelEnv

    env = SoccerParallelEnv(name)
    COPIES[how](env).reset(seed=1)
    env.reset(seed=0)
    rng = np.random.default_rng(0)

    def actions() -> dict[str, Any]:
        return {agent: rng.uniform(-1, 1, 4) for agent in env.agents}

    env.step(actions())
    go_on_alike(env, COPIES[how](env), actions, 20)


@pytest.mark.parametrize("name", TASKS)
def test_settings_can_be_pickled_and_copied(name: str) -> None:
    settings = TASKS[name].Settings()
    for make in COPIES.values():
        assert make(settings) == settings
        assert make_task(make(settings), 1).action_size == make_task(settings, 1).action_size


def test_every_task_has_been_looked_at() -> None:
    assert sorted(f"robobt/{environment_id(name)}-v0" for name in TASKS) == IDS
