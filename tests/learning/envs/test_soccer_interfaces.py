"""Tasks of several robots keep the rules of Gymnasium, PettingZoo and the libraries that learn with them."""

from __future__ import annotations

import warnings
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from robobt.learning.envs.gymnasium_base import TaskEnv
from robobt.learning.envs.soccer.settings import SoccerSettings
from robobt.learning.envs.soccer.suite import SUITE
from robobt.learning.envs.soccer.task import SoccerTask

TASKS = {"Soccer": SoccerSettings, **SUITE}

RESTARTS = {
    "rules": {"restarts": True, "double_touch": True, "held_by": None},
    "starts": {"ball_speed": [3.0, 5.0]},
    "time_limit": 100,
}

ELEVEN = {"blue": ["goalkeeper"] + 10 * ["learner"], "yellow": 11 * ["learner"]}


def many(name: str, num_envs: int, **more: Any) -> Any:
    return gymnasium.make_vec(f"{name}-v0", num_envs, vectorization_mode="vector_entry_point", **more)


def test_every_task_of_the_suite_has_its_id() -> None:
    for name in TASKS:
        assert f"robobt/{name}-v0" in gymnasium.registry
    with pytest.raises(KeyError, match="no task is called 'Chess'; 'robobt list tasks' lists all"):
        TaskEnv(task="Chess")


@pytest.mark.integration
@pytest.mark.parametrize(
    ("name", "settings"),
    [
        *((name, {"noise": {"robot_position": 0.01}}) for name in TASKS),
        ("Duel", RESTARTS),
        ("Soccer", ELEVEN),
    ],
)
def test_gymnasiums_checker_has_nothing_to_say(name: str, settings: Any) -> None:
    check_env(gymnasium.make(f"{name}-v0", settings=settings).unwrapped)


@pytest.mark.parametrize(
    ("name", "more"),
    [
        ("Save", {}),
        ("Duel", {}),
        ("Attack3v2", {}),
        ("Duel", {"settings": RESTARTS}),
        ("Soccer", {"settings": ELEVEN}),
    ],
)
def test_every_learner_is_an_environment_of_the_vector(name: str, more: dict[str, Any]) -> None:
    each = len(TASKS[name].model_validate(more.get("settings", {})).learners)
    envs, again = (many(name, 2 * each, **more) for _ in range(2))
    seen, _ = envs.reset(seed=3)
    np.testing.assert_array_equal(seen, again.reset(seed=3)[0])
    assert envs.observation_space.contains(seen)
    envs.action_space.seed(1)
    ended = 0
    for _ in range(330):
        seen, reward, terminated, truncated, info = envs.step(envs.action_space.sample())
        assert envs.observation_space.contains(seen)
        done = terminated | truncated
        assert reward.shape == done.shape == (2 * each,)
        # Episodes end for all of an arena.
        assert (done.reshape(2, each).all(1) == done.reshape(2, each).any(1)).all()
        if info:
            ended += int(done.sum())
            np.testing.assert_array_equal(info["final_obs"][~done], seen[~done])
            assert (info["final_info"]["time"][done] > 0.0).all()
    assert ended >= each
    with pytest.raises(ValueError, match="multiple of the arena's 2"):
        many("Duel", 3)


@pytest.mark.parametrize(
    ("name", "settings"),
    [*((name, None) for name in TASKS), ("Duel", RESTARTS), ("Small3v3", RESTARTS), ("Soccer", ELEVEN)],
)
def test_pettingzoos_checkers_have_nothing_to_say(name: str, settings: Any) -> None:
    pytest.importorskip("pettingzoo", reason="needs PettingZoo: pip install 'robobt[agents]'")
    from pettingzoo.test import parallel_api_test, parallel_seed_test

    from robobt.learning.envs.soccer.parallel import SoccerParallelEnv

    with warnings.catch_warnings():
        # It advises against settings that are no keyword arguments of their own.
        warnings.simplefilter("ignore", UserWarning)
        parallel_api_test(SoccerParallelEnv(name, settings), num_cycles=200)
        parallel_seed_test(lambda: SoccerParallelEnv(name, settings))


def test_agents_are_the_tasks_learners() -> None:
    pytest.importorskip("pettingzoo", reason="needs PettingZoo: pip install 'robobt[agents]'")
    from robobt.learning.envs.soccer.parallel import SoccerParallelEnv

    env = SoccerParallelEnv("Small3v3", {"time_limit": 20}, render_mode="rgb_array")
    task = SoccerTask(SUITE["Small3v3"](time_limit=20), seed=5)
    seen, _ = env.reset(seed=5)
    assert env.agents == ["blue_1", "blue_2", "yellow_1", "yellow_2"]
    np.testing.assert_array_equal(np.concatenate(list(seen.values())), task.reset()[0].astype(np.float32))
    rng = np.random.default_rng(0)
    while env.agents:
        actions = {agent: rng.uniform(-1, 1, 4) for agent in env.agents}
        seen, rewards, terminated, truncated, infos = env.step(actions)
        result = task.advance(np.concatenate(list(actions.values()))[None])
        np.testing.assert_array_equal(list(rewards.values()), task.shares[0])
        np.testing.assert_array_equal(env.state(), task.state()[0].astype(np.float32))
        assert set(terminated.values()) == {bool(result.terminated[0])}
    assert all(terminated.values()) or all(truncated.values())
    assert infos["blue_1"]["time"] > 0.0
    assert env.render().ndim == 3


