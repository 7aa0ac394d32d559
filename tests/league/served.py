"""A server in a thread, on ports of its own, for tests."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager

from robobt.league.serve.served_field import ServedField
from robobt.league.serve.server import SimServer
from robobt.league.wire.endpoints import VISION_GROUP, Endpoint, Endpoints
from robobt.world.state import RobotId


def poses(field: ServedField) -> dict[RobotId, tuple[float, float, float]]:
    """x, y, heading of every robot on the field."""
    return {robot: (state.x, state.y, state.heading) for robot, state in field.truth().robots().items()}


def free_endpoints(group: str = VISION_GROUP) -> Endpoints:
    """Ports that nobody uses; the vision goes to a group, or to one host."""
    sockets = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(9)]
    for sock in sockets:
        sock.bind(("127.0.0.1", 0))
    ports = [sock.getsockname()[1] for sock in sockets]
    for sock in sockets:
        sock.close()
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
            thread.join(5.0)
