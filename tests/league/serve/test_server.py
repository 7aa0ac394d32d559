"""The server answers as the league's simulators do, and drops what makes no sense."""

from __future__ import annotations

import time
from collections.abc import Iterator
from math import nan
from typing import TypeVar

import pytest

from robobt.league.serve.served_field import ServedField, served_line_up
from robobt.league.serve.server import Clock, ServedReferee, SimServer
from robobt.league.wire.commands import BallTeleport, Teleport
from robobt.league.wire.endpoints import Endpoints
from robobt.league.wire.gamecontroller import RefereeFollower
from robobt.league.wire.grsim import write_grsim, write_grsim_replacement
from robobt.league.wire.messages import (
    RealismConfigErForce,
    RobotControlResponse,
    Robots_Status,
    SimulatorCommand,
    SimulatorResponse,
)
from robobt.league.wire.packets import PacketCounts
from robobt.league.wire.simulation import write_control, write_teleport
from robobt.league.wire.sockets import Receiver, Sender
from robobt.league.wire.tracker import read_tracked
from robobt.league.wire.vision import read_vision
from robobt.match.referee.settings import RefereeSettings
from robobt.sim.realism import REALISM
from robobt.sim.settings import SimSettings
from robobt.world.command import RobotCommand
from robobt.world.field import DIVISION_B
from robobt.world.game import Team
from robobt.world.protocol import Placement
from robobt.world.state import RobotId
from tests.league.served import free_endpoints, poses
from tests.waiting import soon

ME, HER = RobotId(Team.BLUE, 0), RobotId(Team.YELLOW, 5)
Answer = TypeVar("Answer")


@pytest.fixture
def endpoints() -> Endpoints:
    return free_endpoints()


@pytest.fixture
def server(endpoints: Endpoints) -> Iterator[SimServer]:
    placement = Placement({ME: (0.0, 0.0, 0.0), HER: (2.0, 1.0, 0.0)}, (0.0965, 0.0, 0.0, 0.0))
    with SimServer(ServedField(DIVISION_B, placement), endpoints) as server:
        yield server


def ask(server: SimServer, port: int, data: bytes) -> bytes:
    """What the server answers to a packet."""
    with Sender("127.0.0.1", port) as sender:
        sender.send(data)

        def answer() -> list[bytes]:
            server.receive()
            return list(sender.answers())

        return soon(answer)[0]


def send(server: SimServer, port: int, data: bytes, counts: PacketCounts) -> None:
    """Send a packet and wait until the server has looked at it."""
    before = counts.accepted + counts.dropped
    with Sender("127.0.0.1", port) as sender:
        sender.send(data)

        def looked() -> bool:
            server.receive()
            return counts.accepted + counts.dropped > before

        soon(looked)


def test_vision_and_tracker_go_out_with_every_step(server: SimServer, endpoints: Endpoints) -> None:
    with Receiver(*endpoints.vision) as vision, Receiver(*endpoints.tracker) as tracker:
        server.step()
        server.send_due(server.field.time)
        seen = read_vision(soon(lambda: list(vision.receive()))[0].data, PacketCounts())
        tracked = read_tracked(soon(lambda: list(tracker.receive()))[0].data, DIVISION_B, PacketCounts())
    assert seen is not None
    assert seen.frame is not None
    assert seen.field == DIVISION_B
    assert {robot.robot for robot in seen.frame.robots} == {ME, HER}
    assert seen.frame.captured == pytest.approx(server.field.time)
    assert tracked is not None
    assert [robot.id for robot in tracked[1].own] == [ME.number]
    assert tracked[1].ball.position == pytest.approx(server.field.truth().ball.position, abs=1e-6)


@pytest.mark.integration
@pytest.mark.parametrize(("clock", "start"), [("sim", 0.0), ("unix", 1_800_000_000.0)])
def test_stamps_advance_with_the_simulated_time_however_busy_the_machine_is(
    endpoints: Endpoints, clock: Clock, start: float
) -> None:
    field = ServedField(DIVISION_B, Placement({ME: (0.0, 0.0, 0.0)}))

    def busy(_: ServedField) -> None:
        if server.frames in (3, 6):
            time.sleep(0.4)

    with (
        SimServer(field, endpoints, epoch=1_800_000_000.0, clock=clock) as server,
        Receiver(*endpoints.vision) as vision,
        Receiver(*endpoints.tracker) as tracker,
    ):
        server.run(on_step=busy, stop=lambda: server.frames >= 12)
        server.send_due(server.field.time)
        seen = [read_vision(packet.data, PacketCounts()) for packet in vision.receive()]
        tracked = [read_tracked(packet.data, DIVISION_B, PacketCounts()) for packet in tracker.receive()]
    assert server.frames == len(seen) == len(tracked) == 12
    assert server.kept < 0.8
    stamps = [packet.frame.captured for packet in seen if packet is not None and packet.frame is not None]
    assert stamps == [start + number * ServedField.period for number in range(1, len(seen) + 1)]
    assert [frame.time for _, frame in filter(None, tracked)] == stamps


