"""The league's commands: what they print, and one line when something is wrong."""

from __future__ import annotations

import json
import socket
import threading
import time
from contextlib import closing, suppress
from pathlib import Path

import pytest
from typer.testing import CliRunner

from robobt.cli import app
from robobt.league.log.files import LogKind, LogRecord, read_log
from robobt.league.wire.messages import Referee, SimulationSyncRequest
from robobt.league.wire.packets import PacketCounts
from robobt.league.wire.sockets import Receiver
from robobt.league.wire.stream import MessageStream
from robobt.league.wire.vision import read_vision
from tests.league.served import free_endpoints
from tests.waiting import LIMIT, soon

ANY_PORT = [f"--{name}-port=0" for name in ("grsim", "control", "blue", "yellow")]


def robobt(*arguments: object, code: int = 0) -> str:
    result = CliRunner().invoke(app, [str(argument) for argument in arguments])
    assert result.exit_code == code, result.output
    return result.stdout if code == 0 else result.output


def quiet() -> list[str]:
    """Options that keep a server among itself."""
    ends = free_endpoints()
    return [
        f"--vision={ends.vision}",
        f"--tracker={ends.tracker}",
        f"--referee-address={ends.referee}",
        *ANY_PORT,
    ]


@pytest.mark.integration
def test_serve_says_what_it_served_and_logs_it(tmp_path: Path) -> None:
    log = tmp_path / "game.log.gz"
    printed = json.loads(
        robobt(
            "serve",
            "--robots",
            2,
            *quiet(),
            "--seconds",
            1.0,
            "--speed-factor",
            4,
            "--referee",
            "own",
            "--log",
            log,
            "--json",
        )
    )
    assert printed["frames"] >= 5
    assert printed["simulated_s"] == pytest.approx(printed["frames"] / 60)
    assert printed["packets"]["grsim"]["accepted"] == 0
    assert printed["robots"] == {}
    assert {record.kind for record in read_log(log)} == {3, 4, 5}
    page = tmp_path / "game.html"
    assert robobt("show", log) == f"Page: {page}\n"
    assert "<html" in page.read_text()


@pytest.mark.integration
@pytest.mark.parametrize("clock", ["sim", "unix"])
def test_serve_stamps_its_vision_by_the_clock_that_is_asked_for(tmp_path: Path, clock: str) -> None:
    before = time.time()

    def served() -> list[LogRecord]:
        """What is sent in a moment; a busy machine may not get round to send everything."""
        log = tmp_path / f"{time.time_ns()}.log"
        sent = ["--clock", clock, "--referee", "own", "--log", log]
        robobt("serve", "--robots", 1, *quiet(), "--seconds", 0.3, *sent)
        found = list(read_log(log))
        return found if len({record.kind for record in found}) == 3 else []

    records = soon(served)
    start = before if clock == "unix" else 0.0
    for record in records:
        # Logs and referees always have Unix time.
        assert before <= record.time / 1e9 < before + 2.0 * LIMIT
        seen = read_vision(record.data, PacketCounts()) if record.kind == LogKind.VISION else None
        if seen is not None and seen.frame is not None:
            assert start < seen.frame.captured < start + 2.0 * LIMIT
        if record.kind == LogKind.REFEREE:
            assert before < Referee.FromString(record.data).packet_timestamp / 1e6 < before + 2.0 * LIMIT
    assert {record.kind for record in records} == {3, 4, 5}


def test_serve_takes_a_scenario() -> None:
    assert "Serving 2 robots" in robobt("serve", "striker_vs_goalkeeper", *quiet(), "--seconds", 0.1)


def test_serve_takes_a_field_and_shares_it_among_cameras(tmp_path: Path) -> None:
    log = tmp_path / "large.log"
    given = ("--robots", 11, "--field", "division_a", "--cameras", 4, "--seconds", 0.5)
    assert "Serving 22 robots" in robobt("serve", *given, *quiet(), "--log", log)
    seen = [
        read_vision(record.data, PacketCounts()) for record in read_log(log) if record.kind == LogKind.VISION
    ]
    assert {one.frame.camera for one in seen if one is not None and one.frame is not None} == {0, 1, 2, 3}
    assert {one.field.length for one in seen if one is not None and one.field is not None} == {12.0}


