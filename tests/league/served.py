"""A server in a thread, on ports of its own, for tests."""

from __future__ import annotations

import os
import secrets
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

from robobt.league.serve.served_field import ServedField
from robobt.league.serve.server import SimServer
from robobt.league.wire.endpoints import Endpoint, Endpoints
from robobt.league.world import LeagueWorld
from robobt.world.command import RobotCommand
from robobt.world.state import Frame, RobotId
from tests.waiting import LIMIT


def poses(field: ServedField) -> dict[RobotId, tuple[float, float, float]]:
    """x, y, heading of every robot on the field."""
    return {robot: (state.x, state.y, state.heading) for robot, state in field.truth().robots().items()}


_PORTS = range(21_000, 30_000)
"""Neither the league's ports, nor those that the system gives away before a test gets to use them."""

_GROUP = f"239.254.{os.getpid() >> 8 & 255}.{os.getpid() & 255}"
"""A multicast group that no other process with tests sends to."""


def free_endpoints(group: str = _GROUP) -> Endpoints:
    """Ports that nobody uses; the vision goes to a group, or to one host."""
    ports: list[int] = []
    while len(ports) < 9:
        port = _PORTS[secrets.randbelow(len(_PORTS))]
        with suppress(OSError), socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
            sock.bind(("127.0.0.1", port))
            ports += [port] * (port not in ports)
    return Endpoints(
        vision=Endpoint(group, ports[0]),
        tracker=Endpoint(group, ports[1]),
        referee=Endpoint(group, ports[2]),
        grsim=ports[3],
        control=ports[4],
        blue=ports[5],
        yellow=ports[6],
        blue_status=ports[7],
        yellow_status=ports[8],
    )


def drive(
    world: LeagueWorld, commands: dict[RobotId, RobotCommand], until: Callable[[Frame], bool], ticks: int = 20
) -> Frame:
    """Command robots for some ticks, and on until something is seen; a busy machine stalls what is seen."""
    end = time.monotonic() + LIMIT
    while not until(world.observe()) or ticks > 0:
        assert time.monotonic() < end, f"it is not seen: {world.observe()}"
        world.act(commands)
        ticks -= 1
    return world.observe()


@contextmanager
def served(
    field: ServedField, endpoints: Endpoints, speed: float = 1.0, cameras: int = 1
) -> Iterator[SimServer]:
    """The field, served until the end of the block."""
    ended = threading.Event()
    with SimServer(field, endpoints, speed=speed, cameras=cameras) as server:
        thread = threading.Thread(target=lambda: server.run(stop=ended.is_set), daemon=True)
        thread.start()
        try:
            yield server
        finally:
            ended.set()
            thread.join(LIMIT)
