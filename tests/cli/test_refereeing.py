"""Who referees a match is chosen on the command line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from robobt.cli import app
from robobt.cli.option_groups.refereeing import MatchExtent, Refereeing, Who
from robobt.league.referee.process import VARIABLE
from robobt.match import load_scenario
from tests.league.referee.conftest import program as program

WITH, WITHOUT = "six_v_six", "striker_vs_goalkeeper"
"""Scenarios with a referee of their own and without."""


@pytest.fixture
def _no_controller(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(VARIABLE, raising=False)
    monkeypatch.setenv("PATH", "/nowhere")


def run(*arguments: str) -> Result:
    return CliRunner().invoke(app, ["match", *arguments])


@pytest.mark.usefixtures("_no_controller")
def test_an_absent_game_controller_is_said_with_where_to_get_it() -> None:
    result = run(WITH, "--referee", "official")
    assert result.exit_code == 1
    assert "github.com/RoboCup-SSL/ssl-game-controller" in result.output
    assert "--referee own" in result.output


def test_a_program_is_only_named_for_the_official_referee() -> None:
    result = run(WITH, "--game-controller", "program")
    assert result.exit_code == 2
    assert "--referee official" in result.output


def test_none_plays_freely_and_own_where_the_scenario_has_no_referee() -> None:
    free, _ = Refereeing(Who.NONE).of(load_scenario(WITH))
    assert free.referee is None
    own, _ = Refereeing(Who.OWN).of(load_scenario(WITHOUT))
    assert own.referee is not None
    for name in (WITH, WITHOUT):
        as_it_is = load_scenario(name)
        assert Refereeing().of(as_it_is)[0] == as_it_is


def test_a_full_match_has_two_halves_of_five_minutes() -> None:
    full, _ = Refereeing(stages=MatchExtent.FULL).of(load_scenario(WITH))
    assert full.referee is not None
    assert full.referee.half_length == 300.0
    assert full.ends.time_limit >= 3600.0
    assert run(WITHOUT, "--stages", "full").exit_code == 2


@pytest.mark.integration
def test_matches_are_played_under_the_program_that_is_named(program: Path) -> None:
    given = ("--referee", "official", "--game-controller", str(program))
    result = run(WITHOUT, *given, "--set", "ends.time_limit=0.2", "--trials", "1", "--json")
    assert result.exit_code == 0, result.output
    assert json.loads(result.stdout)["outcomes"]["time"]["count"] == 1
