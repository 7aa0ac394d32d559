"""Every command in the README and in the start page's tour works, and the README's Python."""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path

import pytest
from typer.testing import CliRunner

from robobt.match import load_scenario
from robobt.plays import PLAYS
from tests.programs import PROGRAMS, program_and_words
from tests.registries import temporarily

ROOT = Path(__file__).parent.parent
README, TOUR = (
    re.findall(r"```(\w+)\n(.*?)```", text, re.DOTALL)
    for text in (
        (ROOT / "README.md").read_text(),
        (ROOT / "docs" / "index.md").read_text().partition("## 3. ")[2],
    )
)


def commands(blocks: list[tuple[str, str]]) -> list[str]:
    lines = [
        line.split("#")[0].strip() for kind, block in blocks if kind == "sh" for line in block.splitlines()
    ]
    return [line for line in lines if line]


def test_the_readme_is_one_screen() -> None:
    assert len((ROOT / "README.md").read_text().splitlines()) <= 80


def test_the_two_commands_exist() -> None:
    assert commands(README) == ["make match", "make test"]
    for command in commands(README):
        done = subprocess.run(
            [*command.split(), "--dry-run"], cwd=ROOT, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr


@pytest.mark.integration
def test_the_robobt_commands_run_one_after_the_other(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As they stand there, but that matches and evaluations are shorter, and played by this process alone."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0}, raising=False)
    monkeypatch.setattr(
        "robobt.match.load_scenario", lambda source, **how: load_scenario(source, **how).lasting(4.0)
    )
    fewer = [option for name in ("starts", "held_out") for option in ("--set", f"evaluation.{name}=20")]
    for command in commands(TOUR):
        program, arguments = program_and_words(command)
        done = CliRunner().invoke(
            PROGRAMS[program], [*arguments, *(fewer if arguments[0] == "train" else [])]
        )
        assert done.exit_code == 0, f"{command}: {done.output}"
    assert (tmp_path / "out/six.html").stat().st_size > 100_000


def test_the_python_in_it_runs_and_plays(capsys: pytest.CaptureFixture[str]) -> None:
    blocks = [block for kind, block in README if kind == "python"]
    scope: dict[str, object] = {}
    with temporarily(PLAYS):
        exec("".join(blocks), scope)
    assert scope["my_striker"]().name == "my striker"  # type: ignore[operator]
    assert "rate=" in capsys.readouterr().out
