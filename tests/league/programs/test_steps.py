"""A program in lock step: it is waited for, answered when its time has passed, and cannot do more."""

from __future__ import annotations

import select
import socket
from math import nan
from typing import Self

import pytest

from robobt.league.programs.steps import StepPort
from robobt.league.wire.messages import SimulationSyncRequest, SimulationSyncResponse
from robobt.league.wire.simulation import write_control, write_teleport
from robobt.league.wire.stream import MessageStream
from robobt.league.wire.vision import BallDetection, CameraFrame
from robobt.world.command import RobotCommand
from tests.waiting import LIMIT

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
