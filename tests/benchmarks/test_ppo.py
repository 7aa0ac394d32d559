from __future__ import annotations

import pytest

from benchmarks.ppo import PARTS, bench_ppo
from robobt.learning.agents.settings import PPOSettings


@pytest.mark.integration
def test_both_learn_for_the_same_steps_and_all_their_time_is_told() -> None:
    pytest.importorskip("stable_baselines3", reason="the comparison with Stable-Baselines3 needs it")
    figures = bench_ppo("go_to_ball", seeds=2, steps=1, starts=10)
    rollout = 128 * PPOSettings().num_steps
    pairs = list(zip(figures["robobt"]["seeds"], figures["sb3"]["seeds"], strict=True))
    for pair in pairs:
        assert [one["steps"] for one in pair] == [rollout, rollout]
        for one in pair:
            assert sum(one[part] for part in PARTS) == pytest.approx(1e6 / one["steps_per_s"])
            assert all(one[part] > 0.0 for part in PARTS)
    ratios = [ours["steps_per_s"] / theirs["steps_per_s"] for ours, theirs in pairs]
    assert min(ratios) <= figures["speed_ratio"] <= max(ratios)
    differences = [ours["return"] - theirs["return"] for ours, theirs in pairs]
    assert figures["return_difference"]["mean"] == pytest.approx(sum(differences) / 2)
