"""The environments keep Gymnasium's rules."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode

import robobt.learning  # noqa: F401
from robobt.learning.envs.gymnasium_base import TaskEnv
from robobt.learning.envs.scripted import straight_drive

IDS = pytest.mark.parametrize(
    "name",
    ["robobt/GoToBall-v0", "GoToBallAmongRobots-v0", "ShootTowardsGoal-v0", "ScoreOnGoalkeeper-v0"],
)
DISTURBED = {
    "noise": {"robot_position": 0.01, "ball_position": 0.01, "heading": 0.02, "velocity": 0.1},
    "latency": 2,
    "randomisation": {"acceleration": (0.7, 1.3), "control_delay": (0, 0.05)},
}


def many(name: str, n: int = 6, **more: Any) -> Any:
    return gymnasium.make_vec(name, num_envs=n, vectorization_mode="vector_entry_point", **more)


@pytest.mark.integration
@IDS
@pytest.mark.parametrize("settings", [None, DISTURBED])
def test_gymnasiums_checker_has_nothing_to_say(name: str, settings: Any) -> None:
    # A warning is an error in this suite.
    check_env(gymnasium.make(name, settings=settings).unwrapped)
    check_env(gymnasium.make(name, settings=settings, render_mode="rgb_array").unwrapped)


@IDS
def test_sub_environments_in_gymnasiums_own_vector_pass(name: str) -> None:
    envs = gymnasium.make_vec(name, num_envs=2, vectorization_mode="sync")
    envs.reset(seed=1)
    for _ in range(120):
        seen, *_ = envs.step(envs.action_space.sample())
    assert envs.observation_space.contains(seen)
    envs.close()


@IDS
def test_the_vectorised_environment_keeps_the_rules(name: str) -> None:
    envs = many(name)
    assert envs.metadata["autoreset_mode"] is AutoresetMode.SAME_STEP
    assert envs.num_envs == 6
    assert envs.observation_space.shape == (6, *envs.single_observation_space.shape)
    seen, info = envs.reset(seed=3)
    assert info == {}
    assert envs.observation_space.contains(seen)
    envs.action_space.seed(0)
    ended = 0
    for _ in range(340):
        kept = seen.copy()
        before = seen
        seen, reward, terminated, truncated, info = envs.step(envs.action_space.sample())
        np.testing.assert_array_equal(before, kept)
        assert envs.observation_space.contains(seen)
        assert reward.dtype == np.float64
        assert reward.shape == terminated.shape == truncated.shape == (6,)
        assert terminated.dtype == truncated.dtype == np.bool_
        done = terminated | truncated
        assert done.any() == bool(info)
        if info:
            ended += int(done.sum())
            np.testing.assert_array_equal(info["_final_obs"], done)
            np.testing.assert_array_equal(info["final_obs"][~done], seen[~done])
            assert (info["final_obs"][done] != seen[done]).any(axis=1).all()
            assert not info["final_info"]["is_success"][~done].any()
    assert ended >= 6
    again, _ = envs.reset(seed=3)
    other, _ = many(name).reset(seed=3)
    np.testing.assert_array_equal(again, other)
    envs.close()
    envs.close()


def test_the_vectorised_environment_equals_the_single_one() -> None:
    envs = many("GoToBall-v0", 4)
    starts = envs.unwrapped.task.sample_starts(1, 4)
    seen, _ = envs.reset(seed=0, options={"start": starts})
    single = gymnasium.make("GoToBall-v0")
    rng = np.random.default_rng(0)
    actions = rng.uniform(-1, 1, (30, 4, 3)).astype(np.float32)
    rewards = [envs.step(action)[1] for action in actions]
    for i in range(4):
        first, _ = single.reset(seed=0, options={"start": starts[i]})
        np.testing.assert_allclose(first, seen[i], atol=1e-6)
        for tick in range(30):
            assert single.step(actions[tick, i])[1] == pytest.approx(rewards[tick][i], abs=1e-9)


@IDS
def test_the_same_seed_gives_the_same_episodes(name: str) -> None:
    def play(env: Any) -> list[float]:
        env.reset(seed=11)
        rng, rewards = np.random.default_rng(2), []
        for _ in range(250):
            step = env.step(rng.uniform(-1, 1, env.action_space.shape).astype(np.float32))
            rewards.append(step[1])
            if step[2] or step[3]:
                env.reset()
        return rewards

    used = gymnasium.make(name)
    assert play(used) == play(used) == play(gymnasium.make(name))


def test_the_last_step_tells_what_became_of_the_episode() -> None:
    env = gymnasium.make("GoToBall-v0")
    seen, info = env.reset(seed=5)
    assert info == {}
    done = False
    while not done:
        assert info == {}
        seen, _, done, _, info = env.step(straight_drive(seen[None])[0].astype(np.float32))
    assert info["is_success"] is True
    assert info["time"] == pytest.approx(info["optimum"], abs=0.06)
    assert np.isnan(info["kick_time"])


def test_every_environment_has_its_name_with_and_without_the_namespace() -> None:
    for name in ("GoToBall-v0", "ShootTowardsGoal-v0", "ScoreOnGoalkeeper-v0"):
        with_it, without = gymnasium.spec(f"robobt/{name}"), gymnasium.spec(name)
        assert with_it.entry_point == without.entry_point


@pytest.mark.integration
@pytest.mark.parametrize("name", ["GoToBall-v0", "ShootTowardsGoal-v0", "ScoreOnGoalkeeper-v0"])
@pytest.mark.parametrize("settings", [None, {**DISTURBED, "velocities": "finite_difference"}])
def test_nothing_observed_lies_outside_the_spaces(name: str, settings: Any) -> None:
    envs = many(name, 64, settings=settings)
    envs.reset(seed=0)
    rng = np.random.default_rng(0)
    low, high = envs.single_observation_space.low, envs.single_observation_space.high
    actions = np.ones(envs.action_space.shape, dtype=np.float32)
    for tick in range(400):
        # The extremes, and long enough the same to get to the walls at full speed.
        if tick % 40 == 0:
            actions = rng.choice([-1.0, 1.0], envs.action_space.shape).astype(np.float32)
        seen, *_, info = envs.step(actions)
        final = info.get("final_obs", seen)
        assert (seen >= low).all()
        assert (seen <= high).all()
        assert (final >= low).all()
        assert (final <= high).all()


def test_pictures_show_the_field() -> None:
    env = gymnasium.make("GoToBall-v0", render_mode="rgb_array")
    env.reset(seed=0, options={"start": [-2.0, 1.0, 0, 0, 0, 0, 2.0, -1.0, 0, 0]})
    picture: Any = env.render()
    assert picture.dtype == np.uint8
    height, width, colours = picture.shape
    assert colours == 3
    scale = width / 9.6

    def at(x: float, y: float) -> list[int]:
        return picture[round(height / 2 - y * scale), round(width / 2 + x * scale)].tolist()

    red, green, blue = at(-2.03, 1.03)
    assert blue > red
    assert blue > green
    red, green, blue = at(2.0, -1.0)
    assert red > green > blue
    red, green, blue = at(1.0, 1.0)
    assert green > max(red, blue)
    for _ in range(30):
        env.step(np.array([1, 0, 0], dtype=np.float32))
    assert (env.render() != picture).any()
    assert gymnasium.make("GoToBall-v0").render_mode is None


def test_every_arena_of_a_vector_has_its_picture() -> None:
    envs = many("ShootTowardsGoal-v0", 3, render_mode="rgb_array")
    envs.reset(seed=0)
    pictures = envs.render()
    assert len(pictures) == 3
    assert (pictures[0] != pictures[1]).any()
    assert many("ShootTowardsGoal-v0", 3).render() is None


def test_misuse_is_refused() -> None:
    with pytest.raises(gymnasium.error.ResetNeeded):
        TaskEnv("go_to_ball").step(np.zeros(3, dtype=np.float32))
    with pytest.raises(gymnasium.error.ResetNeeded):
        TaskEnv("go_to_ball", render_mode="rgb_array").render()
    with pytest.raises(ValueError, match="'human'"):
        TaskEnv("shoot", render_mode="human")
    with pytest.raises(ValueError, match="no option 'wind'"):
        TaskEnv("go_to_ball").reset(options={"wind": 1})
    env = TaskEnv("go_to_ball")
    env.reset(seed=0)
    with pytest.raises(ValueError, match="not finite"):
        env.step(np.full(3, np.nan, dtype=np.float32))


def test_registering_does_not_load_the_learners() -> None:
    code = "import sys, robobt.learning; print('torch' in sys.modules, 'pymunk' in sys.modules)"
    printed = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert printed.split() == ["False", "False"]


@pytest.mark.integration
def test_gymnasium_makes_one_by_module_and_id_without_an_import() -> None:
    code = "import gymnasium; print(gymnasium.make('robobt.learning:GoToBall-v0').reset(seed=0)[0].shape)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "(6,)\n"


@pytest.mark.parametrize(
    ("action", "said"),
    [
        (np.zeros(2), r"the action must have the shape \(\d,\), not \(2,\)"),
        ("ahead", r"the action must be \d numbers, not 'ahead'"),
        (None, "the action must have the shape"),
        (np.full(3, np.nan), "the action"),
    ],
)
def test_an_action_that_cannot_be_stepped_with_is_told(action: Any, said: str) -> None:
    env = gymnasium.make("robobt/GoToBall-v0").unwrapped
    env.reset(seed=1)
    with pytest.raises(ValueError, match=said):
        env.step(action)


def test_an_episode_that_is_over_is_not_stepped_on() -> None:
    env = gymnasium.make("robobt/GoToBall-v0", settings={"time_limit": 2}).unwrapped
    env.reset(seed=1)
    action = np.zeros(env.action_space.shape or 0)
    while not any(env.step(action)[2:4]):
        pass
    with pytest.raises(gymnasium.error.ResetNeeded, match="the episode is over; call reset before step"):
        env.step(action)
    env.reset()
    env.step(action)
