"""Every tutorial runs as a script, with smaller numbers, prints what a reader expects, and is a page."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from mkdocs_hooks import tutorial
from robobt.plays import PLAYS
from robobt.skills import SKILLS
from tests.registries import temporarily

EXAMPLES = Path(__file__).parent.parent / "examples"

EXPECTED: dict[str, tuple[dict[str, float], list[str]]] = {
    "01_compose_a_play.py": ({}, ["win the ball", "goal_blue after"]),
    "02_attack_against_a_goalkeeper.py": (
        {"TRIALS": 3},
        ["segment_clearance", "moving_horizon", "scored"],
    ),
    "03_write_your_own_skill.py": ({}, ["in a match: goal_blue"]),
    "04_six_against_six.py": ({"SECONDS": 4.0}, ["PREPARE_KICKOFF", "ball in play", "blue 0"]),
    "05_train_a_skill.py": (
        {"STEPS": 2000},
        ["held out", "written: out/models/example.pt", "goals of 5"],
    ),
    "06_judge_shots.py": ({"SHOTS": 60, "TRIALS": 3}, ["unseen shots", "attack_expected"]),
    "07_play_over_the_network.py": ({"TRIALS": 1}, ["of 1 scored over the network"]),
    "08_tournament.py": ({"ROUNDS": 1, "SECONDS": 2.0}, ["team_player    Elo", "in 2 matches"]),
    "09_play_live.py": ({"SECONDS": 2.0, "SPEED": 20.0}, ["Live: http://", "after 2 s"]),
}


def test_every_example_is_tested() -> None:
    assert sorted(EXPECTED) == sorted(path.name for path in EXAMPLES.glob("*.py"))


@pytest.mark.integration
@pytest.mark.parametrize("name", EXPECTED)
def test_an_example_runs(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    numbers, words = EXPECTED[name]
    script = (EXAMPLES / name).read_text()
    for constant, value in numbers.items():
        script, found = re.subn(rf"(?m)^{constant} = [\d_.]+$", f"{constant} = {value}", script)
        assert found == 1
    monkeypatch.chdir(tmp_path)
    with temporarily(PLAYS), temporarily(SKILLS):
        exec(compile(script, name, "exec"), {"__name__": "__main__"})
    printed = capsys.readouterr().out
    for word in words:
        assert word in printed


@pytest.mark.parametrize("name", EXPECTED)
def test_an_examples_page_holds_all_of_its_code_and_prose(name: str) -> None:
    script = (EXAMPLES / name).read_text()
    page = tutorial(script)
    assert page.startswith("# ")
    assert "%%" not in page
    blocks = re.findall(r"```python\n(.*?)\n```", page, re.DOTALL)
    code = [line for line in script.splitlines() if line and not line.startswith("#")]
    assert [line for block in blocks for line in block.splitlines() if line and line[0] != "#"] == code
    prose = re.sub(r"```python\n.*?\n```", "", page, flags=re.DOTALL)
    said = re.findall(r"(?m)^# (?!%%)(.*)$", script)
    assert [line for line in said if line not in prose and line not in "".join(blocks)] == []
