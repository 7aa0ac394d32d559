"""The official program is found, started on ports of its own, and ends with its match."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from robobt.league.referee.process import (
    PROGRAM,
    VARIABLE,
    GameControllerError,
    GameControllerProcess,
    check_game_controller,
    find_game_controller,
)
from tests.waiting import LIMIT, soon

GAME = {"normal": {"half-duration": "300s"}}


@pytest.fixture(autouse=True)
def _no_program_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.delenv(VARIABLE, raising=False)


def running(program: Path) -> list[int]:
    """Processes with this in their command lines, as the fake controller has its own path."""
    found = []
    for folder in Path("/proc").iterdir():
        if folder.name.isdigit():
            try:
                line = (folder / "cmdline").read_bytes()
            except OSError:
                continue
            if str(program).encode() in line and int(folder.name) != os.getpid():
                found.append(int(folder.name))
    return found


def state(process: int) -> str:
    return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0]


def gone(program: Path) -> bool:
    return soon(lambda: not running(program))


def test_a_program_that_is_absent_is_said_with_where_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "/nowhere")
    with pytest.raises(GameControllerError, match=f"{PROGRAM} is not on PATH: .*github.com/RoboCup-SSL"):
        find_game_controller()
    with pytest.raises(GameControllerError, match="/no/such/program is no program"):
        find_game_controller("/no/such/program")


def test_the_option_goes_before_the_environment_and_that_before_the_path(
    program: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    other = tmp_path / PROGRAM
    other.write_bytes(program.read_bytes())
    other.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    assert find_game_controller() == other
    monkeypatch.setenv(VARIABLE, "/bin/sh")
    assert find_game_controller() == Path("/bin/sh")
    assert find_game_controller(program) == program


def test_a_program_in_the_present_folder_needs_no_dot_before_its_name(
    program: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(program.parent)
    assert find_game_controller(Path("./") / program.name) == program


def test_a_program_that_was_only_downloaded_is_said_to_need_its_permission(tmp_path: Path) -> None:
    downloaded = tmp_path / PROGRAM
    downloaded.write_text("#!/bin/sh\n")
    downloaded.chmod(0o644)
    with pytest.raises(GameControllerError, match=r"is no program until it may be executed \(chmod \+x\)"):
        find_game_controller(downloaded)


def test_what_is_not_the_controller_is_an_error_that_names_it(tmp_path: Path) -> None:
    wrong = tmp_path / "wrong"
    wrong.write_text("#!/bin/sh\necho panic: this is something else; exit 3\n")
    wrong.chmod(0o755)
    with pytest.raises(GameControllerError, match="wrong: the game controller does not start: panic"):
        GameControllerProcess(wrong)


def test_what_is_not_the_controller_is_started_once(tmp_path: Path) -> None:
    wrong, starts = tmp_path / "wrong", tmp_path / "starts"
    wrong.write_text(f"#!/bin/sh\necho again >> {starts}; exit 3\n")
    wrong.chmod(0o755)
    with pytest.raises(GameControllerError, match="wrong: the game controller does not start"):
        check_game_controller(wrong)
    assert starts.read_text() == "again\n"


@pytest.mark.integration
def test_it_publishes_nothing_and_ends_when_it_is_closed(program: Path, tmp_path: Path) -> None:
    with GameControllerProcess(program, GAME) as controller:
        # The fake ends at once when it would be heard.
        assert controller.crash() == ""
        assert running(program)
        folder = Path(controller._folder.name)
        assert folder.exists()
    assert gone(program)
    assert not folder.exists()


@pytest.mark.integration
def test_it_ends_at_once_even_if_it_minds_no_signal_and_has_started_others(
    program: Path, tmp_path: Path
) -> None:
    deaf = tmp_path / "deaf"
    # What a shell ignores is ignored by the programs that it starts.
    deaf.write_text(f'#!/bin/sh\ntrap "" TERM INT HUP\n{program} "$@" & sleep 600\n')
    deaf.chmod(0o755)
    with GameControllerProcess(deaf, GAME):
        assert running(deaf)
    assert gone(deaf)


@pytest.mark.integration
def test_it_ends_even_if_it_has_stopped_what_would_end_it(
    program: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("robobt.league.referee.process._SHUTDOWN_TIMEOUT", 1.0)
    stops, now = tmp_path / "stops", tmp_path / "now"
    stops.write_text(f'#!/bin/sh\n{program} "$@" & while [ ! -e {now} ]; do sleep 0.1; done; kill -STOP 0\n')
    stops.chmod(0o755)
    with GameControllerProcess(stops, GAME):
        now.touch()
        soon(lambda: all(state(process) == "T" for process in running(stops)))
    assert gone(stops)


@pytest.mark.integration
@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_it_ends_however_the_match_does_and_leaves_no_folder(
    program: Path,
    number: signal.Signals,
    start_python: Callable[..., Any],
    signals_of_a_terminal: None,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
) -> None:
    code = (
        "import sys, time; from pathlib import Path\n"
        "from robobt.league.referee.process import GameControllerProcess\n"
        f"kept = GameControllerProcess(Path({str(program)!r}), {GAME!r})\n"
        "print('started', flush=True); time.sleep(60)"
    )
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    process = start_python("-c", code)
    assert process.stdout.readline() == "started\n"
    assert running(program)
    process.send_signal(number)
    process.wait(LIMIT)
    assert gone(program)
    assert not list(tmp_path.glob("robobt-gc-*"))
