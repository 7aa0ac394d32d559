"""A link that commands robots in lock step: time on the field passes when it asks for it."""

from __future__ import annotations

import socket
from collections.abc import Collection, Iterable, Iterator, Mapping

from robobt.league.wire.commands import BallTeleport, Teleport
from robobt.league.wire.endpoints import Endpoints
from robobt.league.wire.links import Link, by_team
from robobt.league.wire.messages import SimulationSyncRequest, SimulationSyncResponse
from robobt.league.wire.packets import PacketCounts, decode
from robobt.league.wire.simulation import read_feedback, write_control, write_teleport
from robobt.league.wire.stream import MessageStream, StreamError
from robobt.league.wire.vision import CameraFrame, read_frame
from robobt.world.command import RobotCommand
from robobt.world.game import Team
from robobt.world.state import RobotId

NO_STEP = "SIM_STEP"
"""Code of the error that is the answer to a step that cannot be made."""

_ANSWER_TIMEOUT = 60.0
"""How long an answer is waited for: the other side may have to wait for the other team [s]."""


class StepLink(Link):
    """Asks for steps by ``SimulationSyncRequest`` at the control port of each team (TCP).

    Args:
        host: of the simulator.
        endpoints: where the teams' ports are.
        teams: whose robots are commanded.

    Attributes:
        time: the clock, which the user of this link advances [s].
        stepped: how far the field has come since the link was made, never beyond ``time`` [s].

    Raises:
        StreamError: nobody listens there.
    """

    active = True

    def __init__(self, host: str, endpoints: Endpoints, teams: Collection[Team]) -> None:
        super().__init__()
        self.time = self.stepped = 0.0
        self.clock = lambda: self.time
        self._streams: dict[Team, MessageStream] = {}
        self._commands: dict[Team, dict[int, RobotCommand]] = {}
        self._placed: bytes | None = None
        self._contacts: list[tuple[RobotId, bool]] = []
        self.counts = {f"{team.value}_steps": PacketCounts() for team in teams}
        for team in teams:
            port = endpoints.blue if team is Team.BLUE else endpoints.yellow
            where = f"the simulator at {host}:{port}"
            try:
                self._streams[team] = MessageStream(
                    socket.create_connection((host, port), _ANSWER_TIMEOUT), where
                )
            except OSError as error:
                self.close()
                raise StreamError(f"{where} cannot be reached: {error.strerror or error}") from error

    def close(self) -> None:
        """Close the connections."""
        for stream in self._streams.values():
            stream.close()

    def send(self, commands: Mapping[RobotId, RobotCommand], time: float) -> None:  # noqa: ARG002
        """Send the robots their commands with the next step."""
        self._commands = by_team(commands)

    def place(self, robots: Iterable[Teleport], ball: BallTeleport | None) -> None:
        """Teleport robots and ball with the next step."""
        self._placed = write_teleport(robots, ball)

    def feedback(self) -> Iterator[tuple[RobotId, bool]]:
        """Yield what the robots' break-beam sensors have reported since the last call."""
        yield from self._contacts
        self._contacts = []

    def step(self, seconds: float) -> list[CameraFrame]:
        """Advance the field's time, and return the cameras' frames then.

        Raises:
            StreamError: the simulator has gone, does not answer, or cannot make steps of this length.
        """
        for team, stream in self._streams.items():
            request = SimulationSyncRequest(sim_step=seconds)
            if team in self._commands:
                request.robot_control.MergeFromString(write_control(self._commands[team]))
            if self._placed is not None:
                request.simulator_command.MergeFromString(self._placed)
                self._placed = None
            stream.send(request.SerializeToString())
        self._commands = {}
        frames: list[CameraFrame] = []
        for team, stream in self._streams.items():
            data, counts = stream.receive(_ANSWER_TIMEOUT), self.counts[f"{team.value}_steps"]
            answer = None if data is None else decode(SimulationSyncResponse, data, counts)
            if answer is None:
                raise StreamError(f"the simulator does not answer a step of {team.value}'s")
            for error in answer.robot_control_response.errors:
                if error.code == NO_STEP:
                    raise StreamError(f"the simulator makes no step of {seconds:g} s: {error.message}")
            # Every team sees the same.
            frames = [frame for frame in map(read_frame, answer.detection) if frame is not None]
            heard = read_feedback(answer.robot_control_response.SerializeToString(), counts)
            self._contacts += [(RobotId(team, number), contact) for number, contact in heard.items()]
        self.stepped += seconds
        return frames
