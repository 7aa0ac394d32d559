"""The table of results: rows are kept, read again and played again."""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from pathlib import Path

import pytest

from robobt.challenges.run import ChallengeEntry, RunResult, play_run, play_runs
from robobt.challenges.table import Row, TableError, append_row, read_rows, repeats, row_of
from robobt.match.scenario.scenario import ScenarioError
from robobt.worlds import sim_world

ENTRY = ChallengeEntry("passing", ("pass_player", {"enough": 0.5}), None, {"ends.time_limit": 0.3})


@pytest.fixture(scope="module")
def row() -> Row:
    return row_of(ENTRY, "ours", 3, play_runs(ENTRY, 2, 3, sim_world))


def test_a_row_that_was_written_is_read_again(row: Row, tmp_path: Path) -> None:
    file = tmp_path / "results.jsonl"
    append_row(file, row)
    append_row(file, replace(row, entrant="again"))
    assert [one.entrant for one in read_rows(file)] == ["ours", "again"]
    assert read_rows(file)[0] == row


def test_a_row_holds_what_plays_it_again(row: Row) -> None:
    assert row.entry == ENTRY
    assert repeats(row, sim_world)
    assert not repeats(replace(row, seed=4), sim_world)


def test_runs_do_not_depend_on_each_other() -> None:
    assert play_run(ENTRY, 1, 3, sim_world) == play_runs(ENTRY, 2, 3, sim_world)[1]


@pytest.mark.parametrize(("passes", "known"), [((2.0, 2.0), False), ((2.0, 3.0), True)])
def test_equal_scores_have_no_interval(passes: tuple[float, float], known: bool) -> None:
    runs = [RunResult(i, i, {"passes": count}, f"trace {i}") for i, count in enumerate(passes)]
    row = row_of(ENTRY, "ours", 3, runs)
    assert (row.low is not None, row.high is not None) == (known, known)


def test_a_damaged_line_is_named(row: Row, tmp_path: Path) -> None:
    file = tmp_path / "results.jsonl"
    append_row(file, row)
    with file.open("a") as text:
        text.write('{"challenge": "passing"}\n')
    with pytest.raises(TableError, match=r"results\.jsonl, line 2: .*"):
        read_rows(file)


@pytest.mark.parametrize(("field", "value"), [("scores", []), ("seed", -1), ("seed", 2**63)])
def test_a_row_that_cannot_be_played_is_refused(row: Row, tmp_path: Path, field: str, value: object) -> None:
    file = tmp_path / "results.jsonl"
    file.write_text(json.dumps({**asdict(row), field: value}))
    with pytest.raises(TableError, match=rf"results\.jsonl, line 1: {field}: "):
        read_rows(file)


def test_a_file_that_is_no_text_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "results.jsonl"
    file.write_bytes(b"\x80\xff\n")
    with pytest.raises(TableError, match=r"results\.jsonl: "):
        read_rows(file)


def test_a_row_does_not_continue_a_line_that_was_cut_off(row: Row, tmp_path: Path) -> None:
    file = tmp_path / "results.jsonl"
    file.write_text('{"challenge": "pass')
    append_row(file, row)
    append_row(file, row)
    cut, *whole = file.read_text().splitlines()
    assert (cut, len(whole)) == ('{"challenge": "pass', 2)
    file.write_text("\n".join(whole))
    assert read_rows(file) == [row, row]


def test_a_play_without_that_parameter_is_refused() -> None:
    wrong = ChallengeEntry("passing", ("pass_player", {"enuff": 0.5}))
    with pytest.raises(ScenarioError, match="enuff"):
        play_run(wrong, 0, 1, sim_world)


def test_attempts_are_recorded(tmp_path: Path) -> None:
    result = play_run(ENTRY, 0, 3, sim_world, tmp_path / "best")
    assert [Path(file).name for file in result.recordings] == ["best-match.robobt.arrows"]
    assert all(Path(file).stat().st_size for file in result.recordings)
    assert result.trace == play_run(ENTRY, 0, 3, sim_world).trace
