"""A served field in lock step: time passes when its clients ask for it, and they wait for the answer.

Messages: ssl-simulation-protocol's draft of a synchronous interface. It leaves the connection open and
names one like the game controller's first, which this is: TCP, each message after its length.
"""

from __future__ import annotations

import logging
import selectors
import socket
import time
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from dataclasses import dataclass

from robobt.config.closing import Closing
from robobt.league.serve.server import SimServer
from robobt.league.wire.messages import RobotControlResponse, SimulationSyncRequest, SimulationSyncResponse
from robobt.league.wire.packets import decode
from robobt.league.wire.sockets import LOOPBACK_ADDRESS
from robobt.league.wire.steps import NO_STEP
from robobt.league.wire.stream import MessageStream, StreamError
from robobt.league.wire.vision import CameraFrame, write_frame
from robobt.signals import check
from robobt.world.game import Team

_log = logging.getLogger(__name__)

_LONGEST_CLIENT_STEP = 10.0
"""Longest step that a client may ask for [s]."""

_STOP_POLL = 0.05
"""Longest wait before looking whether to stop [s]."""

_TEAM_PORTS = {"control": None, "blue": Team.BLUE, "yellow": Team.YELLOW}
"""The ports, and whose robots are commanded there."""


@dataclass(slots=True)
class _Client:
    """A connection to the port ``name``, and what it asks for now."""

    stream: MessageStream
    name: str
    request: SimulationSyncRequest | None = None


class StepServer(Closing):
    """Steps a server's field by ``SimulationSyncRequest``; a context manager that releases its ports.

    Clients connect by TCP to ports for teleports and for the control of blue and yellow robots. Once every
    connected client has sent its request all are carried out, in the order of the ports: simulator
    commands, robot commands, and the longest step asked for; then all are answered by what the cameras see
    and, at the teams' ports, by the robots' feedback. A step is a multiple of the field's period; the
    cameras' delay does not hold. What is published and logged is the same as in real time.

    Args:
        server: what is served.
        interface: own address to listen on.
        ports: numbers of the ports ``control``, ``blue`` and ``yellow``, 0 for any that is free; by default
            those of the server's UDP ports.

    Attributes:
        ports: as above, with those that were picked for 0.

    Raises:
        OSError: a port is taken.
    """

    def __init__(
        self, server: SimServer, interface: str = LOOPBACK_ADDRESS, ports: Mapping[str, int] | None = None
    ) -> None:
        self._server = server
        self._clients: list[_Client] = []
        wanted = ports or {name: getattr(server.endpoints, name) for name in _TEAM_PORTS}
        with ExitStack() as opened:
            self._listening = {
                name: opened.enter_context(socket.create_server((interface, wanted[name])))
                for name in _TEAM_PORTS
            }
            self._opened = opened.pop_all()
        self.ports: dict[str, int] = {name: sock.getsockname()[1] for name, sock in self._listening.items()}

    def close(self) -> None:
        """Close all connections and release the ports."""
        for client in self._clients:
            client.stream.close()
        self._clients.clear()
        self._opened.close()

    def run(self, seconds: float | None = None, stop: Callable[[], bool] | None = None) -> None:
        """Serve for ``seconds`` of this machine's clock [s], until ``stop`` says so, or until interrupted."""
        began = time.monotonic()
        while seconds is None or time.monotonic() - began < seconds:
            check()
            if stop is not None and stop():
                return
            self._listen()
            if self._clients and all(client.request is not None for client in self._clients):
                self._carry_out()

    def _listen(self) -> None:
        """Take in new clients and their requests."""
        silent = [client for client in self._clients if client.request is None]
        for client in silent:
            # It may have come together with the one before.
            self._receive(client)
        if self._clients and all(client.request is not None for client in self._clients):
            return
        with selectors.DefaultSelector() as selector:
            for client in self._clients:
                if client.request is None:
                    selector.register(client.stream, selectors.EVENT_READ)
            for listening in self._listening.values():
                selector.register(listening, selectors.EVENT_READ)
            ready = [key.fileobj for key, _ in selector.select(_STOP_POLL)]
        for name, listening in self._listening.items():
            if listening in ready:
                connection, _ = listening.accept()
                self._clients.append(_Client(MessageStream(connection, f"a client at {name}"), name))
                self._clients.sort(key=lambda client: list(_TEAM_PORTS).index(client.name))

    def _receive(self, client: _Client) -> None:
        try:
            data = client.stream.receive(0.0)
        except StreamError as error:
            self._drop(client, str(error))
            return
        if data is None:
            return
        client.request = decode(SimulationSyncRequest, data, self._server.counts[client.name])
        if client.request is None:
            self._drop(client, f"a client at {client.name} sends what is no request")

    def _drop(self, client: _Client, reason: str) -> None:
        _log.info("%s", reason)
        client.stream.close()
        self._clients.remove(client)

    def _carry_out(self) -> None:
        """Do what all clients ask for, and answer them."""
        server, period = self._server, self._server.field.period
        answers = [self._command(client) for client in self._clients]
        steps = 0
        for client, answer in zip(self._clients, answers, strict=True):
            asked = 0.0 if client.request is None else client.request.sim_step
            # NaN compares as false.
            if not 0.0 <= asked <= _LONGEST_CLIENT_STEP or abs(asked / period - round(asked / period)) > 1e-3:
                answer.errors.add(
                    code=NO_STEP,
                    message=f"a step is a multiple of {period:.6f} s, at most {_LONGEST_CLIENT_STEP:g} s",
                )
            else:
                steps = max(steps, round(asked / period))
        frames = server.look() if steps == 0 else []
        for _ in range(steps):
            frames = server.step()
            server.send_due(server.field.time)
        for client, answer in list(zip(self._clients, answers, strict=True)):
            client.request = None
            self._answer(client, answer, frames)

    def _command(self, client: _Client) -> RobotControlResponse:
        request, ports = client.request, self._server.ports
        answer = RobotControlResponse()
        if request is None:
            return answer
        if request.HasField("simulator_command"):
            done = ports.simulator_command(request.simulator_command.SerializeToString())
            if done is None:
                answer.errors.add(
                    code="IMPLAUSIBLE", message="a value of the simulator command is impossible"
                )
            else:
                answer.errors.MergeFrom(done.errors)
        team = _TEAM_PORTS[client.name]
        if not request.HasField("robot_control"):
            return answer
        if team is None:
            answer.errors.add(code="NO_TEAM", message="robots are commanded at the ports of their teams")
            return answer
        commanded = ports.control(team, request.robot_control.SerializeToString())
        if commanded is None:
            answer.errors.add(code="IMPLAUSIBLE", message="a value of the robot control is impossible")
        else:
            answer.MergeFrom(commanded)
        return answer

    def _answer(self, client: _Client, answer: RobotControlResponse, frames: list[CameraFrame]) -> None:
        team = _TEAM_PORTS[client.name]
        robots = {} if team is None else self._server.field.truth().robots()
        contacts = {robot.number: state.ball_contact for robot, state in robots.items() if robot.team is team}
        for feedback in answer.feedback:
            # As of the end of the step, as the detections are.
            feedback.dribbler_ball_contact = contacts.get(feedback.id, False)
        response = SimulationSyncResponse(detection=[write_frame(frame) for frame in frames])
        if answer.feedback or answer.errors:
            response.robot_control_response.CopyFrom(answer)
        try:
            client.stream.send(response.SerializeToString())
        except StreamError as error:
            self._drop(client, str(error))
