"""A command that is told to end does so at once: robots stopped, files complete, one line said."""

from __future__ import annotations

import json
import os
import pty
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner, Result

from robobt.cli import app, common
from robobt.league.log.files import read_log
from robobt.league.serve.served_field import served_line_up, served_scenario
from robobt.league.wire.endpoints import Endpoints
from robobt.match import load_scenario
from robobt.match.loop import MatchLoop
from robobt.match.recording import load_recording
from robobt.plays import PLAYS
from robobt.world.command import RobotCommand
from robobt.world.field import DIVISION_B
from robobt.world.state import RobotId
from robobt.worlds import sim_world
from tests.league.served import free_endpoints, served
from tests.registries import temporarily
from tests.waiting import LIMIT, soon

pytestmark = [pytest.mark.integration, pytest.mark.usefixtures("signals_of_a_terminal")]

WHOLE = b"\xff\xff\xff\xff\x00\x00\x00\x00"
"""How a recording ends that was finished."""

DRIVES = """
import os, signal, time
from robobt.plays import PLAYS
from robobt.skills.base import Skill
from robobt.tree import Status

class Drives(Skill):
    ticks = 0

    def on_running(self) -> Status:
        self.ticks += 1
        if self.ticks == 10:
            {busy}
        return self.run()

@PLAYS.register("drives")
def drives():
    return Drives("drives")
"""

SLEEPS = "os.kill(os.getpid(), {number}); time.sleep(60)"
COMPUTES = """os.kill(os.getpid(), {number})
            while True: pass"""
CATCHES_ONCE = """
            try:
                os.kill(os.getpid(), {number})
                time.sleep(60)
            except BaseException:
                pass"""
NEVER_LETS_GO = """
            while True:
                try:
                    os.kill(os.getpid(), {number})
                    while True: pass
                except:
                    pass"""
TELLS_ITS_PARENT = """
            while not os.path.exists("{recording}"):
                time.sleep(0.01)
            os.kill(os.getppid(), {number})
            time.sleep(60)"""

SCENARIO = """
name: driven
robots:
  blue:
    - {number: 0, play: drives, start: {position: [0, 0]}}
ball: {position: [2.0, 2.0]}
ends: {time_limit: 600}
"""


@pytest.fixture(autouse=True)
def _no_end_by_force_in_this_process(monkeypatch: pytest.MonkeyPatch) -> None:
    """An orderly end takes longer on a busy machine, and one by force would end pytest; so does a start."""
    monkeypatch.setattr(common, "_ENDING_TIMEOUT", LIMIT)
    monkeypatch.setattr("robobt.league.placing.TIMEOUT", LIMIT)


def robobt(*arguments: object) -> Result:
    """A command in this process, as a script starts it in the background: with Ctrl-C ignored."""
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        return CliRunner().invoke(app, [str(argument) for argument in arguments])
    finally:
        signal.signal(signal.SIGINT, before)


def in_a_process(*arguments: object) -> subprocess.CompletedProcess[str]:
    """The same in a process of its own."""
    command = [sys.executable, "-m", "robobt", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=300, check=False)


@contextmanager
def told_when(what: Callable[[], bool], number: int) -> Iterator[None]:
    """Send this process a signal as soon as something is the case."""

    def tell() -> None:
        try:
            soon(what)
        finally:
            os.kill(os.getpid(), number)

    thread = threading.Thread(target=tell)
    # For a command that has ended before.
    handler = signal.signal(number, lambda *_: None)
    thread.start()
    try:
        yield
    finally:
        thread.join()
        signal.signal(number, handler)


def large(file: Path) -> bool:
    return file.exists() and file.stat().st_size > 5_000


@pytest.fixture
def match(tmp_path: Path) -> Iterator[Callable[..., list[object]]]:
    """The arguments that play a match whose only robot is busy in some way when the signal comes."""

    def arguments(busy: str, number: int = signal.SIGTERM) -> list[object]:
        plays, scenario = tmp_path / "drives.py", tmp_path / "driven.yaml"
        recording = tmp_path / "ended.robobt.arrows"
        busy = busy.replace("{number}", str(int(number))).replace("{recording}", str(recording))
        plays.write_text(DRIVES.replace("{busy}", busy))
        scenario.write_text(SCENARIO)
        return ["match", scenario, "--import", plays, "--record", recording]

    with temporarily(PLAYS):
        yield arguments


