"""The store: one file, one row a match, only ever added to."""

from __future__ import annotations

import os
import sqlite3
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from robobt.tournament.played import MAY_DIFFER, PlayedMatch
from robobt.tournament.store import MatchStore, StoreError
from tests.tournament.made_up import played, runner

PLAYED = {"scenario": "drill", "digest": "1234", "seed": 3, "referee": "own", "robobt": "0"}


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "night.sqlite"


def test_a_match_comes_back_as_it_was(path: Path) -> None:
    match = played("a", "b", 0, (2, 1), passes=7, expected_goals=1.25, errors=3, first_error="x")
    with MatchStore(path, PLAYED) as store:
        assert store.add(match)
    with MatchStore(path) as store:
        assert store.matches() == [match]
        assert store.match(match.fixture) == match
        assert store.match(played("b", "a", 0).fixture) is None


def test_a_match_is_kept_once(path: Path) -> None:
    with MatchStore(path, PLAYED) as store:
        assert store.add(played("a", "b", 0, (1, 0)))
        assert not store.add(played("a", "b", 0, (5, 0)))
        assert [match.blue_score for match in store.matches()] == [1]


@pytest.mark.parametrize("statement", ["DELETE FROM matches", "UPDATE matches SET blue_score = 9"])
def test_rows_are_only_ever_added(path: Path, statement: str) -> None:
    with MatchStore(path, PLAYED) as store:
        store.add(played("a", "b", 0))
    connection = sqlite3.connect(path)
    with pytest.raises(sqlite3.IntegrityError, match="only ever added"):
        connection.execute(statement)
    connection.close()


def test_any_program_reads_it_with_one_query(path: Path) -> None:
    with MatchStore(path, PLAYED) as store:
        store.add(played("a", "b", 4, (2, 1), yellow_cards=1))
    connection = sqlite3.connect(path)
    row = connection.execute(
        "SELECT blue, yellow, round, blue_score, yellow_score, blue_yellow_cards FROM matches"
    ).fetchone()
    connection.close()
    assert row == ("a", "b", 4, 2, 1, 1)


@pytest.mark.parametrize("field", ["scenario", "digest", "seed", "referee", "robobt"])
def test_a_store_of_another_tournament_is_refused_by_file_and_field(path: Path, field: str) -> None:
    MatchStore(path, PLAYED).close()
    with pytest.raises(StoreError, match=f"night.sqlite: {field}: the store holds a tournament of") as raised:
        MatchStore(path, {**PLAYED, field: "another"})
    assert str(raised.value).endswith("give another file")


def test_a_file_that_is_no_store_stays_as_it_is(path: Path) -> None:
    path.write_text("not a database, but long enough to look like one" * 50)
    before = path.read_bytes()
    with pytest.raises(StoreError, match=r"night\.sqlite: cannot be used: file is not a database"):
        MatchStore(path, PLAYED)
    assert path.read_bytes() == before


def test_another_database_is_no_store_and_stays_as_it_is(path: Path) -> None:
    connection = sqlite3.connect(path)
    connection.execute("CREATE TABLE mine (x)")
    connection.close()
    before = path.read_bytes()
    for played_there in (PLAYED, None):
        with pytest.raises(StoreError, match="is no store of a tournament"):
            MatchStore(path, played_there)
    assert path.read_bytes() == before


@pytest.mark.parametrize(
    ("change", "problem"),
    [("DROP COLUMN blue_passes", "lacks blue_passes"), ("ADD COLUMN more TEXT", "has more besides")],
)
def test_a_store_with_other_columns_is_told(path: Path, change: str, problem: str) -> None:
    MatchStore(path, PLAYED).close()
    connection = sqlite3.connect(path)
    connection.execute(f"ALTER TABLE matches {change}")
    connection.close()
    with pytest.raises(
        StoreError, match=f"night.sqlite: matches: {problem}; read it with the version of robobt"
    ):
        MatchStore(path)


def test_a_figure_that_is_no_number_is_told_not_dropped(path: Path) -> None:
    with MatchStore(path, PLAYED) as store:
        with pytest.raises(StoreError, match=r"NOT NULL constraint failed: matches\.blue_possession"):
            store.add(played("a", "b", 0, possession=float("nan")))
        assert store.matches() == []


