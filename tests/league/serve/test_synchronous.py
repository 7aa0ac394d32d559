"""A field is served in lock step: nothing moves until its clients ask, and they see what then is."""

from __future__ import annotations

import random
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from itertools import islice
from math import nan

import pytest

from robobt.league.serve.served_field import ServedField
from robobt.league.serve.server import SimServer
from robobt.league.serve.synchronous import StepServer
from robobt.league.wire.commands import BallTeleport
from robobt.league.wire.messages import (
    RobotControl,
    SimulationSyncRequest,
    SimulationSyncResponse,
    SimulatorCommand,
)
from robobt.league.wire.simulation import write_control, write_teleport
from robobt.league.wire.stream import MessageStream, StreamError
from robobt.world.command import RobotCommand
from robobt.world.field import DIVISION_B
from robobt.world.game import Team
from robobt.world.protocol import Placement
from robobt.world.state import RobotId
from tests.league.mutations import mutations
from tests.league.served import free_endpoints
from tests.waiting import LIMIT

ME, HER = RobotId(Team.BLUE, 0), RobotId(Team.YELLOW, 5)
PERIOD = 1 / 60


class Client:
    def __init__(self, port: int) -> None:
        self.stream = MessageStream(socket.create_connection(("127.0.0.1", port)), "the server")

    def ask(
        self, step: float = PERIOD, control: bytes | None = None, command: bytes | None = None
    ) -> SimulationSyncResponse:
        self.send(step, control, command)
        return self.answer()

    def send(self, step: float, control: bytes | None = None, command: bytes | None = None) -> None:
        request = SimulationSyncRequest(sim_step=step)
        if control is not None:
            request.robot_control.MergeFromString(control)
        if command is not None:
            request.simulator_command.MergeFromString(command)
        self.stream.send(request.SerializeToString())

    def answer(self, wait: float = 10.0) -> SimulationSyncResponse:
        data = self.stream.receive(wait)
        assert data is not None, "no answer"
        return SimulationSyncResponse.FromString(data)


@pytest.fixture
def connect() -> Iterator[Callable[[str], Client]]:
    placement = Placement({ME: (0.0, 0.0, 0.0), HER: (2.0, 1.0, 0.0)}, (1.0, 0.0, 0.0, 0.0))
    ended = threading.Event()
    with ExitStack() as stack:
        server = stack.enter_context(SimServer(ServedField(DIVISION_B, placement), free_endpoints()))
        stepped = stack.enter_context(
            StepServer(server, ports=dict.fromkeys(("control", "blue", "yellow"), 0))
        )
        thread = threading.Thread(target=lambda: stepped.run(stop=ended.is_set))
        thread.start()
        stack.callback(thread.join)
        stack.callback(ended.set)

        def connected(name: str) -> Client:
            client = Client(stepped.ports[name])
            stack.callback(client.stream.close)
            return client

        yield connected


Connect = Callable[[str], Client]


def errors(response: SimulationSyncResponse) -> list[str]:
    return [error.code for error in response.robot_control_response.errors]


def test_time_passes_only_by_the_steps_that_are_asked_for(connect: Connect) -> None:
    client = connect("control")
    times = [client.ask(step).detection[0].t_capture for step in (PERIOD, PERIOD, 0.5, 0.0)]
    assert times == pytest.approx([PERIOD, 2 * PERIOD, 2 * PERIOD + 0.5, 2 * PERIOD + 0.5], abs=1e-6)


def test_a_team_commands_its_robots_and_sees_where_they_have_got(connect: Connect) -> None:
    client = connect("blue")
    drive = write_control({0: RobotCommand(vx=1.0)})
    for _ in range(30):
        response = client.ask(PERIOD, drive)
    (robot,) = response.detection[0].robots_blue
    assert robot.x > 200.0
    (feedback,) = response.robot_control_response.feedback
    assert (feedback.id, feedback.dribbler_ball_contact) == (0, False)


def test_the_ball_is_teleported_before_the_step(connect: Connect) -> None:
    response = connect("control").ask(PERIOD, command=write_teleport([], BallTeleport(-1.0, 2.0, 0.0, 0.0)))
    (ball,) = response.detection[0].balls
    assert (ball.x, ball.y) == pytest.approx((-1000.0, 2000.0), abs=1.0)


def test_of_several_clients_nobody_is_answered_before_all_have_asked(connect: Connect) -> None:
    blue, yellow = connect("blue"), connect("yellow")
    # Both are known once they have been answered; who asks before the other is known is answered alone.
    yellow.send(0.0)
    blue.ask(0.0)
    if yellow.stream.receive(0.5) is None:
        blue.ask(0.0)
        yellow.answer()
    blue.send(PERIOD, write_control({0: RobotCommand(vx=1.0)}))
    assert blue.stream.receive(0.2) is None
    yellow.send(PERIOD, write_control({5: RobotCommand(vx=1.0)}))
    first, second = blue.answer(), yellow.answer()
    assert first.detection == second.detection
    assert [it.id for it in first.robot_control_response.feedback] == [0]
    assert [it.id for it in second.robot_control_response.feedback] == [5]
    # Who leaves is not waited for.
    yellow.stream.close()
    assert blue.ask(PERIOD).detection[0].t_capture > first.detection[0].t_capture


def test_the_same_requests_give_the_same_answers(connect: Connect) -> None:
    client = connect("blue")
    back = write_teleport([], BallTeleport(1.0, 0.0, 0.0, 0.0))
    client.ask(0.0)
    seen = [client.ask(PERIOD, write_control({0: RobotCommand(vx=0.5)}), back) for _ in range(3)]
    assert len({response.detection[0].balls[0].x for response in seen}) == 1


@pytest.mark.parametrize("step", [0.01, -PERIOD, 11.0, nan])
def test_a_step_that_cannot_be_made_is_told(connect: Connect, step: float) -> None:
    client = connect("blue")
    assert errors(client.ask(step)) == ["SIM_STEP"]
    assert client.ask(0.0).detection[0].t_capture == 0.0


def test_what_cannot_be_done_is_told(connect: Connect) -> None:
    assert errors(connect("control").ask(0.0, write_control({0: RobotCommand()}))) == ["NO_TEAM"]


def test_a_robot_that_is_not_there_is_told(connect: Connect) -> None:
    assert errors(connect("blue").ask(0.0, write_control({9: RobotCommand()}))) == ["NO_ROBOT"]


@pytest.mark.integration
def test_mutated_requests_cost_at_most_their_connection(connect: Connect) -> None:
    drive = RobotControl.FromString(write_control({0: RobotCommand(vx=1.0, kick_speed=2.0)}))
    put = SimulatorCommand.FromString(write_teleport([], BallTeleport(-1.0, 2.0, 0.0, 0.0)))
    seeds = [SimulationSyncRequest(sim_step=PERIOD, robot_control=drive, simulator_command=put)]
    rng, client, lost = random.Random(0), None, 0
    for data in islice(mutations(seeds, 0), 2000):
        client = client or connect(rng.choice(["control", "blue", "yellow"]))
        try:
            client.stream.send(data)
            assert client.stream.receive(LIMIT) is not None
        except StreamError:
            client.stream.close()
            client, lost = None, lost + 1
    assert 0 < lost < 2000
    if client is not None:
        client.stream.close()
    assert connect("control").ask(PERIOD).detection
