"""A team's program ends with its match, and so does all it has started."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from contextlib import suppress
from pathlib import Path

import pytest

from robobt.league.programs.process import KEPT_OUTPUT, TeamProcess
from tests.waiting import LIMIT, soon

pytestmark = [
    pytest.mark.integration,
    pytest.mark.skipif(not Path("/proc/self/environ").exists(), reason="needs /proc"),
]

ESCAPES = (
    "import signal, subprocess, sys, time\n"
    "signal.signal(signal.SIGTERM, signal.SIG_IGN)\n"
    "child = 'import os, signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); '\n"
    "child += 'print(os.getpid(), flush=True); time.sleep(600)'\n"
    "subprocess.Popen([sys.executable, '-S', '-c', child], start_new_session=True)\n"
    "time.sleep(600)\n"
)

TELLS = "print(os.getpid(), flush=True)"
STOPS_ITS_GUARD = "[os.kill(pid, signal.SIGSTOP) for pid in others()]"


def harmful(harm: str) -> str:
    """Return the code of a program that harms ``others()`` of its group, and stays."""
    return (
        "import os, signal, time; from pathlib import Path\n"
        "def others():\n"
        "    groups = [(int(file.parent.name), file.read_text().rpartition(')')[2].split()[2])\n"
        "              for file in Path('/proc').glob('[0-9]*/stat')]\n"
        "    mine = str(os.getpgrp())\n"
        "    return sorted(pid for pid, group in groups if group == mine and pid != os.getpid())\n"
        f"{harm}; time.sleep(600)\n"
    )


@pytest.fixture(autouse=True)
def _waits_as_long_as_needed(monkeypatch: pytest.MonkeyPatch) -> None:
    # On a busy machine the kernel takes a while to end processes; no test waits for one that stays.
    monkeypatch.setattr("robobt.league.programs.process._KILL_TIMEOUT", LIMIT)
    # And the guard holds the output of its program until it ends itself, so that its end is never seen.
    monkeypatch.setattr("robobt.league.programs.process._LAST_WORDS_TIMEOUT", 0.05)


def wait_for_words(path: Path) -> str:
    soon(lambda: path.exists() and path.read_text().endswith("\n"), "it says something")
    return path.read_text()


def runs(pid: int) -> bool:
    # A process that is ending gives up its environment before its files, and shows as a zombie only later.
    try:
        return Path(f"/proc/{pid}/environ").read_bytes() != b""
    except OSError:
        return False


def test_children_that_ignore_signals_and_left_the_group_are_ended_too(tmp_path: Path) -> None:
    output = tmp_path / "out.txt"
    with TeamProcess([sys.executable, "-S", "-c", ESCAPES], tmp_path, output) as program:
        child = int(wait_for_words(output))
        assert runs(child)
        assert program.ended() is None
    assert not runs(child)


@pytest.mark.parametrize("deaf", [False, True])
def test_who_does_not_end_when_told_is_stubborn(deaf: bool, tmp_path: Path) -> None:
    obeys = ESCAPES.replace("signal.signal(signal.SIGTERM, signal.SIG_IGN)\n", "\n", 1)
    child = obeys if deaf else obeys.replace("signal.signal(signal.SIGTERM, signal.SIG_IGN); ", "")
    output = tmp_path / "out.txt"
    with TeamProcess([sys.executable, "-S", "-c", child], tmp_path, output) as program:
        wait_for_words(output)
        program.tell()
        program.leave(0.3 if deaf else LIMIT)
        assert program.stubborn is deaf


@pytest.mark.parametrize(
    "harm",
    [
        f"{TELLS}; os.killpg(0, signal.SIGSTOP)",
        f"{STOPS_ITS_GUARD}; {TELLS}",
        f"[os.kill(pid, signal.SIGKILL) for pid in others()[1:]]; {TELLS}",
    ],
    ids=["stops all of its group", "stops its guard", "kills its guard"],
)
def test_a_program_is_ended_whatever_it_does_to_its_guard(
    harm: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("robobt.league.programs.process._CLEANUP_TIMEOUT", 0.2)
    output = tmp_path / "out.txt"
    with TeamProcess([sys.executable, "-S", "-c", harmful(harm)], tmp_path, output):
        child = int(wait_for_words(output))
    assert not runs(child)


def test_closing_waits_until_what_it_killed_is_gone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    kill = os.kill

    def kill_later(process: int, number: int) -> None:
        def kill_now() -> None:
            with suppress(OSError):
                kill(process, number)

        threading.Timer(0.5, kill_now).start()

    monkeypatch.setattr("robobt.league.programs.process._CLEANUP_TIMEOUT", 0.2)
    monkeypatch.setattr(os, "kill", kill_later)
    output = tmp_path / "out.txt"
    code = harmful(f"{STOPS_ITS_GUARD}; os.setsid(); {TELLS}")
    with TeamProcess([sys.executable, "-S", "-c", code], tmp_path, output):
        child = int(wait_for_words(output))
    assert not runs(child)


def test_nothing_is_left_when_the_match_is_killed(tmp_path: Path) -> None:
    output = tmp_path / "out.txt"
    match = (
        "import sys, time; from pathlib import Path\n"
        "from robobt.league.programs.process import TeamProcess\n"
        f"folder, output = Path({str(tmp_path)!r}), Path({str(output)!r})\n"
        f"TeamProcess([sys.executable, '-S', '-c', {ESCAPES!r}], folder, output)\n"
        "time.sleep(600)\n"
    )
    with subprocess.Popen([sys.executable, "-c", match]) as process:
        child = int(wait_for_words(output))
        process.send_signal(signal.SIGKILL)
        process.wait()
    soon(lambda: not runs(child))


def test_how_it_ended_is_told_with_its_last_words(tmp_path: Path) -> None:
    ends = {"print('bye'); raise SystemExit(3)": "ended with exit code 3: bye"}
    ends["import os; os.kill(os.getpid(), 9)"] = "was ended by signal 9"
    for code, told in ends.items():
        with TeamProcess([sys.executable, "-S", "-c", code], tmp_path, tmp_path / "out.txt") as program:
            # Its last words may come after its end.
            soon(lambda program=program, told=told: program.ended() == f"its program {told}")


def test_only_the_beginning_of_its_output_is_kept(tmp_path: Path) -> None:
    output = tmp_path / "out.txt"
    shout = "import os\nfor _ in range(200): os.write(1, b'x' * (1 << 20))\n"
    with TeamProcess([sys.executable, "-S", "-c", shout], tmp_path, output) as program:
        soon(program.ended)
        soon(lambda: program.printed == 200 << 20)
    assert output.stat().st_size == KEPT_OUTPUT
    assert program.printed == 200 << 20


def test_a_program_that_is_not_there_is_told(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="there is no such program"):
        TeamProcess(["no-such-program"], tmp_path, tmp_path / "out.txt")
