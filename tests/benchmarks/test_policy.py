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
    assert "team_ms" not in figures
    # So a leaf is never cheaper than its network.
    assert figures["leaf_to_module_ratio"] > 1.0
    assert figures["skill_to_module_ratio"] > 1.0


def test_the_time_of_a_team_is_that_of_all_its_robots() -> None:
    figures = bench_policy("small3v3_ppo", rounds=5, calls=40, robots=11)
    assert figures["team_ms"] == pytest.approx(11 * figures["leaf_us"] / 1000)
    # A robot that decides every 60 ms is asked in every tick, so it takes longer than its network.
    assert figures["leaf_us"] > figures["module_us"]