def test_what_is_not_there_is_not_made_to_be_looked_at(path: Path) -> None:
    with pytest.raises(StoreError, match="there is no such file"):
        MatchStore(path)
    assert not path.exists()


def test_a_folder_is_no_store(tmp_path: Path) -> None:
    with pytest.raises(StoreError, match="is not an ordinary file"):
        MatchStore(tmp_path, PLAYED)


def test_a_name_stands_for_one_team(path: Path) -> None:
    with MatchStore(path, PLAYED) as store:
        store.enter([runner(1.0), runner(2.0)])
        store.enter([runner(1.0)])
        assert list(store.entrants()) == ["at 1", "at 2"]
        with pytest.raises(StoreError, match="entrants: 'at 1': is another team in this store"):
            store.enter([runner(1.0, breaks="raise")])


def test_two_writers_do_not_lose_or_repeat_a_match(path: Path) -> None:
    matches = [played("a", "b", number) for number in range(100)]

    def write(order: list[PlayedMatch]) -> int:
        with MatchStore(path, PLAYED) as store:
            return sum(store.add(match) for match in order)

    with ThreadPoolExecutor(2) as writers:
        added = sum(writers.map(write, [matches, matches[::-1]]))
    with MatchStore(path) as store:
        assert added == len(store.matches()) == 100


class TestMerge:
    def test_stores_of_one_tournament_become_one(self, path: Path, tmp_path: Path) -> None:
        with MatchStore(path, PLAYED) as store, MatchStore(tmp_path / "b", PLAYED) as other:
            store.enter([runner(1.0)])
            other.enter([runner(1.0), runner(2.0)])
            store.add(played("a", "b", 0))
            other.add(played("a", "b", 0))
            other.add(played("b", "a", 0))
            assert store.merge(other) == 1
            assert store.merge(other) == 0
            assert len(store.matches()) == 2
            assert list(store.entrants()) == ["at 1", "at 2"]

    def test_those_of_different_ones_do_not(self, path: Path, tmp_path: Path) -> None:
        told = pytest.raises(StoreError, match=r"seed: the store holds .* of '3', not of '4' as .*b;")
        with (
            MatchStore(path, PLAYED) as store,
            MatchStore(tmp_path / "b", {**PLAYED, "seed": 4}) as other,
            told,
        ):
            store.merge(other)

    def test_a_match_that_went_another_way_is_told(self, path: Path, tmp_path: Path) -> None:
        with MatchStore(path, PLAYED) as store, MatchStore(tmp_path / "b", PLAYED) as other:
            store.add(played("a", "b", 0))
            other.add(played("a", "b", 0, trace="else"))
            other.add(played("a", "b", 1))
            with pytest.raises(StoreError, match="matches: a v b, round 0: went another way"):
                store.merge(other)
            assert len(store.matches()) == 1

    def test_a_match_that_the_other_side_has_forfeited_is_told(self, path: Path, tmp_path: Path) -> None:
        with MatchStore(path, PLAYED) as store, MatchStore(tmp_path / "b", PLAYED) as other:
            store.add(played("a", "b", 0, trace="", outcome="forfeit_blue"))
            other.add(played("a", "b", 0, trace="", outcome="forfeit_yellow"))
            with pytest.raises(StoreError, match="matches: a v b, round 0: went another way"):
                store.merge(other)


def test_what_may_differ_between_two_plays_are_columns() -> None:
    assert set(MAY_DIFFER) <= set(played("a", "b", 0).row())


def test_a_store_that_cannot_be_written_can_be_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with MatchStore(tmp_path / "a", {"seed": 1}) as store:
        store.add(played("a", "b", 0))
    # Who plays the tests as root may write everywhere.
    monkeypatch.setattr(os, "access", lambda *_: False)
    before = {path: path.read_bytes() for path in tmp_path.iterdir()}
    with MatchStore(tmp_path / "a") as held:
        assert [match.fixture for match in held.matches()] == [("a", "b", 0)]
        assert {path: path.read_bytes() for path in tmp_path.iterdir()} == before
        with pytest.raises(StoreError, match="readonly database"):
            held.add(played("a", "b", 1))
