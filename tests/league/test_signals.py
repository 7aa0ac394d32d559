"""A process that is ended from outside stops its robots first."""

from __future__ import annotations

import os
import signal

from robobt.league.wire.grsim import read_grsim
from robobt.league.wire.packets import PacketCounts
from robobt.league.wire.sockets import Receiver
from robobt.world.command import RobotCommand
from robobt.world.game import Team
from robobt.world.state import RobotId
from tests.conftest import StartPython
from tests.league.served import free_endpoints

KILLED = """
import time
from robobt.league.signals import exit_on_signals
from robobt.league.world import LeagueWorld
from robobt.world import RobotId, Team
exit_on_signals()
world = LeagueWorld(robots={RobotId(Team.BLUE, 0): None}, endpoints={endpoints})
print("ready", flush=True)
time.sleep(60)
"""


def test_a_process_that_is_told_to_end_stops_its_robots_first(start_python: StartPython) -> None:
    endpoints = free_endpoints()
    code = KILLED.replace("{endpoints}", repr(endpoints.model_dump(mode="json")))
    with Receiver("127.0.0.1", endpoints.grsim) as grsim:
        process = start_python("-c", code)
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        assert list(grsim.receive()) == []
        os.kill(process.pid, signal.SIGTERM)
        assert process.wait(20) == 128 + signal.SIGTERM
        packets = list(grsim.receive())
    assert packets
    for packet in packets:
        request = read_grsim(packet.data, PacketCounts())
        assert request is not None
        assert request.commands == {RobotId(Team.BLUE, 0): RobotCommand()}
