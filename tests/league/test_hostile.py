"""A million mutated packets to every open port: nothing crashes or hangs, memory stays, drops are counted."""

from __future__ import annotations

import random
import tracemalloc
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from dataclasses import asdict
from math import isfinite

import pytest

from robobt.league.commands import (
    BallTeleport,
    Teleport,
    write_control,
    write_grsim,
    write_grsim_placement,
    write_teleport,
)
from robobt.league.endpoints import Endpoints
from robobt.league.gamecontroller import RefereePublisher
from robobt.league.messages import RealismConfigErForce, RobotControlResponse, Robots_Status, SimulatorCommand
from robobt.league.server import SimServer
from robobt.league.serving import served_line_up
from robobt.league.sockets import MAX_PACKET, PacketCounts, Sender
from robobt.league.tracker import read_tracked, write_tracked
from robobt.league.vision import write_field, write_vision
from robobt.league.world import LeagueWorld
from robobt.world.command import RobotCommand
from robobt.world.field import DIVISION_B
from robobt.world.game import OPEN_PLAY, Team
from robobt.world.state import Frame, RobotId
from tests.league.served import free_endpoints
from tests.league.test_vision import frame

ME = RobotId(Team.BLUE, 0)
_BATCH = 100


def seeds() -> dict[str, list[bytes]]:
    """Packets that make sense, by the port they are for."""
    config = SimulatorCommand()
    config.control.simulation_speed = 1.0
    spec = config.config.robot_specs.add()
    spec.id.id, spec.id.team, spec.limits.vel_absolute_max = 0, 2, 3.0
    config.config.realism_config.custom.add().Pack(RealismConfigErForce(stddev_ball_p=0.001, vision_delay=1))
    status = Robots_Status()
    status.robots_status.add(robot_id=0, infrared=True, flat_kick=False, chip_kick=False)
    feedback = RobotControlResponse()
    feedback.feedback.add(id=0, dribbler_ball_contact=True)
    commands = {i: RobotCommand(1.0, -0.5, 2.0, 3.0, dribbler=True) for i in range(3)}
    places = [Teleport(ME, 0.5, 0.5, 1.0, present=True), Teleport(RobotId(Team.YELLOW, 1), 1.0, 0.0, 2.0)]
    tracked = served_line_up(DIVISION_B, 2).truth()
    return {
        "grsim": [
            write_grsim(Team.BLUE, commands, 1.0),
            write_grsim_placement(places, BallTeleport(0.0, 0.0)),
        ],
        "control": [write_teleport(places, BallTeleport(0.0, 0.0, 1.0, 0.0)), config.SerializeToString()],
        "blue": [write_control(commands)],
        "yellow": [write_control(commands)],
        "vision": [write_vision(frame()), write_vision(frame(), write_field(DIVISION_B))],
        "referee": [RefereePublisher().write(OPEN_PLAY, 1.0)],
        "blue_status": [status.SerializeToString()],
        "tracker": [write_tracked(tracked, 1, 1.0, "id")],
    }


def mutated(rng: random.Random, packets: list[bytes]) -> bytes:
    """A packet spoilt in one of many ways."""
    data = bytearray(rng.choice(packets))
    kind = rng.randrange(7)
    if kind == 0:
        return rng.randbytes(rng.randrange(200))
    if kind == 1:
        return bytes(data[: rng.randrange(len(data) + 1)])
    if kind == 2 and rng.random() < 0.02:
        return bytes(data) * (MAX_PACKET // len(data) + 2)
    if kind == 3:
        return bytes(data) + rng.choice(packets) * rng.randrange(1, 20)
    for _ in range(rng.randrange(1, 12)):
        place = rng.randrange(len(data))
        data[place] = rng.choice([rng.randrange(256), 0xFF, 0x7F, 0x80, 0x00, 0xC0])
    if kind == 4:
        place = rng.randrange(len(data))
        data[place:place] = rng.choice(
            [b"\xff" * 8, b"\x00\x00\xc0\x7f", b"\x00\x00\x80\x7f", rng.randbytes(4)]
        )
    return bytes(data)


def clocks() -> Callable[[], float]:
    """A clock that a test can wait for: it moves five milliseconds each time it is asked."""
    now = [0.0]

    def clock() -> float:
        now[0] += 0.005
        return now[0]

    return clock


def attack(count: int, seed: int) -> Iterator[tuple[SimServer, LeagueWorld, dict[str, PacketCounts], int]]:
    """Send so many mutated packets to every port, in batches; yields after each."""
    rng = random.Random(seed)
    served, listening = free_endpoints(), free_endpoints("127.0.0.1")
    packets = seeds()
    with ExitStack() as stack:
        server = stack.enter_context(SimServer(served_line_up(DIVISION_B, 3, "default"), served))
        world = stack.enter_context(
            LeagueWorld(endpoints=listening, follow_referee=True, clock=clocks(), robots={ME: None})
        )
        ports = {name: getattr(served, name) for name in ("grsim", "control", "blue", "yellow")}
        heard: Endpoints = listening
        ports |= {
            "vision": heard.vision.port,
            "referee": heard.referee.port,
            "blue_status": heard.blue_status,
        }
        senders = {name: stack.enter_context(Sender("127.0.0.1", port)) for name, port in ports.items()}
        counts = {**server.counts, **world.counts(), "tracker": PacketCounts()}
        sent = 0
        while sent < count:
            for _ in range(_BATCH):
                for name, sender in senders.items():
                    sender.send(mutated(rng, packets[name]))
                read_tracked(mutated(rng, packets["tracker"]), DIVISION_B, counts["tracker"])
            sent += _BATCH
            server.receive()
            server.step()
            server.send_due(1e9)
            world.act({ME: RobotCommand(1.0)})
            yield server, world, counts, sent


def check(server: SimServer, world: LeagueWorld) -> None:
    for seen in (server.field.truth(), world.observe(), world.truth()):
        assert_sane(seen)


def assert_sane(seen: Frame) -> None:
    for robot in (*seen.own, *seen.opponents):
        assert all(map(isfinite, (robot.x, robot.y, robot.heading, robot.vx, robot.vy, robot.omega)))
    assert all(map(isfinite, (seen.time, *seen.ball.position, seen.ball.vx, seen.ball.vy)))


def test_mutated_packets_to_every_port_are_used_or_counted() -> None:
    counts: dict[str, PacketCounts] = {}
    for server, world, found, _ in attack(1_000, seed=1):
        check(server, world)
        counts = found
    for name in ("grsim", "control", "blue", "yellow", "vision", "referee", "blue_status", "tracker"):
        assert counts[name].unreadable > 20, name
        assert counts[name].accepted + counts[name].dropped > 600, name


@pytest.mark.slow
def test_a_million_mutated_packets_to_every_port_leave_no_trace() -> None:
    before = 0
    counts: dict[str, PacketCounts] = {}
    for server, world, found, sent in attack(1_000_000, seed=2):
        if sent == 100_000:
            tracemalloc.start()
            before = tracemalloc.get_traced_memory()[0]
        if sent % 50_000 == 0:
            check(server, world)
        counts = found
    grown = tracemalloc.get_traced_memory()[0] - before
    tracemalloc.stop()
    assert grown < 20_000_000
    for name, count in counts.items():
        if name in seeds():
            assert count.dropped > 100_000, (name, asdict(count))
