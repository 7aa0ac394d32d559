from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest

from robobt.skills import GoToBall, LearnedSkill

SCRIPT = Path(__file__).parents[2] / "benchmarks" / "sb3_peers.py"


def test_a_policy_trained_by_stable_baselines3_is_a_skill(tmp_path):
    pytest.importorskip("stable_baselines3", reason="the comparison with Stable-Baselines3 needs it")
    spec = importlib.util.spec_from_file_location("sb3_peers", SCRIPT)
    peers = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(peers)
    told = peers.train_peer("go_to_ball", "td3", seed=0, steps=200, every=150, starts=10, out=tmp_path)
    assert told["steps"] == 200
    assert told["held_out"]["success"]["n"] == 10
    assert GoToBall(policy=told["file"]).policy == told["file"]
    assert LearnedSkill(model=told["file"]).model == told["file"]
