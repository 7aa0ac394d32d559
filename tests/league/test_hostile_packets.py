"""Whatever arrives at an open port is used or counted; nothing crashes, hangs or piles up."""

from __future__ import annotations

import math
import socket
import sys
from collections.abc import Callable, Iterator
from dataclasses import asdict
from itertools import islice

import numpy as np
import pytest

from robobt.league.serve.cameras import Cameras
from robobt.league.serve.served_field import ServedField, line_up
from robobt.league.serve.server import SimServer
from robobt.league.wire.commands import BallTeleport, Teleport
from robobt.league.wire.endpoints import Endpoints
from robobt.league.wire.geometry import write_geometry
from robobt.league.wire.grsim import write_grsim, write_grsim_replacement
from robobt.league.wire.messages import (
    Message,
    RealismConfigErForce,
    Referee,
    RobotControl,
    Robots_Status,
    SimulatorCommand,
    SSL_WrapperPacket,
    TrackerWrapperPacket,
    grSim_Packet,
)
from robobt.league.wire.packets import PacketCounts
from robobt.league.wire.referee_publisher import RefereePublisher
from robobt.league.wire.simulation import write_teleport
from robobt.league.wire.tracker import write_tracked
from robobt.league.wire.vision import write_vision
from robobt.league.world import LeagueWorld
from robobt.sim.realism import REALISM
from robobt.world.command import RobotCommand
from robobt.world.field import DIVISION_B
from robobt.world.game import GameState, RefereeCommand, Restart, Team
from robobt.world.state import RobotId
from tests.league.mutations import mutations
from tests.league.served import free_endpoints, poses

FEW, MANY = 2_000, 1_000_000
BATCH = 40
"""Datagrams sent in one go; so many of the longest ones a socket can keep."""

AMOUNTS = [FEW, pytest.param(MANY, marks=pytest.mark.slow)]

ME, HER = RobotId(Team.BLUE, 0), RobotId(Team.YELLOW, 1)


@pytest.fixture
def endpoints() -> Endpoints:
    return free_endpoints()


