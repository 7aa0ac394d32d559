"""The comparison with VMAS steps six learners of ours."""

from __future__ import annotations

from benchmarks import vmas_football as football


def test_six_learners_step_with_observations_and_rewards() -> None:
    step, period = football.ours(3)
    result = step()
    assert period == 0.06
    assert result.observation.shape[0] == 3
    assert result.observation.shape[1] % 6 == 0
    assert result.reward.shape == (3,)
    assert football.chunk(step) > 0.0