def test_the_visions_delay_keeps_frames_back() -> None:
    endpoints = free_endpoints()
    field = ServedField(DIVISION_B, Placement(), SimSettings(realism=REALISM["realistic"]))
    with SimServer(field, endpoints) as server, Receiver(*endpoints.vision) as vision:
        server.step()
        server.send_due(field.time + 0.034)
        time.sleep(0.02)
        assert list(vision.receive()) == []
        server.send_due(field.time + 0.035)
        seen = read_vision(soon(lambda: list(vision.receive()))[0].data, PacketCounts())
    assert seen is not None
    assert seen.frame is not None
    # The timestamps admit to the processing time only.
    assert seen.frame.sent - seen.frame.captured == pytest.approx(0.01)


def test_control_is_answered_with_who_has_the_ball(server: SimServer) -> None:
    data = write_control({0: RobotCommand(), 9: RobotCommand()})
    response = RobotControlResponse.FromString(ask(server, server.endpoints.blue, data))
    assert [(robot.id, robot.dribbler_ball_contact) for robot in response.feedback] == [(0, True)]
    assert [error.code for error in response.errors] == ["NO_ROBOT"]


def test_each_team_has_its_own_control_port(server: SimServer) -> None:
    ask(server, server.endpoints.yellow, write_control({5: RobotCommand(1.0)}))
    for _ in range(5):
        server.step()
    truth = server.field.truth()
    assert truth.opponents[0].speed > 0.1
    assert truth.own[0].speed == 0.0


def test_grsims_status_comes_when_something_changes_and_only_then(
    server: SimServer, endpoints: Endpoints
) -> None:
    with Receiver("127.0.0.1", endpoints.blue_status) as status:

        def told() -> list[tuple[int, bool, bool]]:
            return [
                (robot.robot_id, robot.infrared, robot.flat_kick)
                for packet in status.receive()
                for robot in Robots_Status.FromString(packet.data).robots_status
            ]

        command = write_grsim(Team.BLUE, {0: RobotCommand()}, 0.0)
        send(server, server.endpoints.grsim, command, server.counts["grsim"])
        server.step()
        assert soon(told) == [(0, True, False)]
        server.step()
        time.sleep(0.02)
        assert told() == []
        kick = write_grsim(Team.BLUE, {0: RobotCommand(kick_speed=3.0)}, 0.0)
        send(server, server.endpoints.grsim, kick, server.counts["grsim"])
        server.step()
        assert soon(told) == [(0, False, True)]


def test_grsims_replacement_puts_robots_and_ball(server: SimServer) -> None:
    robots = [Teleport(ME, -1.0, 2.0, 0.5), Teleport(HER, 0.0, 0.0, 0.0, present=False)]
    data = write_grsim_replacement(robots, BallTeleport(1.0, -1.0, 0.0, 0.0))
    send(server, server.endpoints.grsim, data, server.counts["grsim"])
    assert poses(server.field) == {ME: (-1.0, 2.0, pytest.approx(0.5))}
    assert server.field.truth().ball.position == (1.0, -1.0)


def test_a_teleport_that_cannot_be_is_answered_with_an_error(server: SimServer) -> None:
    data = write_teleport([Teleport(ME, 99.0, 0.0, 0.0)], None)
    response = SimulatorResponse.FromString(ask(server, server.endpoints.control, data))
    assert [error.code for error in response.errors] == ["CANNOT_TELEPORT"]
    assert "blue 0 cannot be put at (99, 0)" in response.errors[0].message


def test_the_simulations_speed_can_be_set_within_bounds(server: SimServer) -> None:
    command = SimulatorCommand()
    command.control.simulation_speed = 2.0
    response = SimulatorResponse.FromString(
        ask(server, server.endpoints.control, command.SerializeToString())
    )
    assert not response.errors
    assert server.speed == 2.0
    command.control.simulation_speed = 1e9
    response = SimulatorResponse.FromString(
        ask(server, server.endpoints.control, command.SerializeToString())
    )
    assert [error.code for error in response.errors] == ["SPEED"]
    assert server.speed == 2.0