@pytest.mark.parametrize("busy", [SLEEPS, COMPUTES, CATCHES_ONCE], ids=["sleeps", "computes", "catches"])
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT, signal.SIGHUP])
def test_a_match_ends_on_every_signal_whatever_a_skill_is_doing(
    match: Callable[..., list[object]], tmp_path: Path, number: int, busy: str
) -> None:
    command, scenario, _, plays, *options = match(busy, number)
    # Imported here, it would be sent to the workers of every later test.
    exec(Path(str(plays)).read_text(), {})
    ended = robobt(command, scenario, *options, "--trials", 1)
    assert ended.exit_code == 128 + number
    assert ended.output.count("\n") == 1
    recording = tmp_path / "ended.robobt.arrows"
    assert recording.read_bytes().endswith(WHOLE)
    assert len(load_recording(recording)) in (9, 10)


def test_a_skill_that_never_lets_go_is_ended_by_force(
    match: Callable[..., list[object]], tmp_path: Path
) -> None:
    ended = in_a_process(*match(NEVER_LETS_GO), "--trials", 1)
    assert ended.returncode == 143
    assert ended.stderr == "robobt: ended by force on SIGTERM: a skill or a callback does not let go\n"
    recording = tmp_path / "ended.robobt.arrows"
    assert recording.read_bytes().endswith(WHOLE)
    assert len(load_recording(recording)) == 9


def test_a_match_over_workers_leaves_none_and_keeps_its_recording(
    match: Callable[..., list[object]], tmp_path: Path
) -> None:
    # Its output ends when the last process has ended that shares it.
    ended = in_a_process(*match(TELLS_ITS_PARENT), "--trials", 2, "--workers", 2)
    assert (ended.returncode, ended.stderr) == (143, "robobt: ended by SIGTERM\n")
    assert (tmp_path / "ended.robobt.arrows").read_bytes().endswith(WHOLE)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_server_ends_with_a_complete_log(tmp_path: Path, number: int) -> None:
    ends, log = free_endpoints(), tmp_path / "sent.log.gz"
    where = [f"--vision={ends.vision}", f"--tracker={ends.tracker}", f"--referee-address={ends.referee}"]
    ports = [f"--{name}-port=0" for name in ("grsim", "control", "blue", "yellow")]
    with told_when(lambda: large(log), number):
        ended = robobt("serve", *where, *ports, "--speed-factor", 10, "--log", log, "--json")
    assert ended.exit_code == 0
    frames = json.loads(ended.stdout)["frames"]
    # The last one may have been simulated and not yet sent when the signal came.
    assert frames - [record.kind for record in read_log(log)].count(4) in (0, 1)
    assert frames > 10


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_logger_ends_with_a_complete_log(tmp_path: Path, number: int) -> None:
    ends, log = free_endpoints(), tmp_path / "heard.log.gz"
    where = [f"--vision={ends.vision}", f"--tracker={ends.tracker}", f"--referee-address={ends.referee}"]
    with served(served_line_up(DIVISION_B, 1), ends, speed=5.0), told_when(lambda: large(log), number):
        ended = robobt("log", log, *where, "--json")
    assert ended.exit_code == 0
    heard = json.loads(ended.stdout)["vision"]
    assert [record.kind for record in read_log(log)].count(4) == heard > 10


def test_a_server_ends_with_a_complete_log_when_its_terminal_closes(tmp_path: Path) -> None:
    ends, log = free_endpoints(), tmp_path / "sent.log"
    where = [f"--vision={ends.vision}", f"--tracker={ends.tracker}", f"--referee-address={ends.referee}"]
    ports = [f"--{name}-port=0" for name in ("grsim", "control", "blue", "yellow")]
    command = [
        sys.executable,
        "-m",
        "robobt",
        "serve",
        *where,
        *ports,
        "--speed-factor",
        "10",
        "--log",
        str(log),
    ]
    pid, terminal = pty.fork()
    if pid == 0:
        os.execv(sys.executable, command)
    statuses: list[int] = []

    def ended() -> bool:
        found, status = os.waitpid(pid, os.WNOHANG)
        if found:
            statuses.append(os.waitstatus_to_exitcode(status))
        return bool(found)

    try:
        soon(lambda: large(log))
        os.close(terminal)
        soon(ended)
    finally:
        if not statuses:
            with suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
            os.waitpid(pid, 0)
    assert statuses == [0]
    assert len(list(read_log(log))) > 5


