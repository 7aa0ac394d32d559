from __future__ import annotations

import pytest

from benchmarks.policy import bench_policy


@pytest.mark.parametrize("model", ["go_to_ball_ddpg", "shoot_ddpg"])
def test_a_leaf_asks_its_network_in_every_tick_that_is_measured(model: str) -> None:
    figures = bench_policy(model, rounds=5, calls=40)
    assert figures["leaf_to_module_ratio"] > 1.0
    assert figures["skill_to_module_ratio"] > 1.0
