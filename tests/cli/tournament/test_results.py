"""``robobt tournament results``."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from robobt.cli import app
from robobt.tournament.store import MatchStore
from tests.tournament.made_up import played, runner

PLAYED = {"scenario": "drill", "digest": "1234", "seed": 3, "referee": "own", "robobt": "0"}
A, B, C = "at 1", "at 2", "at 3"


def invoke(*options: object) -> Result:
    return CliRunner().invoke(app, ["tournament", "results", *map(str, options)])


def plain(shown: Result) -> str:
    return " ".join(shown.output.replace("│", " ").split())


@pytest.fixture
def store(tmp_path: Path) -> Path:
    """A wins all its matches, B draws all its others."""
    path = tmp_path / "night.sqlite"
    with MatchStore(path, PLAYED) as store:
        store.enter([runner(1.0), runner(2.0), runner(3.0)])
        for number in range(3):
            for one, other, goals in ((A, B, 2), (A, C, 1 + number), (B, C, 0)):
                store.add(played(one, other, number, (goals, 0)))
                store.add(played(other, one, number, (0, goals)))
    return path


def test_a_store_is_summed_up(store: Path) -> None:
    said = json.loads(invoke(store, "--json").stdout)
    assert said["played"]["seed"] == "3"
    assert (said["matches"], said["standings"][A]["won"], said["standings"][C]["drawn"]) == (18, 12, 6)
    shown = plain(invoke(store))
    assert "scenario drill, seed 3, referee own, robobt 0; 18 matches" in shown
    assert "at 1 v at 2 6-0-0 12 : 0 +2.00" in shown


def test_matches_are_listed_and_filtered(store: Path) -> None:
    def listed(*options: str) -> list[str]:
        found = json.loads(invoke(store, "--json", *options).stdout)["matches"]
        return [f"{row['blue']} {row['yellow']}" for row in found]

    assert len(listed("--matches")) == 18
    assert len(listed("--matches", "--entrant", A)) == 12
    assert set(listed("--matches", "--entrant", A, "--entrant", C)) == {f"{A} {C}", f"{C} {A}"}
    assert len(listed("--lost-by", C)) == 6
    assert listed("--outcome", "forfeit_blue") == []
    assert "full time" in plain(invoke(store, "--matches"))
    assert "No such match; matches ended as full_time." in plain(invoke(store, "--outcome", "full"))


def test_two_entrants_are_compared_by_whom_both_have_met(store: Path) -> None:
    said = json.loads(invoke(store, "--compare", B, A, "--json").stdout)["compare"]
    assert (said["met"]["first"], said["met"]["lost"], said["met"]["rounds_lost"]) == (B, 6, 3)
    others = said["others"]
    assert (others["opponents"], others["rounds"], others["ahead"], others["behind"]) == ([C], 3, 0, 3)
    assert others["lead"] == pytest.approx(-2.0)
    assert others["p"] == pytest.approx(0.25)
    assert others["low"] < -2.0 < others["high"]
    assert "against the same opponents (at 3)" in plain(invoke(store, "--compare", A, B))


def test_stores_of_several_machines_are_merged(store: Path, tmp_path: Path) -> None:
    other = tmp_path / "other.sqlite"
    with MatchStore(other, PLAYED) as held:
        held.enter([runner(1.0), runner(2.0)])
        held.add(played(A, B, 0, (2, 0)))
        held.add(played(A, B, 7, (2, 0)))
    said = json.loads(invoke(store, "--merge", other, "--json").stdout)
    assert (said["merged"], said["matches"]) == (1, 19)
    assert "Matches taken over: 0" in plain(invoke(store, "--merge", other))


@pytest.mark.parametrize(
    ("options", "problem"),
    [
        (("--entrant", "nobody"), "no entrant is called 'nobody'; there are at 1, at 2, at 3"),
        (("--compare", A, "nobody"), "no entrant is called 'nobody'"),
        (("--compare", A, A), "needs two different entrants"),
        (("--tracking", "parquet"), "goes with --regenerate"),
        (("--merge", "gone.sqlite"), "gone.sqlite: there is no such file"),
    ],
)
def test_what_does_not_fit_is_one_plain_error(options: tuple[str, ...], problem: str, store: Path) -> None:
    shown = invoke(store, *options)
    assert shown.exit_code in (1, 2)
    assert problem in plain(shown)
    assert "Traceback" not in shown.output


def test_a_store_that_is_none_is_told(tmp_path: Path) -> None:
    shown = invoke(tmp_path / "gone.sqlite")
    assert shown.exit_code == 1
    assert "gone.sqlite: there is no such file" in plain(shown)
    empty = tmp_path / "empty.sqlite"
    with MatchStore(empty, PLAYED):
        pass
    assert "no match is left, or none was played yet" in plain(invoke(empty))
