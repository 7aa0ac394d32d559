"""Many arenas, stepped together, are what each would be alone."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from robobt.learning.envs import (
    ArenaTask,
    GoToBallSettings,
    GoToBallTask,
    ScoreOnGoalkeeperSettings,
    ScoreOnGoalkeeperTask,
    ShootSettings,
    ShootTask,
    run_starts,
    straight_line_time,
)
from robobt.learning.envs.scripted import straight_drive, turn_and_kick

BOTH = pytest.mark.parametrize("kind", [GoToBallTask, ShootTask])
NOISY = {
    "noise": {"robot_position": 0.002, "ball_position": 0.002, "heading": 0.01},
    "latency": 1,
    "velocities": "finite_difference",
    "randomisation": {"friction": (0.5, 1.5), "mass": (0.8, 1.2), "control_delay": (0, 0.04)},
}


SETTINGS = {
    GoToBallTask: GoToBallSettings,
    ShootTask: ShootSettings,
    ScoreOnGoalkeeperTask: ScoreOnGoalkeeperSettings,
}


def make_settings(kind: Any, changes: dict[str, Any]) -> Any:
    return SETTINGS[kind].model_validate(changes)


def noisy(kind: Any, n: int, seed: int) -> ArenaTask:
    made: ArenaTask = kind(make_settings(kind, NOISY), n, seed)
    return made


def trace(task: ArenaTask, ticks: int, seed: int | None = None) -> list[bytes]:
    rng = np.random.default_rng(9)
    parts = [task.reset(seed).tobytes()]
    for _ in range(ticks):
        result = task.step(rng.uniform(-1, 1, (task.n, task.action_size)))
        parts += [
            result.observation.tobytes(),
            result.final_observation.tobytes(),
            result.reward.tobytes(),
            result.terminated.tobytes() + result.truncated.tobytes() + result.success.tobytes(),
        ]
    return parts


@pytest.mark.integration
@BOTH
def test_an_arena_among_many_moves_as_it_would_alone(kind: Any) -> None:
    many = kind(n=25)
    starts = many.sample_starts(31, 25)
    alone = [kind() for _ in range(25)]
    seen = many.reset_to(starts, seed=0)
    for i, one in enumerate(alone):
        np.testing.assert_allclose(one.reset_to(starts[i], seed=0)[0], seen[i], rtol=0, atol=1e-9)
    rng = np.random.default_rng(32)
    running = np.ones(25, dtype=bool)
    actions = rng.uniform(-1, 1, (25, many.action_size))
    for tick in range(60):
        if tick % 10 == 0:
            actions = rng.uniform(-1, 1, (25, many.action_size))
            # Kicks late, so that the ball is carried first; drives long, so that balls are met.
            actions[:, -1] -= 0.7
        together = many.advance(actions)
        for i in np.flatnonzero(running):
            single = alone[i].advance(actions[i : i + 1])
            np.testing.assert_allclose(single.observation[0], together.observation[i], rtol=0, atol=1e-9)
            np.testing.assert_allclose(single.reward[0], together.reward[i], rtol=0, atol=1e-9)
            assert single.terminated[0] == together.terminated[i]
            # Until the first contact; a ball in the mouth has to be the same all along.
            if together.terminated[i] or (kind is GoToBallTask and many.arenas.touch[i] >= 0):
                running[i] = False


@BOTH
@pytest.mark.parametrize("n", [1, 7])
def test_the_same_seed_gives_the_same_run_bit_for_bit(kind: Any, n: int) -> None:
    assert trace(kind(n=n, seed=5), 120) == trace(kind(n=n, seed=5), 120)
    assert trace(kind(n=n, seed=5), 20) != trace(kind(n=n, seed=6), 20)


@pytest.mark.parametrize("kind", [GoToBallTask, ShootTask, ScoreOnGoalkeeperTask])
def test_an_arenas_history_follows_from_the_seed_and_its_index_alone(kind: Any) -> None:
    rng = np.random.default_rng(1)
    settings = make_settings(kind, NOISY)
    one, many = kind(settings, 1, seed=5), kind(settings, 64, seed=5)
    np.testing.assert_array_equal(one.reset()[0], many.reset()[0])
    ended = 0
    actions = rng.uniform(-1, 1, (64, one.action_size))
    for tick in range(250):
        if tick % 10 == 0:
            actions = rng.uniform(-1, 1, (64, one.action_size))
        alone, among = one.step(actions[:1]), many.step(actions)
        np.testing.assert_array_equal(alone.observation[0], among.observation[0])
        np.testing.assert_array_equal(alone.final_observation[0], among.final_observation[0])
        assert alone.reward[0] == among.reward[0]
        ended += int(alone.terminated[0] or alone.truncated[0])
        assert alone.success[0] == among.success[0]
    assert ended >= (kind is not GoToBallTask)


@BOTH
def test_a_reset_run_is_a_new_run_bit_for_bit(kind: Any) -> None:
    used = noisy(kind, 5, 1)
    trace(used, 150)
    assert trace(used, 150, seed=8) == trace(noisy(kind, 5, 8), 150)


def test_a_reset_without_a_seed_goes_on() -> None:
    task = GoToBallTask(n=3, seed=1)
    first, second = task.reset(), task.reset()
    assert (first != second).any()
    other = GoToBallTask(n=3, seed=1)
    other.reset()
    np.testing.assert_array_equal(other.reset(), second)


def test_sampling_starts_leaves_the_run_as_it_is() -> None:
    one, other = GoToBallTask(n=3, seed=1), GoToBallTask(n=3, seed=1)
    one.sample_starts(1, 100)
    np.testing.assert_array_equal(one.reset(), other.reset())
    np.testing.assert_array_equal(one.sample_starts(4, 10), other.sample_starts(4, 10))


def test_an_episode_that_ends_starts_anew_in_the_same_step() -> None:
    near = [0, 0, 0, 0, 0, 0, 0.19, 0, 0, 0]
    far = [0, 0, 0, 0, 0, 0, 3.0, 0, 0, 0]
    task = GoToBallTask(n=2)
    task.reset_to([near, far, [1, 1, 0, 0, 0, 0, 2.5, 1, 0, 0]], seed=0)
    result = task.step(np.zeros((2, 3)))
    assert result.terminated.tolist() == [True, False]
    assert result.final_observation[0, 2] == pytest.approx(0.19, abs=1e-6)
    assert result.observation[0, 2] == pytest.approx(1.5)
    np.testing.assert_array_equal(result.observation[1], result.final_observation[1])
    assert task.ended is not None
    assert task.ended.start.tolist() == [0]
    assert task.ended.ticks.tolist() == [1]
    # The new episode is looked at from its own start.
    assert task.step(np.zeros((2, 3))).observation[0, 2] == pytest.approx(1.5)
    assert task.ended is None


def test_what_a_step_returns_is_not_touched_by_the_next() -> None:
    task = GoToBallTask(n=4, seed=0)
    task.reset()
    result = task.step(np.ones((4, 3)))
    kept = [array.copy() for array in (result.observation, result.reward, result.final_observation)]
    result.observation[:] = 7.0
    task.step(np.ones((4, 3)))
    np.testing.assert_array_equal(kept[1], result.reward)
    np.testing.assert_array_equal(kept[2], result.final_observation)


@pytest.mark.integration
@pytest.mark.parametrize("n", [1, 16, 300])
def test_every_start_is_counted_once_whatever_the_number_of_arenas(n: int) -> None:
    task = GoToBallTask(GoToBallSettings(time_limit=60), n=n, seed=0)
    starts = task.sample_starts(41, 100)
    episodes = run_starts(task, straight_drive, starts)
    assert episodes.start.tolist() == list(range(100))
    way = np.hypot(starts[:, 6] - starts[:, 0], starts[:, 7] - starts[:, 1]) - 0.2
    limits = task.settings.robot_limits
    np.testing.assert_allclose(episodes.optimum, straight_line_time(way, 1.5, limits.acceleration))
    assert 0.05 < episodes.success.mean() < 0.95
    assert (episodes.ticks[~episodes.success] == 60).all()
    assert (episodes.truncated == ~episodes.success).all()


def test_the_outcome_does_not_depend_on_the_number_of_arenas() -> None:
    starts = ShootTask().sample_starts(42, 60)
    few = run_starts(ShootTask(n=7), turn_and_kick, starts)
    many = run_starts(ShootTask(n=60), turn_and_kick, starts)
    np.testing.assert_array_equal(few.success, many.success)
    np.testing.assert_array_equal(few.ticks, many.ticks)
    np.testing.assert_allclose(few.total_reward, many.total_reward, atol=1e-6)


def test_the_total_reward_is_added_up() -> None:
    task = GoToBallTask(n=1)
    task.reset_to([[0, 0, 0, 0, 0, 0, 1.0, 0, 0, 0]], seed=0)
    total, done = 0.0, False
    while not done:
        result = task.step(np.array([[1.0, 0, 0]]))
        total += float(result.reward[0])
        done = bool(result.terminated[0])
    assert task.ended is not None
    assert task.ended.total_reward[0] == pytest.approx(total)


@BOTH
def test_wrong_actions_are_refused_and_change_nothing(kind: Any) -> None:
    task = kind(n=2, seed=0)
    task.reset()
    before = task.arenas.robots.copy()
    with pytest.raises(ValueError, match=r"actions must have the shape \(2, "):
        task.step(np.zeros((2, 7)))
    with pytest.raises(ValueError, match="not finite"):
        task.step(np.full((2, task.action_size), np.nan))
    np.testing.assert_array_equal(task.arenas.robots, before)


def test_wrong_starts_are_refused() -> None:
    task = GoToBallTask()
    with pytest.raises(ValueError, match=r"\(m, 10\)"):
        task.reset_to(np.zeros((2, 7)))
    with pytest.raises(ValueError, match="not finite"):
        task.reset_to(np.full((1, 10), np.inf))
    with pytest.raises(ValueError, match="outside the walls"):
        task.reset_to([[0, 0, 0, 0, 0, 0, 9.0, 0, 0, 0]])
    with pytest.raises(ValueError, match="at least 1"):
        GoToBallTask(n=0)


def test_the_ball_and_the_walls_are_there() -> None:
    settings = GoToBallSettings.model_validate({"contact": {"distance": 0.06}})
    task = GoToBallTask(settings)
    task.reset_to([[3.5, 0.8, 0, 0, 0, 0, 4.0, 0.8, 0, 0]], seed=0)
    for _ in range(100):
        task.step(np.array([[1.0, 0, 0]]))
    arenas, field = task.arenas, settings.field
    assert arenas.touch[0] == 0
    assert arenas.balls[0, 0] > 4.3
    assert arenas.robots[0, 0, 0] < field.half_length + field.margin - 0.085


def test_the_default_has_four_physics_steps_a_tick_of_30_ms() -> None:
    task = GoToBallTask()
    task.reset()
    assert task.arenas.sub_steps == 4
    assert task.arenas.period == 0.030
