"""The baselines: cells of ours and of Stable-Baselines3, once each, and what is made of them."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from benchmarks import baselines
from robobt.skills import GoToBall, LearnedSkill


def run(monkeypatch: pytest.MonkeyPatch, out: Path, *given: str) -> list[dict]:
    tiny = {"task": "GoToBall", "seeds": 1, "cpu-seconds": 0.2, "parts": 2, "validation": 4, "starts": 10}
    options = [f"--{name}={value}" for name, value in tiny.items()]
    monkeypatch.setattr(sys, "argv", ["baselines", f"--out={out}", *options, *given])
    baselines.main()
    return [json.loads(line) for line in (out / "baselines.jsonl").read_text().splitlines()]


def test_a_cell_is_trained_once_and_is_in_table_and_curves(monkeypatch, tmp_path, capsys) -> None:
    (cell,) = run(monkeypatch, tmp_path, "--algorithm", "ppo")
    assert cell["held_out"]["success"]["n"] == 10
    assert cell["cpu_s"] >= 0.2
    assert cell["curve"][0][0] == 0
    assert cell["curve"][-1][0] == cell["steps"] > 0
    assert run(monkeypatch, tmp_path, "--algorithm", "ppo") == [cell]
    picture = tmp_path / "curves.svg"
    capsys.readouterr()
    run(monkeypatch, tmp_path, "--table", "--curves", str(picture))
    share = 100 * cell["held_out"]["success"]["value"]
    assert f"| GoToBall | {share:.1f} % (1) |  |  |  |  |" in capsys.readouterr().out
    assert "GoToBall" in picture.read_text()
    with pytest.raises(SystemExit):
        run(monkeypatch, tmp_path, "--table", "--cpu-seconds", "7")
    assert "no cells of 7 CPU seconds; there are some of 0.2" in capsys.readouterr().err


def test_a_policy_trained_by_stable_baselines3_is_a_skill(monkeypatch, tmp_path) -> None:
    pytest.importorskip("stable_baselines3", reason="the comparison with Stable-Baselines3 needs it")
    (cell,) = run(monkeypatch, tmp_path, "--algorithm", "sb3_td3")
    assert cell["cpu_s"] >= 0.2
    assert cell["curve"][-1][0] == cell["steps"] > 0
    assert GoToBall(policy=cell["model"]).policy == cell["model"]
    assert LearnedSkill(model=cell["model"]).model == cell["model"]


def test_a_line_that_was_cut_off_is_no_cell_and_spoils_none(tmp_path) -> None:
    file = tmp_path / "baselines.jsonl"
    baselines.add_cell(file, {"seed": 0})
    file.write_bytes(file.read_bytes() + b'{"seed": 1, "curv')
    assert baselines.read_cells(file) == [{"seed": 0}]
    baselines.add_cell(file, {"seed": 1})
    assert baselines.read_cells(file) == [{"seed": 0}, {"seed": 1}]
    assert file.read_text() == '{"seed": 0}\n{"seed": 1}\n'


def test_the_table_tells_median_range_and_number_of_seeds() -> None:
    def cell(seed: int, share: float) -> dict:
        found = {"success": {"value": share}}
        return {"task": "Save", "algorithm": "ppo", "seed": seed, "steps": 2000, "held_out": found}

    told = baselines.table([cell(0, 0.5), cell(1, 0.9), cell(2, 0.6)], ["Shoot", "Save"], {"ppo": "PPO"})
    assert "| Save | 60.0 % (50.0 to 90.0; 3) |" in told
    assert "| Save | 2 |" in told
    assert "Shoot" not in told
