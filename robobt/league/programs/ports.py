"""The ports of one match: what its programs see, and where they command their robots."""

from __future__ import annotations

import socket
from collections.abc import Collection, Mapping
from contextlib import ExitStack
from typing import Self

from robobt.config.closing import Closing
from robobt.league.programs.program import STREAMS
from robobt.league.wire.endpoints import REFEREE_GROUP, VISION_GROUP
from robobt.league.wire.grsim import read_grsim
from robobt.league.wire.messages import RobotControlResponse, SimulationSyncRequest, SimulationSyncResponse
from robobt.league.wire.packets import PacketCounts, decode
from robobt.league.wire.simulation import read_control
from robobt.league.wire.sockets import LOOPBACK_ADDRESS, Packet, Receiver, Sender
from robobt.league.wire.steps import NO_STEP
from robobt.league.wire.stream import MessageStream, StreamError
from robobt.league.wire.vision import CameraFrame, write_frame
from robobt.world.command import RobotCommand
from robobt.world.game import Team
from robobt.world.state import Frame, RobotId

_LEAGUE = {"vision": VISION_GROUP, "tracker": VISION_GROUP, "referee": REFEREE_GROUP}

MOST_PACKETS = 50
"""Packets of a team in a control period: each of eleven robots may be commanded four times."""

_TOLERATED = 60 * MOST_PACKETS
"""Packets beyond these that are tolerated, as when many come at once; they are forgotten as slowly."""


class MatchPorts(Closing):
    """Ports that no other match on this machine has. A context manager.

    What is sent goes over the loopback to multicast groups that are this match's alone as well. Every team
    has ports of its own for grSim's packets and the simulation protocol, at which only its own robots can
    be commanded.

    Args:
        teams: whose programs command robots.
        league_groups: what of vision, tracker and referee is sent to the league's group instead.

    Attributes:
        senders: of vision, tracker and referee, by these names.
        flooded: the team that has sent far too many packets, or None.

    Raises:
        OSError: there is no free port.
    """

    def __init__(self, teams: Collection[Team], league_groups: Collection[str] = ()) -> None:
        self.senders: dict[str, Sender] = {}
        self._places: dict[str, str] = {}
        self._receivers: dict[tuple[Team, str], Receiver] = {}
        self._beyond = dict.fromkeys(teams, 0)
        self.flooded: Team | None = None
        with ExitStack() as opened:
            for name in STREAMS:
                port: int = opened.enter_context(_reserved()).getsockname()[1]
                group = _LEAGUE[name] if name in league_groups else _own_group(port)
                self.senders[name] = opened.enter_context(Sender(group, port))
                self._places |= {f"{name}_group": group, f"{name}_port": str(port), name: f"{group}:{port}"}
            for team in teams:
                for kind in ("grsim", "protocol", "control"):
                    self._receivers[team, kind] = opened.enter_context(Receiver(LOOPBACK_ADDRESS, 0))
            self._opened = opened.pop_all()

    def close(self) -> None:
        """Release all ports."""
        self._opened.close()

    def addresses(self, team: Team) -> dict[str, str]:
        """Return the addresses and port numbers for a team's program, by name."""
        own = {kind: str(port.port) for (whose, kind), port in self._receivers.items() if whose is team}
        return {"team": team.value, "host": LOOPBACK_ADDRESS, **self._places, **own}

    def sockets(self) -> list[Receiver]:
        """Return the sockets at which commands arrive, for ``select``."""
        return list(self._receivers.values())

    def period_over(self) -> None:
        """Take note that a control period is over."""
        for team, beyond in self._beyond.items():
            if beyond > _TOLERATED:
                self.flooded = self.flooded or team
            self._beyond[team] = max(0, beyond - MOST_PACKETS)

    def commands(self, truth: Frame) -> dict[Team, dict[RobotId, RobotCommand]]:
        """Return the commands that have come, for teams of which any has.

        Args:
            truth: what is on the field; its headings turn commands in field coordinates.
        """
        found: dict[Team, dict[RobotId, RobotCommand]] = {}
        robots = truth.robots()
        for (team, kind), port in self._receivers.items():
            headings = {robot.number: state.heading for robot, state in robots.items() if robot.team is team}
            for number, packet in enumerate(port.receive()):
                self._beyond[team] += 1
                if number >= MOST_PACKETS:
                    # Who floods its own port must not delay the match.
                    continue
                if kind == "grsim":
                    request = read_grsim(packet.data, port.counts)
                elif kind == "protocol":
                    request = read_control(packet.data, team, headings, port.counts)
                else:
                    # Teams do not put robots where they like.
                    request = None
                commands = {} if request is None else request.commands
                own = {robot: one for robot, one in commands.items() if robot.team is team}
                if own:
                    found.setdefault(team, {}).update(own)
                if kind == "protocol":
                    _answer(port, packet, own, truth)
        return found


def _answer(port: Receiver, packet: Packet, commanded: Mapping[RobotId, object], truth: Frame) -> None:
    """Tell which of the commanded robots have the ball, as the simulation protocol does."""
    robots, response = truth.robots(), RobotControlResponse()
    for robot in commanded:
        if robot in robots:
            response.feedback.add(id=robot.number, dribbler_ball_contact=robots[robot].ball_contact)
    port.answer(response.SerializeToString(), packet.sender)


def _own_group(port: int) -> str:
    """Return the group of a port that only one match on this machine has, in the local scope (RFC 2365)."""
    return f"239.255.{port >> 8}.{port & 255}"


def _reserved() -> socket.socket:
    """Return a socket that reserves a free port of the loopback against other requests for one.

    The port's number is for a multicast group, which receivers may share.
    """
    holder = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        holder.bind((LOOPBACK_ADDRESS, 0))
        # Set only now, so that it does not share another match's port; a program bound to all addresses still
        # may.
        holder.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    except OSError:
        holder.close()
        raise
    return holder


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
