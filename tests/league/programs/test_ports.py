"""Every match has ports of its own, and a team commands its own robots only."""

from __future__ import annotations

import select
import socket
from contextlib import ExitStack
from math import nan
from typing import Self

import pytest

from robobt.league.programs.ports import MatchPorts, StepPort
from robobt.league.wire.grsim import write_grsim
from robobt.league.wire.messages import RobotControlResponse, SimulationSyncRequest, SimulationSyncResponse
from robobt.league.wire.simulation import write_control, write_teleport
from robobt.league.wire.sockets import Receiver
from robobt.league.wire.stream import MessageStream
from robobt.league.wire.vision import BallDetection, CameraFrame
from robobt.world.command import RobotCommand
from robobt.world.field import DIVISION_B
from robobt.world.game import Team
from robobt.world.state import BallState, Frame, RobotId, RobotState
from tests.waiting import LIMIT

BLUE = RobotId(Team.BLUE, 0)
TRUTH = Frame(0.0, DIVISION_B, BallState(0.0, 0.0), (RobotState(0, 0.0, 0.0, ball_contact=True),), ())


def send(port: str, *packets: bytes) -> socket.socket:
    sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    for packet in packets:
        sock.sendto(packet, ("127.0.0.1", int(port)))
    return sock


def test_no_two_matches_share_a_port() -> None:
    with MatchPorts(Team) as one, MatchPorts(Team) as other:
        addresses = [ports.addresses(team) for ports in (one, other) for team in Team]
        own = [value for each in addresses for name, value in each.items() if name in ("grsim", "protocol")]
        assert len(set(own)) == len(own) == 8
        for name in ("vision", "tracker", "referee"):
            assert len({each[name] for each in addresses}) == 2


def test_what_is_sent_reaches_the_own_match_only() -> None:
    with MatchPorts(Team) as one, MatchPorts(Team) as other:
        places = [ports.addresses(Team.BLUE)["vision"].split(":") for ports in (one, other)]
        with (
            Receiver(places[0][0], int(places[0][1])) as near,
            Receiver(places[1][0], int(places[1][1])) as far,
        ):
            one.senders["vision"].send(b"seen")
            assert select.select([near], [], [], LIMIT)[0]
            assert [packet.data for packet in near.receive()] == [b"seen"]
            assert list(far.receive()) == []


@pytest.mark.parametrize("shared", [(), ("vision",)])
@pytest.mark.parametrize("listens", ["everywhere", "group"])
def test_a_program_never_hears_the_match_beside_it(shared: tuple[str, ...], listens: str) -> None:
    with MatchPorts(Team, shared) as one, MatchPorts(Team, shared) as other, ExitStack() as opened:
        near, far = [listening(opened, ports.addresses(Team.BLUE), listens) for ports in (one, other)]
        for _ in range(3):
            other.senders["vision"].send(b"theirs")
        assert select.select([far], [], [], LIMIT)[0]
        assert not select.select([near], [], [], 0.05)[0]
        one.senders["vision"].send(b"seen")
        assert select.select([near], [], [], LIMIT)[0]
        assert near.recv(100) == b"seen"


def listening(opened: ExitStack, addresses: dict[str, str], listens: str) -> socket.socket:
    """Join a match's vision as a careless program does, or bound to the group."""
    sock = opened.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    group, port = addresses["vision_group"], int(addresses["vision_port"])
    sock.bind(("" if listens == "everywhere" else group, port))
    member = socket.inet_aton(group) + socket.inet_aton("127.0.0.1")
    sock.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, member)
    return sock


def test_a_match_has_groups_of_its_own_unless_a_program_takes_ports_only() -> None:
    with MatchPorts(Team) as one, MatchPorts(Team, ["vision"]) as other:
        own, shared = one.addresses(Team.BLUE), other.addresses(Team.BLUE)
        groups = [
            each[f"{name}_group"] for each in (own, shared) for name in ("vision", "tracker", "referee")
        ]
        assert groups[3] == "224.5.23.2"
        assert len({*groups}) == 6
        assert all(group.startswith("239.255.") for group in groups[:3] + groups[4:])
        assert own["vision"] == f"{own['vision_group']}:{own['vision_port']}"


def test_a_team_commands_by_either_protocol() -> None:
    with MatchPorts([Team.BLUE]) as ports:
        addresses = ports.addresses(Team.BLUE)
        with send(addresses["grsim"], write_grsim(Team.BLUE, {0: RobotCommand(vx=1.0)}, 0.0)):
            assert ports.commands(TRUTH)[Team.BLUE][BLUE].vx == 1.0
        with send(addresses["protocol"], write_control({0: RobotCommand(vx=0.5)})) as sock:
            assert ports.commands(TRUTH)[Team.BLUE][BLUE].vx == 0.5
            sock.settimeout(LIMIT)
            answer = RobotControlResponse.FromString(sock.recv(2048))
        assert [(feedback.id, feedback.dribbler_ball_contact) for feedback in answer.feedback] == [(0, True)]


