"""Where a program plays in lock step: the match waits for it, and it for the match."""

from __future__ import annotations

import socket
from collections.abc import Collection
from typing import Self

from robobt.league.wire.messages import RobotControlResponse, SimulationSyncRequest, SimulationSyncResponse
from robobt.league.wire.packets import PacketCounts, decode
from robobt.league.wire.sockets import LOOPBACK_ADDRESS
from robobt.league.wire.steps import NO_STEP
from robobt.league.wire.stream import MessageStream, StreamError
from robobt.league.wire.vision import CameraFrame, write_frame

_MOST_STEPS_AT_ONCE = 600
"""Most control periods that a program may let pass at once."""


class StepPort:
    """A TCP port at which one program asks for time to pass, by ``SimulationSyncRequest``. A context manager.

    Args:
        period: control period of the match [s].

    Attributes:
        port: its number.
        counts: what happened to the requests.
        left: control periods that may pass until the program wants to be answered; 0 while it is waited for.
        problem: why its connection ended; None while it holds.

    Raises:
        OSError: there is no free port.
    """

    def __init__(self, period: float) -> None:
        self._listening = socket.create_server((LOOPBACK_ADDRESS, 0))
        self.port: int = self._listening.getsockname()[1]
        self.counts = PacketCounts()
        self.left = 0
        self.problem: str | None = None
        self._period = period
        self._stream: MessageStream | None = None
        self._asked = False
        self._commanded: Collection[int] = ()
        self._errors: list[tuple[str, str]] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self._stream is not None:
            self._stream.close()
        self._listening.close()

    def fileno(self) -> int:
        """Return the socket to wait for, for ``select``."""
        return (self._stream or self._listening).fileno()

    def receive(self) -> bytes | None:
        """Take in the next request, if it is there; return the robot control in it.

        Nothing is read before the last request has been answered.
        """
        if self._asked or self.problem is not None:
            return None
        try:
            if self._stream is None:
                self._listening.setblocking(False)
                try:
                    connection, _ = self._listening.accept()
                except BlockingIOError:
                    return None
                self._stream = MessageStream(connection, "its program")
            data = self._stream.receive(0.0)
        except StreamError as error:
            self.problem = str(error)
            return None
        if data is None:
            return None
        request = decode(SimulationSyncRequest, data, self.counts)
        if request is None:
            self.problem = "its program sent what is no request for a step"
            return None
        self._asked, self._errors = True, []
        steps = request.sim_step / self._period
        # NaN compares as false.
        if not 0.0 <= steps <= _MOST_STEPS_AT_ONCE or abs(steps - round(steps)) > 1e-3:
            most = f"at most {_MOST_STEPS_AT_ONCE * self._period:g} s"
            self._errors.append((NO_STEP, f"a step is a multiple of {self._period:.6f} s, {most}"))
            steps = 0.0
        self.left = round(steps)
        self._commanded = [robot.id for robot in request.robot_control.robot_commands]
        if request.HasField("simulator_command"):
            self._errors.append(("REFUSED", "nobody places robots or ball in a match"))
        return request.robot_control.SerializeToString() if request.HasField("robot_control") else b""

    def passed(self) -> None:
        """Take note that a control period has passed."""
        self.left = max(0, self.left - 1)

    def answer(self, seen: CameraFrame, contacts: Collection[int]) -> None:
        """Answer a request whose time has passed.

        Args:
            seen: by the camera, now.
            contacts: numbers of the program's robots that have the ball.
        """
        if not self._asked or self.left or self._stream is None:
            return
        self._asked = False
        response = SimulationSyncResponse(detection=[write_frame(seen)])
        said = RobotControlResponse()
        for number in self._commanded:
            said.feedback.add(id=number, dribbler_ball_contact=number in contacts)
        for code, problem in self._errors:
            said.errors.add(code=code, message=problem)
        if self._commanded or self._errors:
            response.robot_control_response.CopyFrom(said)
        try:
            self._stream.send(response.SerializeToString())
        except StreamError as error:
            self.problem = str(error)