@pytest.mark.integration
def test_stable_baselines3_learns_on_it() -> None:
    pytest.importorskip("stable_baselines3", reason="needs Stable-Baselines3: pip install 'robobt[sb3]'")
    from stable_baselines3 import PPO

    from robobt.learning.envs.stable_baselines3 import ArenasVecEnv

    envs = ArenasVecEnv(many("Duel", 8, settings={"time_limit": 40}))
    envs.seed(0)
    seen = envs.reset()
    for _ in range(25):
        seen, _, done, infos = envs.step(np.zeros((8, 4), dtype=np.float32))
        assert envs.observation_space.contains(seen[0])
        for k in np.flatnonzero(done):
            assert infos[k]["terminal_observation"].shape == seen[k].shape
            assert infos[k]["TimeLimit.truncated"]
            assert infos[k]["episode"]["l"] == 20
    learner = PPO("MlpPolicy", envs, n_steps=16, batch_size=64, n_epochs=1, device="cpu")
    learner.learn(256)
    assert learner.num_timesteps == 256


@pytest.mark.integration
def test_torchrl_wraps_it() -> None:
    pytest.importorskip("pettingzoo", reason="needs PettingZoo: pip install 'robobt[agents]'")
    libs = pytest.importorskip("torchrl.envs", reason="needs TorchRL, which is no dependency")
    from robobt.learning.envs.soccer.parallel import SoccerParallelEnv

    env = libs.PettingZooWrapper(SoccerParallelEnv("Duel"), use_mask=False)
    libs.check_env_specs(env)
    rollout = env.rollout(10)
    assert rollout["blue", "observation"].shape[-1] == env.observation_spec["blue", "observation"].shape[-1]


def parallel_env(name: str = "Small3v3", **settings: Any) -> Any:
    pytest.importorskip("pettingzoo", reason="needs PettingZoo: pip install 'robobt[agents]'")
    from robobt.learning.envs.soccer.parallel import SoccerParallelEnv

    return SoccerParallelEnv(name, settings, render_mode="rgb_array")


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (
            {"blue_2": None, "yellow_1": None},
            "no action for blue_2, yellow_1; step needs one for each of",
        ),
        (
            {"red_1": np.zeros(4)},
            "no agent is called 'red_1': .*there are blue_1, blue_2, yellow_1",
        ),
        ({1: np.zeros(4)}, "no agent is called 1"),
        ({"yellow_1": np.zeros(3)}, r"yellow_1: the action must have the shape \(4,\), not \(3,\)"),
        ({"yellow_1": 0.0}, r"yellow_1: the action must have the shape \(4,\), not \(\)"),
        ({"blue_1": [0.0, np.nan, 0.0, 0.0]}, r"blue_1: the action is not finite: \[0.0, nan"),
        ({"blue_1": [0.0, np.inf, 0.0, 0.0]}, "blue_1: the action is not finite"),
        ({"blue_1": "ahead"}, "blue_1: the action must be 4 numbers, not 'ahead'"),
        ({"blue_1": [[0.0], [0.0, 1.0]]}, "blue_1: the action must be 4 numbers"),
    ],
)
def test_actions_that_cannot_be_stepped_with_name_their_agent(wrong: dict[Any, Any], said: str) -> None:
    env = parallel_env()
    env.reset(seed=1)
    actions = {agent: np.zeros(4) for agent in env.agents} | wrong
    with pytest.raises(ValueError, match=said):
        env.step({agent: action for agent, action in actions.items() if action is not None})
    # Nothing has been stepped, and the episode goes on.
    env.step({agent: np.zeros(4) for agent in env.agents})


def test_actions_of_agents_are_a_mapping() -> None:
    env = parallel_env()
    env.reset(seed=1)
    with pytest.raises(ValueError, match="actions must map each agent to its action, not be a ndarray"):
        env.step(np.zeros((4, 4)))


def test_agents_are_stepped_in_an_episode_only() -> None:
    env = parallel_env(time_limit=2)
    for call in (lambda: env.step({}), env.state, env.render):
        with pytest.raises(gymnasium.error.ResetNeeded, match="call reset before"):
            call()
    env.reset(seed=1)
    actions = {agent: np.zeros(4) for agent in env.agents}
    while env.agents:
        env.step(actions)
    for given in (actions, {}):
        with pytest.raises(gymnasium.error.ResetNeeded, match="the episode is over; call reset before step"):
            env.step(given)
    # What it ended in can still be looked at.
    assert env.state_space.contains(env.state())
    assert env.render().ndim == 3
    env.reset()
    env.step(actions)


def test_what_is_asked_of_an_unknown_agent_names_the_known_ones() -> None:
    env = parallel_env()
    for ask in (env.observation_space, env.action_space):
        with pytest.raises(
            ValueError, match=r"no agent is called 'blue1': there are blue_1, .* did you mean blue_1"
        ):
            ask("blue1")
