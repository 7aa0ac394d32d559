from __future__ import annotations

from collections.abc import Callable

import pytest
from numpy.typing import ArrayLike

from benchmarks.policy import bench_policy
from robobt.models.policy import Policy


@pytest.mark.parametrize("model", ["go_to_ball_ddpg", "shoot_ddpg"])
def test_a_leaf_asks_its_network_in_every_tick_that_is_measured(
    model: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = 0
    single = Policy.single

    def counted(policy: Policy) -> Callable[[ArrayLike], list[float]]:
        infer = single(policy)

        def told(observation: ArrayLike) -> list[float]:
            nonlocal asked
            asked += 1
            return infer(observation)

        return told

    monkeypatch.setattr(Policy, "single", counted)
    figures = bench_policy(model, rounds=5, calls=40)
    # The leaf and the skill, in five rounds and in one that does not count.
    assert asked == 2 * (5 + 1) * 40
    # So a leaf is never cheaper than its network.
    assert figures["leaf_to_module_ratio"] > 1.0
    assert figures["skill_to_module_ratio"] > 1.0
