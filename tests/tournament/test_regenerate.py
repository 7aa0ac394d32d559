"""Matches of a store played again from their seeds alone."""

from __future__ import annotations

import json
import shutil
import sqlite3
from dataclasses import replace
from pathlib import Path

import pytest
from typer.testing import CliRunner

from robobt.cli import app
from robobt.match.loop import MatchLoop
from robobt.match.recording import load_recording
from robobt.match.referee.events import EventKind, RefereeEvent
from robobt.tournament.entrants import Entrant
from robobt.tournament.fixtures import Fixture
from robobt.tournament.plan import Plan
from robobt.tournament.play import play_tournament
from robobt.tournament.played import PlayedMatch
from robobt.tournament.recordings import file_name
from robobt.tournament.regenerate import differences, plan_of, regenerate
from robobt.tournament.store import MatchStore, StoreError
from robobt.world import RobotId, Team
from tests.match.scripted import PlainWorld
from tests.tournament.made_up import plan, runner

pytestmark = pytest.mark.integration


@pytest.fixture(scope="module")
def stored(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Six matches in the real simulator, played in this process."""
    path = tmp_path_factory.mktemp("seeds") / "night.sqlite"
    whole = Plan(scenario=plan().scenario, entrants=(runner(2.0), runner(1.0)), rounds=3, seed=3)
    with whole.open_store(path) as store:
        assert len(play_tournament(whole, store).matches) == 6
    return path


@pytest.fixture
def path(stored: Path, tmp_path: Path) -> Path:
    return Path(shutil.copy(stored, tmp_path / "night.sqlite"))


def changed(path: Path, statement: str) -> None:
    """Change a store behind its triggers, as no command can."""
    with sqlite3.connect(path) as connection:
        for table in ("matches", "tournament", "entrants"):
            connection.execute(f"DROP TRIGGER no_update_of_{table}")
        connection.execute(statement)
    connection.close()


def test_other_processes_play_them_bit_for_bit(path: Path, tmp_path: Path) -> None:
    folder = tmp_path / "again"
    words = ["tournament", "results", str(path), "--regenerate", str(folder), "--workers", "2", "--json"]
    done = CliRunner().invoke(app, words)
    assert done.exit_code == 0, done.output
    said = json.loads(done.stdout)
    assert said["equal"] == 6
    with MatchStore(path) as store:
        kept = {match.fixture: match for match in store.matches()}
    for one in said["regenerated"]:
        match = kept[one["blue"], one["yellow"], one["round"]]  # type: ignore[index]
        assert one["again"] == match.trace
        recording = load_recording(one["file"])
        assert (len(recording), recording.header.seed) == (match.ticks, match.seed)


def test_a_store_takes_less_than_a_kilobyte_a_match(tmp_path: Path) -> None:
    rounds = 20
    many = plan(rounds=rounds)
    path = tmp_path / "many.sqlite"
    with many.open_store(path) as store:
        empty = path.stat().st_size
        play_tournament(many, store)
        count = len(store.matches())
        store._connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    assert count == 6 * rounds
    assert (path.stat().st_size - empty) / count < 1000


def test_only_the_matches_asked_for_are_played(path: Path, tmp_path: Path) -> None:
    with MatchStore(path) as store:
        one = store.matches()[2]
        again = regenerate(store, [one], tmp_path / "again")
    assert [(it.match, it.equal) for it in again] == [(one, True)]
    assert len(list((tmp_path / "again").iterdir())) == 1


@pytest.mark.parametrize("ending", [".robobt.arrows", ".html", ".parquet"])
def test_no_file_of_a_match_is_replaced(path: Path, tmp_path: Path, ending: str) -> None:
    with MatchStore(path) as store:
        one = store.matches()[0]
        there = tmp_path / f"{file_name(one.fixture)}{ending}"
        there.write_text("of the match as it was played")
        with pytest.raises(FileExistsError, match="give another folder"):
            regenerate(store, [one], tmp_path)
    assert there.read_text() == "of the match as it was played"


def test_a_match_that_goes_another_way_is_told(path: Path, tmp_path: Path) -> None:
    changed(path, "UPDATE matches SET trace = 'another' WHERE round = 0")
    with MatchStore(path) as store:
        again = regenerate(store, store.matches()[:4], tmp_path / "again")
    assert [it.equal for it in again] == [False, False, True, True]


def test_other_code_and_another_version_are_told(path: Path) -> None:
    changed(path, "UPDATE matches SET code = 'older' WHERE round = 0")
    changed_version = "UPDATE tournament SET value = '0.0.1' WHERE field = 'robobt'"
    with sqlite3.connect(path) as connection:
        connection.execute(changed_version)
    with MatchStore(path) as store:
        version, code = differences(store, store.matches())
    assert version.startswith("robobt 0.0.1 played the tournament, this is ")
    assert code.startswith("other code (older) played 2 of the matches, this is ")


def test_a_store_without_its_scenario_is_refused(path: Path) -> None:
    with sqlite3.connect(path) as connection:
        connection.execute("DROP TABLE definitions")
    with MatchStore(path) as store, pytest.raises(StoreError, match="holds no scenario"):
        plan_of(store)


def test_a_store_without_an_entrant_is_refused(path: Path) -> None:
    with sqlite3.connect(path) as connection:
        connection.execute("DELETE FROM definitions WHERE name = 'entrant at 2'")
    with MatchStore(path) as store, pytest.raises(StoreError, match="entrants: at 2: is not held"):
        plan_of(store)


def test_an_entrant_whose_files_have_changed_is_refused(path: Path) -> None:
    changed(path, "UPDATE entrants SET digest = 'older' WHERE name = 'at 2'")
    with MatchStore(path) as store, pytest.raises(StoreError, match="entrants: at 2: its files have changed"):
        plan_of(store)


def test_a_store_of_before_is_read_and_gone_on_with(path: Path) -> None:
    with sqlite3.connect(path) as connection:
        connection.execute("ALTER TABLE matches DROP COLUMN events")
        connection.execute("DROP TABLE definitions")
    with MatchStore(path) as store:
        assert [match.events for match in store.matches()] == [""] * 6
        store.enter([runner(3.0)])
        assert list(store.definitions()) == ["entrant at 3"]


def test_an_entrant_comes_back_from_its_definition() -> None:
    whole = runner(1.5, lines=3)
    assert Entrant.from_json(whole.to_json()) == whole
    assert Entrant.from_json(whole.to_json()).digest() == whole.digest()


def test_goals_and_cards_are_kept_with_their_times_and_no_other_event() -> None:
    match = MatchLoop(plan().scenario, 0, PlainWorld)
    scored = RefereeEvent(12.345, EventKind.GOAL, Team.BLUE, RobotId(Team.BLUE, 3))
    touched = RefereeEvent(13.0, EventKind.BOT_CRASH_UNIQUE, Team.YELLOW)
    card = RefereeEvent(14.0, EventKind.MULTIPLE_FOULS, Team.YELLOW)
    kept = PlayedMatch.of_result(Fixture("a", "b", 0), match.play(), "", "", [scored, touched, card])
    assert kept.events == "12.35 goal blue 3; 14.00 multiple_fouls yellow"


def test_a_plan_comes_back_with_its_rounds_and_seed(stored: Path) -> None:
    with MatchStore(stored) as store:
        again = replace(plan_of(store), world=PlainWorld)
    assert (again.rounds, again.seed, again.names) == (3, 3, ["at 2", "at 1"])