@pytest.mark.parametrize(
    "packet",
    [
        write_grsim(Team.YELLOW, {0: RobotCommand(vx=1.0)}, 0.0),
        write_grsim(Team.BLUE, {0: RobotCommand(vx=float("nan"))}, 0.0),
        b"",
        b"no packet at all",
    ],
)
def test_what_is_not_for_its_own_robots_is_dropped(packet: bytes) -> None:
    with MatchPorts([Team.BLUE]) as ports, send(ports.addresses(Team.BLUE)["grsim"], packet):
        assert not ports.commands(TRUTH).get(Team.BLUE)


def test_who_sends_far_more_than_anybody_needs_has_flooded() -> None:
    packet = write_grsim(Team.BLUE, {0: RobotCommand(vx=1.0)}, 0.0)
    with MatchPorts(Team) as ports:
        blue, yellow = [ports.addresses(team)["grsim"] for team in Team]

        def periods(number: int, packets: int) -> None:
            for _ in range(number):
                with send(blue, *[packet] * packets), send(yellow, packet):
                    left = packets
                    while left > 0:
                        left -= 250
                        ports.commands(TRUTH)
                ports.period_over()

        periods(1, 500)
        periods(70, 50)
        assert ports.flooded is None
        periods(20, 300)
        assert ports.flooded is Team.BLUE


PERIOD = 1 / 60
SEEN = CameraFrame(0, 7, 1.0, 1.0, [BallDetection(1.0, 2.0)])


class Client:
    def __init__(self, port: StepPort) -> None:
        self._port = port
        self.stream = MessageStream(socket.create_connection(("127.0.0.1", port.port)), "the match")
        assert port.receive() is None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.stream.close()

    def ask(self, step: float, control: bytes = b"", command: bytes = b"") -> bytes | None:
        request = SimulationSyncRequest(sim_step=step)
        if control:
            request.robot_control.MergeFromString(control)
        if command:
            request.simulator_command.MergeFromString(command)
        self.stream.send(request.SerializeToString())
        select.select([self._port], [], [], LIMIT)
        return self._port.receive()

    def answer(self) -> SimulationSyncResponse:
        data = self.stream.receive(LIMIT)
        assert data is not None
        return SimulationSyncResponse.FromString(data)


def test_it_is_answered_once_as_much_time_has_passed_as_it_asked_for() -> None:
    with StepPort(PERIOD) as port, Client(port) as client:
        control = write_control({3: RobotCommand(vx=1.0)})
        assert client.ask(2 * PERIOD, control) == control
        assert port.left == 2
        port.passed()
        port.answer(SEEN, [3])
        assert client.stream.receive(0.0) is None
        port.passed()
        port.answer(SEEN, [3])
        answer = client.answer()
        assert [frame.frame_number for frame in answer.detection] == [7]
        told = [(one.id, one.dribbler_ball_contact) for one in answer.robot_control_response.feedback]
        assert told == [(3, True)]
        port.answer(SEEN, [])
        assert client.stream.receive(0.0) is None


def test_no_time_passes_for_a_look() -> None:
    with StepPort(PERIOD) as port, Client(port) as client:
        assert client.ask(0.0) == b""
        assert port.left == 0
        port.answer(SEEN, [])
        assert len(client.answer().detection) == 1


@pytest.mark.parametrize("step", [nan, -1.0, 1.5 * PERIOD, 1e9])
def test_an_impossible_step_is_told_and_lets_no_time_pass(step: float) -> None:
    with StepPort(PERIOD) as port, Client(port) as client:
        client.ask(step)
        assert port.left == 0
        port.answer(SEEN, [])
        (error,) = client.answer().robot_control_response.errors
        assert "a step is a multiple of 0.016667 s" in error.message


def test_nobody_places_anything() -> None:
    with StepPort(PERIOD) as port, Client(port) as client:
        client.ask(0.0, command=write_teleport([], None) or b"\x0a\x00")
        port.answer(SEEN, [])
        (error,) = client.answer().robot_control_response.errors
        assert error.message == "nobody places robots or ball in a match"


def test_who_sends_nonsense_or_leaves_is_told_of() -> None:
    with StepPort(PERIOD) as port, Client(port) as client:
        client.stream.send(b"\xff\xff")
        select.select([port], [], [], LIMIT)
        assert port.receive() is None
        assert port.problem == "its program sent what is no request for a step"
    with StepPort(PERIOD) as port, Client(port) as client:
        client.stream.close()
        select.select([port], [], [], LIMIT)
        assert port.receive() is None
        assert "closed the connection" in str(port.problem)
