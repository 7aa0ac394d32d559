"""``robobt challenge``: rows, recordings, and the table of results."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

from robobt.challenges.run import ChallengeEntry, RunResult
from robobt.challenges.table import append_row, row_of
from robobt.cli import app

QUICK = ("--trials", "2", "--workers", "1", "--set", "ends.time_limit=0.3")


def run(*options: object, code: int = 0) -> str:
    shown = CliRunner().invoke(app, [str(option) for option in options])
    assert shown.exit_code == code, shown.output
    return shown.output


@pytest.mark.integration
def test_rows_are_kept_and_repeat_bit_for_bit(tmp_path: Path) -> None:
    out = tmp_path / "kept"
    said = json.loads(
        run("challenge", "passing", "--blue", "ours", "--blue", "chance", *QUICK, "--out", out, "--json")
    )
    assert [row["entrant"] for row in said["rows"]] == ["ours", "chance"]
    assert said["rows"][1]["blue"] == "stand_still"
    assert [Path(file).name for file in said["recordings"]["ours"]["best"]] == [
        "passing-ours-seed1-best-match.robobt.arrows"
    ]
    table = out / "results.jsonl"
    again = json.loads(run("challenge", "table", table, "--check", "--workers", "1", "--json"))
    assert again["rows"] == said["rows"]
    assert again["repeated"] == [True, True]
    text = table.read_text()
    table.write_text(text.replace(said["rows"][0]["trace"], "0" * 32))
    shown = run("challenge", "table", table, "--check", "--workers", "1", code=1)
    assert "differs" in shown
    assert "equal" in shown


@pytest.mark.integration
def test_a_single_trial_is_recorded_once(tmp_path: Path) -> None:
    given = ("--trials", "1", "--set", "ends.time_limit=0.3", "--out", tmp_path / "one", "--json")
    recordings = json.loads(run("challenge", "passing", *given))["recordings"]["ours"]
    assert list(recordings) == ["best"]
    assert [Path(file).exists() for file in recordings["best"]] == [True]
    assert not list((tmp_path / "one").glob("*worst*"))


@pytest.mark.integration
def test_recordings_of_another_seed_are_not_replaced(tmp_path: Path) -> None:
    out = tmp_path / "kept"
    quick = ("--trials", "1", "--workers", "1", "--set", "ends.time_limit=0.1", "--out", out)
    for seed in (1, 2):
        run("challenge", "passing", "--blue", "stand_still", *quick, "--seed", seed)
    assert len(list(out.glob("*.robobt.arrows"))) == 2
    assert len((out / "results.jsonl").read_text().splitlines()) == 2


def test_realism_and_a_changed_delay_go_together() -> None:
    given = ("--realism", "realistic", "--set", "simulator.realism.command_delay=0.065", "--trials", "1")
    said = json.loads(run("challenge", "passing", *given, "--set", "ends.time_limit=0.1", "--json"))
    realism = said["rows"][0]["settings"]
    assert realism["simulator.realism"]["ball_noise"] == 0.0014
    assert realism["simulator.realism.command_delay"] == 0.065


def test_what_does_not_fit_is_refused() -> None:
    assert "no challenge is called 'passin'" in run("challenge", "passin", code=2)
    assert "needs a file of results" in run("challenge", "table", code=2)
    assert "is for 'robobt challenge table'" in run("challenge", "passing", "--check", code=2)
    unknown = run("challenge", "passing", "--blue", "nobody", code=2)
    assert "no play or row is called 'nobody'; rows: ours, november, script, chance" in unknown


@pytest.mark.parametrize(
    ("field", "value", "problem"),
    [
        ("challenge", "passin", "challenge: no challenge is called 'passin'"),
        ("blue", "nobody", "no play is called 'nobody'"),
        ("settings", {"speed": 1}, "speed: there is no such field"),
    ],
)
def test_a_row_that_cannot_be_played_again_is_named(
    tmp_path: Path, field: str, value: object, problem: str
) -> None:
    entry = ChallengeEntry("passing", ("stand_still", {}))
    row = row_of(entry, "ours", 1, [RunResult(0, 1, {"passes": 1.0}, "a")])
    file = tmp_path / "results.jsonl"
    append_row(file, replace(row, **{field: value}))  # type: ignore[arg-type]
    append_row(file, replace(row, settings={"ends.time_limit": 0.05}))
    shown = " ".join(run("challenge", "table", file, "--check", "--workers", "1", code=1).split())
    assert "results.jsonl, row 1: " in shown
    assert problem in shown
    # The rows after it are played all the same.
    assert "not played" in shown
    assert "differs" in shown


def test_a_row_holds_the_commit_with_which_its_runs_began(monkeypatch: pytest.MonkeyPatch) -> None:
    now = {"commit": "before"}

    def played(*_given: object) -> list[RunResult]:
        now["commit"] = "after"
        return [RunResult(0, 1, {"passes": 1.0}, "a")]

    monkeypatch.setattr("robobt.config.commit.source_commit", lambda: now["commit"])
    monkeypatch.setattr("robobt.challenges.run.play_runs", played)
    said = json.loads(run("challenge", "passing", "--trials", "1", "--json"))
    assert said["rows"][0]["commit"] == "before"


def test_challenges_are_listed_with_their_rules() -> None:
    shown = run("list", "challenges")
    assert "passing" in shown


FAILING = """
from robobt.plays.base import PLAYS
from robobt.skills.base import Skill, skill


@skill
class FailsHere(Skill):
    def on_running(self):
        raise RuntimeError("no way on")


@PLAYS.register("fails_here")
def fails_here():
    return FailsHere()
"""


@pytest.mark.integration
def test_a_tree_that_fails_is_told_with_its_place_and_its_row_is_kept(tmp_path: Path) -> None:
    own, out = tmp_path / "own.py", tmp_path / "kept"
    own.write_text(FAILING)
    said = run("challenge", "passing", "--blue", "fails_here", "--import", own, *QUICK, "--out", out, code=3)
    assert "FailsHere: RuntimeError: no way on (own.py:9)" in " ".join(said.split())
    assert len((out / "results.jsonl").read_text().splitlines()) == 1