@pytest.mark.integration
def test_serve_in_step_passes_only_the_time_that_is_asked_for() -> None:
    ends = free_endpoints()
    ports = [f"--{name}-port={getattr(ends, name)}" for name in ("grsim", "control", "blue", "yellow")]
    steps = 5

    def ask() -> None:
        with suppress(OSError):
            while not asked.wait(0.02):
                with suppress(ConnectionRefusedError):
                    stream = MessageStream(socket.create_connection(("127.0.0.1", ends.blue)), "the server")
                    with closing(stream):
                        for _ in range(steps):
                            stream.send(SimulationSyncRequest(sim_step=2 / 60).SerializeToString())
                            stream.receive(LIMIT)
                    asked.set()

    asked = threading.Event()
    client = threading.Thread(target=ask)
    client.start()
    try:
        where = [
            f"--vision={ends.vision}",
            f"--tracker={ends.tracker}",
            f"--referee-address={ends.referee}",
            *ports,
        ]
        said = json.loads(robobt("serve", "--robots", 1, *where, "--in-step", "--seconds", 2.0, "--json"))
    finally:
        asked.set()
        client.join()
    assert said["simulated_s"] == pytest.approx(steps * 2 / 60)


@pytest.mark.parametrize(
    "command", [["serve", "--tracker"], ["serve", "--referee-address"], ["log", "x.log", "--vision"]]
)
def test_an_address_that_is_none_is_told_with_its_option(command: list[str]) -> None:
    said = " ".join(robobt(*command, "here", "--seconds", 0.1, code=2).replace("│", " ").split())
    assert f"{command[-1]}: 'here' is not an address like 224.5.23.2:10006" in said


def test_a_port_that_is_taken_is_one_plain_line() -> None:
    with Receiver("127.0.0.1", 0) as other:
        said = robobt("serve", *quiet()[:3], f"--grsim-port={other.port}", "--seconds", 0.1, code=1)
    assert said == f"robobt: cannot receive at 127.0.0.1:{other.port}: Address already in use\n"


@pytest.mark.integration
@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (["serve", "--simulator", "moon"], "no simulator preset is called 'moon'"),
        (["serve", "--realism", "moon"], "no realism level is called 'moon'"),
        (["serve", "--interface", "203.0.113.7"], "203.0.113.7"),
        (
            ["match", "striker_vs_goalkeeper", "--world", "webots"],
            "webots: a world of the league is league://SIMULATOR",
        ),
        (
            ["match", "striker_vs_goalkeeper", "--world", "nowhere.log"],
            "nowhere.log: No such file or directory",
        ),
        (["show", "nowhere.log"], "nowhere.log: No such file or directory"),
    ],
)
def test_what_is_wrong_is_one_plain_line(arguments: list[str], problem: str) -> None:
    output = robobt(*arguments, code=1)
    assert problem in output
    assert output.count("\n") == 1


def test_a_spoilt_log_is_named(tmp_path: Path) -> None:
    path = tmp_path / "spoilt.log"
    path.write_bytes(b"nothing of the kind")
    assert f"robobt: {path}: is not a log" in robobt("show", path, code=1)


def test_log_writes_what_is_heard(tmp_path: Path) -> None:
    ends = free_endpoints()
    where = [f"--vision={ends.vision}", f"--tracker={ends.tracker}", f"--referee-address={ends.referee}"]
    out = tmp_path / "heard.log"
    printed = json.loads(robobt("log", out, "--seconds", 0.1, *where, "--json"))
    assert printed == {"vision": 0, "tracker": 0, "referee": 0}
    assert list(read_log(out)) == []
    assert "must end in .log" in robobt("log", tmp_path / "heard.txt", code=2)
