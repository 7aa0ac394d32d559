"""Every example runs as its own text says and prints what a reader expects."""

from __future__ import annotations

import runpy
import sys
from pathlib import Path

import pytest

from robobt.plays import PLAYS
from robobt.skills import SKILLS
from tests.registries import temporarily

EXAMPLES = Path(__file__).parent.parent / "examples"

EXPECTED = {
    "01_compose_a_play.py": ([], ["win the ball", "goal_blue after"]),
    "02_attack_against_a_goalkeeper.py": (["3"], ["segment_clearance", "moving_horizon", "scored"]),
    "03_write_your_own_skill.py": ([], ["alone: RUNNING", "in a match: goal_blue"]),
    "04_six_against_six.py": (["4"], ["PREPARE_KICKOFF", "ball in play", "blue 0"]),
    "05_train_a_skill.py": (["2000"], ["held out", "written: out/models/example.pt", "goals of 5"]),
    "06_judge_shots.py": (["60", "3"], ["unseen shots", "attack_expected"]),
    "07_play_over_the_network.py": (["1"], ["of 1 scored over the network"]),
}


def test_every_example_is_tested() -> None:
    assert sorted(EXPECTED) == sorted(path.name for path in EXAMPLES.glob("*.py"))


@pytest.mark.integration
@pytest.mark.parametrize("name", EXPECTED)
def test_an_example_runs(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments, words = EXPECTED[name]
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", [name, *arguments])
    with temporarily(PLAYS), temporarily(SKILLS):
        runpy.run_path(str(EXAMPLES / name), run_name="__main__")
    printed = capsys.readouterr().out
    for word in words:
        assert word in printed
