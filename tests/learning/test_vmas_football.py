"""The comparison with VMAS steps six learners of ours."""

from __future__ import annotations

import importlib.util
from pathlib import Path

SCRIPT = Path(__file__).parents[2] / "benchmarks" / "vmas_football.py"


def test_six_learners_step_with_observations_and_rewards() -> None:
    spec = importlib.util.spec_from_file_location("vmas_football", SCRIPT)
    assert spec is not None
    assert spec.loader is not None
    football = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(football)
    step, period = football.ours(3)
    result = step()
    assert period == 0.06
    assert result.observation.shape[0] == 3
    assert result.observation.shape[1] % 6 == 0
    assert result.reward.shape == (3,)
    assert football.chunk(step) > 0.0