@contextmanager
def served_six_v_six(endpoints: Endpoints) -> Iterator[dict[RobotId, RobotCommand]]:
    """The last command of every robot, while the scenario's field is served."""
    field = served_scenario(load_scenario("six_v_six"))
    obey = field.command
    last: dict[RobotId, RobotCommand] = {}

    def note(robot: RobotId, command: RobotCommand) -> bool:
        last[robot] = command
        return obey(robot, command)

    field.command = note  # type: ignore[method-assign]
    with served(field, endpoints):
        yield last


def six_v_six(endpoints: Endpoints, recording: Path) -> list[object]:
    """The arguments that play six against six there."""
    given = "&".join(f"{name}={getattr(endpoints, name)}" for name in Endpoints.model_fields)
    return ["match", "six_v_six", "--trials", 1, "--world", f"league://grsim?{given}", "--record", recording]


def plays(last: dict[RobotId, RobotCommand]) -> bool:
    return len(last) == 12 and not told_to_stop(last)


def told_to_stop(last: dict[RobotId, RobotCommand]) -> bool:
    return len(last) == 12 and all(command == RobotCommand() for command in last.values())


@pytest.fixture(scope="module")
def compiled(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Play twice, so that no signal meets the compiler, or the reading of a file of what it kept."""
    MatchLoop(load_scenario("six_v_six").lasting(2.0), 1, sim_world).play()
    endpoints, recording = free_endpoints(), tmp_path_factory.mktemp("compiled") / "played.robobt.arrows"
    with served_six_v_six(endpoints):
        robobt(*six_v_six(endpoints, recording), "--set", "ends.time_limit=1")


@pytest.mark.usefixtures("compiled")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_match_over_the_network_stops_its_robots_before_it_ends(tmp_path: Path, number: int) -> None:
    endpoints, recording = free_endpoints(), tmp_path / "ended.robobt.arrows"
    # Not while sockets are opened: one that has no owner yet is a warning here, and closed with the process.
    with served_six_v_six(endpoints) as last, told_when(lambda: large(recording) and plays(last), number):
        ended = robobt(*six_v_six(endpoints, recording))
        soon(lambda: told_to_stop(last))
    assert ended.exit_code == 128 + number
    # A busy machine may have been told before that it is too slow.
    assert ended.output.splitlines()[-1].startswith("robobt: ")
    assert "Traceback" not in ended.output
    assert recording.read_bytes().endswith(WHOLE)


@pytest.mark.slow
def test_a_match_over_the_network_ends_within_a_second_at_any_moment(
    tmp_path: Path, moments: int, capsys: pytest.CaptureFixture[str]
) -> None:
    """``pytest -m slow tests/cli/test_ending.py --moments 200`` prints the figures."""
    endpoints = free_endpoints()
    times, wrong = [], []
    with served_six_v_six(endpoints) as last:

        def end_at(moment: float) -> tuple[float, tuple[object, ...]]:
            """End a match so long after its first command [s]: what that took [s], and what was seen."""
            last.clear()
            recording = tmp_path / f"{moment}.robobt.arrows"
            command = [sys.executable, "-m", "robobt", *map(str, six_v_six(endpoints, recording))]
            with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
                # From then on everything is put in its place.
                soon(lambda: bool(last))
                time.sleep(moment)
                began = time.monotonic()
                process.send_signal(signal.SIGTERM)
                _, said = process.communicate(timeout=30)
                took = time.monotonic() - began
            time.sleep(0.05)
            # Before the match has begun there is nothing to record.
            whole = not recording.exists() or recording.read_bytes().endswith(WHOLE)
            return took, (process.returncode, said, told_to_stop(last), whole)

        # Whoever is the first compiles, perhaps for so long that it gives up on the vision.
        end_at(0.0)
        for moment in np.random.default_rng(11).uniform(0.0, 4.0, moments).tolist():
            took, seen = end_at(moment)
            times.append(took)
            if seen != (143, "robobt: ended by SIGTERM\n", True, True):
                wrong.append((moment, *seen))
    with capsys.disabled():
        within = sum(taken < 1.0 for taken in times)
        print(f"\nended within 1 s: {within} of {moments}; median {np.median(times):.3f} s, ", end="")
        print(f"longest {max(times):.3f} s; wrong otherwise: {wrong}")
    assert not wrong
    assert max(times) < 1.0
