"""Each term of a reward is told by its name, and together they are the reward."""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
import pytest

from robobt.learning import TASKS
from robobt.learning.envs import make_task


@pytest.mark.parametrize("name", TASKS)
def test_the_terms_of_an_episode_add_up_to_what_it_earned(name: str) -> None:
    task = make_task(TASKS[name].Settings.model_validate({"time_limit": 120}), 16)
    task.reset(1)
    rng, seen = np.random.default_rng(0), 0
    for tick in range(200):
        if tick % 8 == 0:
            actions = rng.uniform(-1, 1, (16, task.action_size))
        task.step(actions)
        if task.ended is not None:
            terms = task.ended.terms
            assert terms.dtype.names
            total = sum([terms[each] for each in terms.dtype.names])
            np.testing.assert_allclose(total, task.ended.total_reward, atol=1e-9)
            seen += len(task.ended)
    assert seen >= 16


def test_a_term_without_weight_brings_nothing_and_a_weight_scales_its_own_alone() -> None:
    def terms(**weights: float) -> Any:
        settings = {"time_limit": 50, "starts": {"distance": [2.0, 100.0]}, "reward": weights}
        task = make_task(TASKS["go_to_ball"].Settings.model_validate(settings), 4)
        task.reset(1)
        while task.ended is None:
            task.step(np.full((4, 3), 0.3))
        return task.ended.terms

    plain, doubled = terms(), terms(distance=2.0)
    np.testing.assert_allclose(doubled["distance"], 2.0 * plain["distance"])
    np.testing.assert_array_equal(doubled["orientation"], plain["orientation"])
    assert (plain["orientation"] > 0.0).all()
    assert (plain["time"] == 0.0).all()


def test_infos_tell_the_terms_of_an_episode_that_has_ended() -> None:
    env = gymnasium.make("GoToBall-v0", settings={"time_limit": 20})
    env.reset(seed=0)
    done = False
    total = 0.0
    while not done:
        _, reward, terminated, truncated, info = env.step(np.zeros(3, dtype=np.float32))
        total += float(reward)
        done = terminated or truncated
    told = {key: value for key, value in info.items() if key.startswith("reward/")}
    assert set(told) == {f"reward/{name}" for name in TASKS["go_to_ball"].terms.names}
    assert sum(told.values()) == pytest.approx(total)
    many = gymnasium.make_vec(
        "Duel-v0", 4, vectorization_mode="vector_entry_point", settings={"time_limit": 2}
    )
    many.reset(seed=0)
    *_, info = many.step(np.zeros((4, 4), dtype=np.float32))
    assert info["final_info"]["reward/time"] == pytest.approx(np.full(4, -0.004))
    assert info["final_info"]["_reward/time"].all()