def test_limits_and_realism_can_be_configured(server: SimServer, endpoints: Endpoints) -> None:
    command = SimulatorCommand()
    spec = command.config.robot_specs.add()
    spec.id.id, spec.id.team = 0, 2
    spec.limits.vel_absolute_max = 0.5
    command.config.realism_config.custom.add().Pack(RealismConfigErForce(missing_ball_detections=1.0))
    response = SimulatorResponse.FromString(
        ask(server, server.endpoints.control, command.SerializeToString())
    )
    assert not response.errors
    for _ in range(30):
        server.field.command(ME, RobotCommand(3.0))
        server.step()
    assert server.field.truth().own[0].speed <= 0.5 + 1e-6
    with Receiver(*endpoints.vision) as vision:
        server.send_due(server.field.time)
        for packet in soon(lambda: list(vision.receive())):
            seen = read_vision(packet.data, PacketCounts())
            assert seen is not None
            assert seen.frame is not None
            assert seen.frame.balls == []


def test_a_message_sets_all_of_er_forces_realism(server: SimServer) -> None:
    command = SimulatorCommand()
    message = RealismConfigErForce(
        ball_visibility_threshold=0.3,
        camera_overlap=1.5,
        camera_position_error=0.2,
        dribbler_ball_detections=0.5,
        robot_response_loss=1.0,
        vision_delay=40_000_000,
        vision_processing_time=10_000_000,
    )
    command.config.realism_config.custom.add().Pack(message)
    ask(server, server.endpoints.control, command.SerializeToString())
    realism = server._cameras.realism
    assert (realism.hidden_below, realism.camera_overlap) == pytest.approx((0.3, 1.5))
    assert (realism.camera_error, realism.false_balls) == pytest.approx((0.2, 0.5))
    assert (realism.vision_delay, realism.processing_time) == pytest.approx((0.04, 0.01))
    data = write_control({ME.number: RobotCommand(1.0)})
    answer = RobotControlResponse.FromString(ask(server, server.endpoints.blue, data))
    # Every response is lost, no command.
    assert (list(answer.feedback), list(answer.errors)) == ([], [])
    off = SimulatorCommand()
    off.config.realism_config.custom.add().Pack(RealismConfigErForce(enable_invisible_ball=False))
    ask(server, server.endpoints.control, off.SerializeToString())
    assert server._cameras.realism.hidden_below == 0.0


def test_what_cannot_be_configured_is_answered_with_an_error(server: SimServer) -> None:
    command = SimulatorCommand()
    command.config.vision_port = 1
    spec = command.config.robot_specs.add()
    spec.id.id, spec.id.team = 0, 2
    spec.limits.vel_absolute_max = nan
    realism = RealismConfigErForce(stddev_ball_p=-1.0)
    command.config.realism_config.custom.add().Pack(realism)
    response = SimulatorResponse.FromString(
        ask(server, server.endpoints.control, command.SerializeToString())
    )
    assert [error.code for error in response.errors] == ["FIXED", "ROBOT_SPECS", "REALISM"]


def test_what_makes_no_sense_is_counted_at_every_port(server: SimServer) -> None:
    ports = server.endpoints
    for name, port in (
        ("grsim", ports.grsim),
        ("control", ports.control),
        ("blue", ports.blue),
        ("yellow", ports.yellow),
    ):
        for junk in (b"\xff\xff\xff", b"\x0a\x05abc", bytes(20_000)):
            send(server, port, junk, server.counts[name])
        assert server.counts[name].dropped == 3


def test_the_servers_referee_publishes_what_it_decides(endpoints: Endpoints) -> None:
    field = served_line_up(DIVISION_B, 2, "default")
    follower = RefereeFollower()
    server = SimServer(field, endpoints, referee=RefereeSettings())
    with server, Receiver(*endpoints.referee) as controller:
        assert server.referee is not None
        for _ in range(300):
            server.step()
            for packet in controller.receive():
                assert follower.read(packet.data)
        soon(lambda: list(controller.receive()) or True)
        assert follower.game.command is server.referee.referee.game.command
        assert follower.game.restart is server.referee.referee.game.restart


def test_the_servers_referee_publishes_who_committed_a_foul() -> None:
    placement = Placement({ME: (-1.0, 0.0, 0.0), HER: (0.4, 0.0, 0.0)}, (0.0, 0.0, 0.0, 0.0))
    field = ServedField(DIVISION_B, placement)
    follower, told = RefereeFollower(), []
    referee = ServedReferee(field, RefereeSettings())
    for _ in range(270):
        field.step()
        message = referee.judge(1000.0 + field.time)
        if message is not None:
            assert follower.read(message)
            told += follower.reported(field.time)
    # It stays too close to the ball at the kick-off and is reported every two seconds.
    assert {(event.kind, event.robot) for event in told} == {("defender_too_close_to_kick_point", HER)}
    assert len(told) == 2


def test_a_server_whose_port_is_taken_says_so_and_frees_the_others(
    server: SimServer, endpoints: Endpoints
) -> None:
    other = free_endpoints().model_copy(update={"yellow": server.endpoints.yellow})
    with pytest.raises(OSError, match=f":{server.endpoints.yellow}: "):
        SimServer(server.field, other)
    with Receiver("127.0.0.1", other.grsim):
        pass
