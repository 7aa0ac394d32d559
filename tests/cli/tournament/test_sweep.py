"""``robobt tournament sweep``."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from robobt.cli import app
from robobt.tournament.fixtures import Fixture
from robobt.tournament.job import Job
from robobt.tournament.played import PlayedMatch, SideResult
from robobt.world.game import Team
from tests.tournament.made_up import played

QUICK = ("--scenario", "striker_vs_goalkeeper", "--candidates", "6", "--concurrent", "2", "--rounds", "3")


def invoke(*options: object) -> Result:
    return CliRunner().invoke(app, ["tournament", "sweep", *map(str, options), "--workers", "0"])


@pytest.fixture
def _decided(monkeypatch: pytest.MonkeyPatch) -> None:
    """Who runs at 0.8 m/s or more wins against the play as it is, the others lose."""

    def decided(_: Job, fixture: Fixture, __: object) -> PlayedMatch:
        name = fixture.blue if "=" in fixture.blue else fixture.yellow
        wins = float(name.rpartition("speed_factor=")[2]) >= 0.8
        return played(*fixture, (1, 0) if (name == fixture.blue) is wins else (0, 1))

    monkeypatch.setattr(Job, "play", decided)


@pytest.mark.usefixtures("_decided")
def test_candidates_are_tried_told_and_the_best_is_confirmed(tmp_path: Path) -> None:
    given = ("attack_main", "--vary", "speed_factor=0.5:1.0", *QUICK, "--sprt", "0", "100")
    shown = invoke(*given, "--out", tmp_path / "a.sqlite", "--json")
    assert shown.exit_code == 0, shown.output
    said = json.loads(shown.stdout)
    assert [one["number"] for one in said["candidates"]] == list(range(6))
    assert {one["score"] for one in said["candidates"]} == {0.0, 1.0}
    assert said["best"]["name"].startswith("attack_main:speed_factor=0.")
    assert said["best"]["params"]["speed_factor"] >= 0.8
    assert said["sprt"]["verdict"] == "better"
    table = invoke(*given, "--out", tmp_path / "a.sqlite")
    assert table.exit_code == 0
    assert f"Best: {said['best']['name']}" in table.output
    assert "is better than attack_main after" in " ".join(table.output.split())


@pytest.mark.usefixtures("_decided")
def test_where_no_candidate_does_better_nothing_is_tested() -> None:
    shown = invoke("attack_main", "--vary", "speed_factor=0.5:0.6", *QUICK, "--json")
    assert (shown.exit_code, json.loads(shown.stdout)["sprt"]) == (1, None)
    assert (
        "No candidate did better." in invoke("attack_main", "--vary", "speed_factor=0.5:0.6", *QUICK).output
    )


@pytest.mark.parametrize(
    ("errors", "told"),
    [(3, "trees failed in 6 ticks; the first: it fails"), (0, "lost by rule: it fails")],
)
def test_what_goes_wrong_in_candidates_is_told(
    monkeypatch: pytest.MonkeyPatch, errors: int, told: str
) -> None:
    def decided(_: Job, fixture: Fixture, __: object) -> PlayedMatch:
        side = SideResult(errors=errors, first_error="it fails")
        return replace(played(*fixture), sides={team.value: side for team in Team})

    monkeypatch.setattr(Job, "play", decided)
    shown = invoke("attack_main", "--vary", "rater=open_angle,nn_filtered", *QUICK, "--rounds", "1", "--json")
    assert f"attack_main:rater=open_angle: {told}" in " ".join(shown.stderr.split())
    assert {one["first_error"] for one in json.loads(shown.stdout)["candidates"]} == {"it fails"}


@pytest.mark.integration
def test_a_sweep_is_played() -> None:
    quick = (*QUICK, "--set", "ends.time_limit=0.3", "--candidates", "2", "--rounds", "1")
    shown = invoke("attack_main:speed_factor=0.5", "--vary", "rater=open_angle,nn_filtered", *quick, "--json")
    said = json.loads(shown.stdout)
    names = {f"attack_main:speed_factor=0.5,rater={rater}" for rater in ("open_angle", "nn_filtered")}
    assert {one["name"] for one in said["candidates"]} <= names
    assert said["against"] == "attack_main:speed_factor=0.5"
    assert {one["rounds"] for one in said["candidates"]} == {1}


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        (("attack_mian", "--vary", "speed_factor=1,2"), "no play is called 'attack_mian'"),
        (
            ("mine.yaml", "--vary", "speed_factor=1,2"),
            "mine.yaml is a file; a sweep tunes a play by its name",
        ),
        (("my_plays.py", "--vary", "speed_factor=1,2"), "my_plays.py: cannot be read"),
        (("attack_main", "--vary", "sped=1,2"), "sped: attack_main has no such parameter"),
        (("attack_main", "--vary", "speed_factor=1,2", "--against", "attack_mian"), "no play is called"),
    ],
)
def test_what_cannot_be_swept_is_told_in_one_line(options: tuple[str, ...], problem: str) -> None:
    shown = invoke(*options, "--scenario", "striker_vs_goalkeeper")
    assert shown.exit_code in (1, 2)
    assert problem in " ".join(shown.output.replace("│", " ").split())


@pytest.mark.usefixtures("_decided")
@pytest.mark.parametrize(
    "where", ["robobt.tournament.sweeps.search._judge", "robobt.tournament.sweeps.sweep.play_tournament"]
)
def test_ctrl_c_while_nothing_is_played_tells_what_was_kept(
    where: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def stopped(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(where, stopped)
    given = ("attack_main", "--vary", "speed_factor=0.5,0.9", *QUICK)
    shown = invoke(*given, "--out", tmp_path / "a.sqlite", "--json")
    assert shown.exit_code == 130
    assert "matches; the same command goes on with it" in " ".join(shown.stderr.split())
    assert json.loads(shown.stdout)["interrupted"]
