"""What only some operating systems can do says so where it cannot, and all else does without it."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import pytest

from robobt.config.systems import SystemUnfitError, need_posix
from robobt.league.programs.world import ProgramWorld
from robobt.league.referee.process import GameControllerProcess
from robobt.league.wire.sockets import Receiver, Sender
from robobt.match import load_scenario
from tests.league.wire.test_sockets import GROUP, received
from tests.match.scripted import PlainWorld


def test_here_processes_can_be_stopped_by_signals() -> None:
    need_posix("a test")


def test_what_starts_programs_says_what_it_needs(monkeypatch: pytest.MonkeyPatch) -> None:
    scenario = load_scenario("striker_vs_goalkeeper")
    world = PlainWorld(scenario)
    monkeypatch.setattr("robobt.config.systems.os", SimpleNamespace(name="nt"))
    with pytest.raises(SystemUnfitError, match="a team's own program needs Linux or macOS; on Windows"):
        ProgramWorld(world, scenario, {}, {}, {})
    monkeypatch.setattr("tempfile.TemporaryDirectory", None)
    with pytest.raises(SystemUnfitError, match="the official game controller needs Linux or macOS"):
        GameControllerProcess(Path("anything"))


@pytest.mark.parametrize("system", ["win32", "darwin"])
def test_packets_arrive_where_sockets_can_do_less(system: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("robobt.league.wire.sockets.sys", SimpleNamespace(platform=system))
    for address in (GROUP, "127.0.0.1"):
        with Receiver(address, 0) as receiver, Sender(address, receiver.port) as sender:
            sender.send(b"a frame")
            assert [packet.data for packet in received(receiver)] == [b"a frame"]
