"""What a command does when nobody reads, or reads on, what it prints."""

from __future__ import annotations

import os
import subprocess
import sys
from io import StringIO

import pytest
from rich.console import Console

from robobt.cli.screen import FittedTable, console, drop_odd_sizes, errors
from robobt.cli.shown import scenarios
from tests.waiting import LIMIT

ROBOBT = [sys.executable, "-m", "robobt"]


@pytest.mark.integration
@pytest.mark.parametrize("arguments", [["list", "plays"], ["list", "plays", "--json"]])
def test_a_reader_that_has_enough_is_no_failure(arguments: list[str]) -> None:
    reader, writer = os.pipe()
    os.close(reader)
    try:
        ended = subprocess.run([*ROBOBT, *arguments], stdout=writer, stderr=subprocess.PIPE, check=False)
    finally:
        os.close(writer)
    assert (ended.returncode, ended.stderr) == (0, b"")


@pytest.mark.integration
@pytest.mark.parametrize("closed", [">&-", "2>&-", ">&- 2>&-"])
def test_a_stream_that_is_closed_from_the_start_is_no_failure(closed: str) -> None:
    command = " ".join([*ROBOBT, "--version", closed])
    ended = subprocess.run(["sh", "-c", command], capture_output=True, check=False)
    assert (ended.returncode, ended.stderr) == (0, b"")


@pytest.mark.parametrize("given", ["0", "-5", "abc", "1", "", "39", "00080", "80.5", "²", "1e3", "9" * 5000])
def test_a_width_that_makes_no_sense_is_ignored(given: str) -> None:
    environment = {"COLUMNS": given, "LINES": given, "HOME": "/"}
    drop_odd_sizes(environment)
    assert "COLUMNS" not in environment
    assert environment["HOME"] == "/"


@pytest.mark.parametrize("given", ["40", "80", "1000"])
def test_a_width_that_is_given_counts(given: str) -> None:
    environment = {"COLUMNS": given, "LINES": given}
    drop_odd_sizes(environment)
    assert environment == {"COLUMNS": given, "LINES": given}


@pytest.mark.integration
@pytest.mark.parametrize("arguments", [["list", "scenarios"], ["list", "--help"]])
def test_a_width_of_nothing_prints_what_80_columns_print(arguments: list[str]) -> None:
    shown = [
        subprocess.run(
            [*ROBOBT, *arguments],
            env={**os.environ, "COLUMNS": width},
            stdout=subprocess.PIPE,
            check=True,
            timeout=LIMIT,
        ).stdout
        for width in ("0", "80")
    ]
    assert b"scenario" in shown[0]
    assert shown[0] == shown[1]


@pytest.mark.integration
def test_a_list_of_scenarios_loses_no_text_on_a_narrow_screen(monkeypatch: pytest.MonkeyPatch) -> None:
    def printed(width: int) -> str:
        narrow = Console(width=width, file=StringIO())
        monkeypatch.setattr(scenarios, "console", narrow)
        scenarios.list_scenarios(as_json=False)
        return "".join(sorted("".join(narrow.file.getvalue().split())))  # type: ignore[attr-defined]

    assert printed(12) == printed(40) == printed(1000)


def test_warnings_are_told_but_not_each_failure_of_a_tree() -> None:
    program = (
        "import logging, sys; from robobt.cli import app;"
        "sys.argv = ['robobt', 'list', 'plays']; app(standalone_mode=False);"
        "logging.getLogger('robobt.league.wire.links').warning('two senders');"
        "logging.getLogger('robobt.tree.runner').warning('tree stopped')"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=LIMIT)
    assert done.stderr == "two senders\n"


def lines_of(table: FittedTable, width: int) -> list[str]:
    printed = StringIO()
    Console(file=printed, width=width).print(table)
    return [line.rstrip() for line in printed.getvalue().splitlines()]


def listed() -> FittedTable:
    table = FittedTable("model", "observation", "results")
    table.columns[0].no_wrap = True
    table.add_row("go_to_ball_ppo", "go_to_ball_among v2", "success 0.9, time 3.2 s")
    return table


@pytest.mark.parametrize("printed", ["my_team.py:boom: no goals", "[bold]my_team.py:boom:[/bold]"])
def test_a_play_of_a_file_is_no_picture(printed: str, capsys: pytest.CaptureFixture[str]) -> None:
    console.print(printed)
    errors.print(printed)
    said = capsys.readouterr()
    assert "my_team.py:boom:" in said.out
    assert "my_team.py:boom:" in said.err


def test_a_table_that_fits_is_printed_as_it_is() -> None:
    assert lines_of(listed(), 80) == [
        "model           observation          results",
        "go_to_ball_ppo  go_to_ball_among v2  success 0.9, time 3.2 s",
    ]


@pytest.mark.parametrize(("width", "allowed"), [(50, ""), (42, "_"), (34, "_")])
def test_a_narrow_table_is_broken_between_words_and_then_parts_of_names(width: int, allowed: str) -> None:
    lines = lines_of(listed(), width)
    assert max(map(len, lines)) <= width
    words = " ".join(lines).split()
    whole = {"model", "observation", "results", "go_to_ball_ppo", "go_to_ball_among", "v2", "success", "0.9,"}
    whole |= {"time", "3.2", "s"}
    parts = {"go_", "to_", "ball_", "go_to_", "go_to_ball_", "to_ball_", "ppo", "among"} if allowed else set()
    assert set(words) <= whole | parts


def test_a_table_for_which_there_is_no_room_at_all_is_printed_whole() -> None:
    printed = "".join("".join(lines_of(listed(), 20)).split())
    assert all(letter in printed for letter in "modelobservationresults")


def test_a_setting_is_broken_at_its_points_but_a_number_is_not() -> None:
    shown = FittedTable("name", "conditions")
    shown.add_row("cooperation", "simulator.realism.command_delay=0.065")
    words = "\n".join(lines_of(shown, 24)).split()
    assert words == ["name", "conditions", "cooperation", "simulator.", "realism.", "command_", "delay=0.065"]