@pytest.fixture
def sock() -> Iterator[socket.socket]:
    """Where packets come from: one sender, as others would not be followed."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
        yield sock


@pytest.fixture
def server(endpoints: Endpoints) -> Iterator[SimServer]:
    with SimServer(ServedField(DIVISION_B, line_up(DIVISION_B, 2)), endpoints) as server:
        yield server


@pytest.fixture
def world(endpoints: Endpoints) -> Iterator[LeagueWorld]:
    robots = dict.fromkeys((ME, HER))
    with LeagueWorld(robots=robots, endpoints=endpoints, follow_referee=True) as world:
        yield world


def hammer(
    sock: socket.socket,
    to: tuple[str, int],
    seeds: list[Message],
    amount: int,
    counts: list[PacketCounts],
    take_in: Callable[[], object],
) -> None:
    """Send mutated packets and have them taken in; every one of them has to be counted."""
    packets = mutations(seeds, seed=amount)

    def counted(name: str | None = None) -> int:
        every = [asdict(one) for one in counts]
        return sum(one[name] if name else sum(one.values()) for one in every)

    before = counted()
    blocks = []
    for number in range(0, amount, BATCH):
        if number in (amount // 2, amount - BATCH):
            blocks.append(sys.getallocatedblocks())
        for data in islice(packets, BATCH):
            sock.sendto(data, to)
        for _ in range(1000):
            if counted() >= before + number + BATCH:
                break
            take_in()
        assert counted() == before + number + BATCH
    for name in ("accepted", "unreadable", "incomplete", "implausible", "oversized"):
        assert counted(name) > 0, name
    # Objects that Python has for all that: no more than before.
    assert blocks[1] - blocks[0] < 5_000


def commands_of_grsim() -> list[Message]:
    commands = {number: RobotCommand(1.0, -0.5, 2.0, 4.0, dribbler=True) for number in range(2)}
    robots = [Teleport(RobotId(team, n), 1.0, float(n), 0.5) for team in Team for n in range(2)]
    place = write_grsim_replacement(robots, BallTeleport(0.5, 0.5, 1.0, 0.0))
    wheels = grSim_Packet.FromString(write_grsim(Team.YELLOW, commands, 1.0))
    for robot in wheels.commands.robot_commands:
        robot.wheelsspeed = True
        robot.wheel1 = robot.wheel2 = robot.wheel3 = robot.wheel4 = 30.0
    return [
        grSim_Packet.FromString(write_grsim(Team.BLUE, commands, 1.0)),
        grSim_Packet.FromString(place),
        wheels,
    ]


def controls() -> list[Message]:
    message = RobotControl()
    for number in range(3):
        robot = message.robot_commands.add(id=number, kick_speed=3.0, kick_angle=0.0, dribbler_speed=1500.0)
        if number == 0:
            robot.move_command.local_velocity.forward = 1.0
            robot.move_command.local_velocity.left = robot.move_command.local_velocity.angular = 0.5
        elif number == 1:
            robot.move_command.global_velocity.x = robot.move_command.global_velocity.y = 0.5
            robot.move_command.global_velocity.angular = 0.1
        else:
            wheels = robot.move_command.wheel_velocity
            wheels.front_left = wheels.back_left = wheels.back_right = wheels.front_right = 1.0
    return [message]


def orders_to_the_simulator() -> list[Message]:
    robots = [
        Teleport(RobotId(team, n), 1.0, float(n), 0.5, 1.0, 0.0, 1.0) for team in Team for n in range(2)
    ]
    teleport = SimulatorCommand.FromString(write_teleport(robots, BallTeleport(0.5, 0.5, 1.0, 0.0)))
    configure = SimulatorCommand()
    configure.control.simulation_speed = 1.0
    for number in range(2):
        spec = configure.config.robot_specs.add()
        spec.id.id, spec.id.team = number, 2
        spec.limits.vel_absolute_max = spec.limits.vel_angular_max = 2.0
    configurations: list[Message] = [teleport, configure]
    for realism in (
        RealismConfigErForce(stddev_ball_p=0.1, stddev_robot_p=1e38, missing_ball_detections=0.5),
        RealismConfigErForce(vision_delay=2**62),
        RealismConfigErForce(vision_delay=100_000_000, robot_command_loss=0.1, stddev_robot_phi=0.1),
    ):
        one = SimulatorCommand()
        one.config.realism_config.custom.add().Pack(realism)
        configurations.append(one)
    return configurations


@pytest.mark.integration
@pytest.mark.parametrize("amount", AMOUNTS)
@pytest.mark.parametrize("port", ["grsim", "control", "blue", "yellow"])
def test_the_server_survives_what_is_sent_to_its_ports(
    sock: socket.socket, server: SimServer, port: str, amount: int
) -> None:
    seeds = {"grsim": commands_of_grsim, "control": orders_to_the_simulator}.get(port, controls)()

    def take_in() -> None:
        server.receive()
        server.step()
        server.send_due(server.field.time)

    hammer(
        sock, ("127.0.0.1", getattr(server.endpoints, port)), seeds, amount, [server.counts[port]], take_in
    )
    # Nothing is left of it but a field like any other, on which robots obey.
    server.ports.set_realism(REALISM["none"])
    server.field.teleport_ball(BallTeleport(-1.0, 1.0, 0.0, 0.0))
    assert server.field.teleport(Teleport(ME, 0.0, 0.0, 0.0)) is None
    server.field.limit(ME, server.field.settings.limits)
    for robot, pose in poses(server.field).items():
        assert all(map(math.isfinite, pose)), robot
        if robot != ME:
            server.field.teleport(Teleport(robot, present=False))
    for _ in range(30):
        assert server.field.command(ME, RobotCommand(1.0))
        server.step()
    (me,) = server.field.truth().own
    assert me.speed == pytest.approx(1.0, abs=0.01)
    assert server.field.truth().ball.position == pytest.approx((-1.0, 1.0))


class Vision:
    """What a camera over a field at rest sends, its clock running on."""

    def __init__(self) -> None:
        self.field = ServedField(DIVISION_B, line_up(DIVISION_B, 2))
        self.cameras = Cameras(DIVISION_B, REALISM["none"], 1, np.random.default_rng(0))
        self.time = 100.0

    def packet(self) -> bytes:
        self.time += 1 / 60
        (frame,) = self.cameras.capture(self.field.truth(), self.time, self.time)
        return write_vision(frame, write_geometry(DIVISION_B))


@pytest.mark.parametrize("amount", AMOUNTS)
def test_the_player_survives_what_is_sent_as_vision(
    sock: socket.socket, world: LeagueWorld, endpoints: Endpoints, amount: int
) -> None:
    vision = Vision()
    seeds: list[Message] = [SSL_WrapperPacket.FromString(vision.packet()) for _ in range(20)]
    turn = 0

    def take_in() -> None:
        nonlocal turn
        turn += 1
        world._feed.receive(0.0)
        for frame in (world.observe(), world.truth()):
            for state in (*frame.own, *frame.opponents):
                assert all(
                    map(math.isfinite, (state.x, state.y, state.heading, state.vx, state.vy, state.omega))
                )
            assert all(map(math.isfinite, (*frame.ball.position, frame.ball.vx, frame.ball.vy)))
        if turn % 500 == 0:
            world.act({ME: RobotCommand(1.0)})

    hammer(sock, endpoints.vision, seeds, amount, [world.counts()["vision"]], take_in)
    # It sees again at once what is there.
    for _ in range(60):
        sock.sendto(vision.packet(), endpoints.vision)
        world._feed.receive(0.1)
        world.observe()
    frame = world.truth()
    assert {RobotId(team, n) for team in Team for n in range(2)} <= set(frame.robots())
    assert frame.own[0].position == pytest.approx(poses(vision.field)[ME][:2], abs=0.01)


@pytest.mark.parametrize("amount", AMOUNTS)
@pytest.mark.parametrize("port", ["referee_port", "blue_status", "yellow_status"])
def test_the_player_survives_what_is_sent_to_its_other_ports(
    sock: socket.socket, world: LeagueWorld, endpoints: Endpoints, port: str, amount: int
) -> None:
    counts = [world.counts()[port]]
    if port == "referee_port":
        counts.append(world.counts()["referee"])
        game = GameState(
            RefereeCommand.STOP, restart=Restart.FREE_KICK, restart_team=Team.BLUE, placement=(1.0, 1.0)
        )
        seeds: list[Message] = [Referee.FromString(RefereePublisher().write(game, 5.0))]
        to: tuple[str, int] = endpoints.referee
    else:
        status = Robots_Status()
        for number in range(3):
            status.robots_status.add(robot_id=number, infrared=True, flat_kick=False, chip_kick=False)
        seeds = [status]
        to = ("127.0.0.1", getattr(endpoints, port))

    def take_in() -> None:
        world._feed.receive(0.0)
        world._feed.filter.possession.feedback.update(world._link.feedback())
        world.observe()

    hammer(sock, to, seeds, amount, counts, take_in)


@pytest.mark.parametrize("amount", AMOUNTS)
def test_the_player_survives_what_is_sent_as_tracked_frames(
    sock: socket.socket, endpoints: Endpoints, amount: int
) -> None:
    field = ServedField(DIVISION_B, line_up(DIVISION_B, 2))
    seeds: list[Message] = [
        TrackerWrapperPacket.FromString(write_tracked(field.truth(), number, 100.0 + number / 60, "one"))
        for number in range(20)
    ]
    with LeagueWorld(robots=dict.fromkeys((ME, HER)), endpoints=endpoints, source="tracker") as world:

        def take_in() -> None:
            world._feed.receive(0.0)
            for state in world.observe().own:
                assert all(map(math.isfinite, (state.x, state.y, state.heading, state.vx, state.vy)))

        hammer(sock, endpoints.tracker, seeds, amount, [world.counts()["tracker"]], take_in)


def test_packets_that_ask_for_more_robots_than_there_are_cost_next_to_nothing(server: SimServer) -> None:
    control, grsim, orders = RobotControl(), grSim_Packet(), SimulatorCommand()
    for _ in range(300):
        control.robot_commands.add(id=1)
        grsim.replacement.robots.add(x=0.0, y=0.0, dir=0.0, id=1, yellowteam=True)
        orders.config.realism_config.custom.add()
    before = poses(server.field)
    ports = server.endpoints
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
        for name, port, message in (
            ("blue", ports.blue, control),
            ("grsim", ports.grsim, grsim),
            ("control", ports.control, orders),
        ):
            sock.sendto(message.SerializeToString(), ("127.0.0.1", port))
            for _ in range(1000):
                server.receive()
                if server.counts[name].dropped:
                    break
            assert server.counts[name].implausible == 1
    assert poses(server.field) == before
