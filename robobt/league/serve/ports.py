"""The ports at which clients command a served field: grSim's packets and the simulation protocol."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable
from functools import partial
from math import isfinite

from robobt.league.serve.cameras import Cameras
from robobt.league.serve.served_field import ServedField
from robobt.league.wire.commands import Request, optional
from robobt.league.wire.endpoints import Endpoints
from robobt.league.wire.grsim import read_grsim
from robobt.league.wire.messages import (
    DecodeError,
    RealismConfigErForce,
    RobotControlResponse,
    Robots_Status,
    RobotSpecs,
    SimulatorCommand,
    SimulatorResponse,
)
from robobt.league.wire.packets import read
from robobt.league.wire.simulation import TEAMS, read_control, read_teleports
from robobt.league.wire.sockets import LOOPBACK_ADDRESS, Packet, Receiver
from robobt.sim.realism import RealismSettings
from robobt.world.game import Team
from robobt.world.limits import RobotLimits
from robobt.world.state import RobotId

_PORT_READING_TIME = 0.002
"""How long one port is read at a time, so that no flood delays the other ports or the field [s]."""

_SPEED_FACTORS = (0.05, 20.0)
"""Slowest and fastest simulation, as simulated time over real time."""

_REALISM = {
    "stddev_ball_p": "ball_noise",
    "stddev_robot_p": "robot_noise",
    "stddev_robot_phi": "heading_noise",
    "camera_position_error": "camera_error",
    "camera_overlap": "camera_overlap",
    "dribbler_ball_detections": "false_balls",
    "missing_ball_detections": "missing_ball",
    "robot_command_loss": "command_loss",
    "robot_response_loss": "response_loss",
}
"""Settings of realism by ER-Force's names."""


class ClientPorts:
    """Receives the clients' requests, applies them to a field and answers.

    Attributes:
        speed: simulated time over real time, as the last client has set it.
        endpoints: with the ports that were picked for 0.
        receivers: of the ports, for ``select``.
        counts: what happened to the packets, by port.
    """

    def __init__(
        self, field: ServedField, cameras: Cameras, endpoints: Endpoints, interface: str, speed: float
    ) -> None:
        if not _SPEED_FACTORS[0] <= speed <= _SPEED_FACTORS[1]:
            raise ValueError(f"the speed must be {_SPEED_FACTORS[0]} to {_SPEED_FACTORS[1]}, not {speed}")
        self.speed = speed
        self._field, self._cameras = field, cameras
        self._handlers: dict[str, Callable[[Receiver, Packet], None]] = {
            "grsim": self._on_grsim,
            "blue": partial(self._on_control, Team.BLUE),
            "yellow": partial(self._on_control, Team.YELLOW),
            "control": self._on_simulator_command,
        }
        self._ports: dict[str, Receiver] = {}
        try:
            for name in self._handlers:
                port: int = getattr(endpoints, name)
                self._ports[name] = Receiver(
                    interface, port, interface if interface != LOOPBACK_ADDRESS else None
                )
        except (OSError, ValueError):
            self.close()
            raise
        self.endpoints = endpoints.model_copy(update={name: port.port for name, port in self._ports.items()})
        self.receivers = list(self._ports.values())
        self.counts = {name: port.counts for name, port in self._ports.items()}
        self._status_to: dict[Team, str] = {}
        self._status: dict[RobotId, tuple[bool, bool]] = {}

    def receive(self) -> None:
        """Process the waiting packets; a flood of them not all at once."""
        for name, handler in self._handlers.items():
            receiver = self._ports[name]
            end = time.monotonic() + _PORT_READING_TIME
            for packet in receiver.receive():
                handler(receiver, packet)
                if time.monotonic() > end:
                    break

    def close(self) -> None:
        """Release the ports."""
        for receiver in self._ports.values():
            receiver.close()

    def set_realism(self, realism: RealismSettings) -> None:
        """Replace what the vision does, and the loss of commands and responses."""
        self._cameras.realism = realism
        self._field.command_loss = realism.command_loss

    def report_status(self) -> None:
        """Send grSim's status of robots whose break beam or kicker has changed to their commander."""
        kicked = set(self._field.kicked)
        ports = {Team.BLUE: self.endpoints.blue_status, Team.YELLOW: self.endpoints.yellow_status}
        changed: dict[Team, Robots_Status] = {}
        for robot, state in self._field.truth().robots().items():
            now = (state.ball_contact, robot in kicked)
            if robot.team in self._status_to and self._status.get(robot) != now and self._responds():
                self._status[robot] = now
                changed.setdefault(robot.team, Robots_Status()).robots_status.add(
                    robot_id=robot.number,
                    infrared=now[0],
                    flat_kick=now[1] and robot not in self._field.chipped,
                    chip_kick=robot in self._field.chipped,
                )
        for team, status in changed.items():
            self._ports["grsim"].answer(status.SerializeToString(), (self._status_to[team], ports[team]))

    def _on_grsim(self, receiver: Receiver, packet: Packet) -> None:
        request = read_grsim(packet.data, receiver.counts)
        if request is None:
            return
        for robot, command in request.commands.items():
            self._status_to[robot.team] = packet.sender[0]
            self._field.command(robot, command)
        self._teleport(request)

    def control(self, team: Team, data: bytes) -> RobotControlResponse | None:
        """Command a team's robots by a ``RobotControl``; None, counted, when it makes no sense."""
        robots = self._field.truth().robots()
        headings = {robot.number: state.heading for robot, state in robots.items() if robot.team is team}
        request = read_control(data, team, headings, self.counts[team.value])
        if request is None:
            return None
        response = RobotControlResponse()
        for robot, command in request.commands.items():
            if self._field.command(robot, command):
                if self._responds():
                    response.feedback.add(id=robot.number, dribbler_ball_contact=robots[robot].ball_contact)
            else:
                request.errors.append(("NO_ROBOT", f"there is no robot {robot} on the field"))
        _add(response, request.errors)
        return response

    def simulator_command(self, data: bytes) -> SimulatorResponse | None:
        """Teleport and configure by a ``SimulatorCommand``; None, counted, when it makes no sense."""

        def convert(message: SimulatorCommand) -> tuple[SimulatorCommand, Request] | None:
            request = read_teleports(message)
            if request is None or not isfinite(message.control.simulation_speed):
                return None
            return message, request

        found = read(SimulatorCommand, data, self.counts["control"], convert)
        if found is None:
            return None
        message, request = found
        errors = [("CANNOT_TELEPORT", problem) for problem in self._teleport(request)]
        if message.control.HasField("simulation_speed"):
            speed = message.control.simulation_speed
            if _SPEED_FACTORS[0] <= speed <= _SPEED_FACTORS[1]:
                self.speed = speed
            else:
                errors.append(("SPEED", f"the speed must be {_SPEED_FACTORS[0]} to {_SPEED_FACTORS[1]}"))
        errors += self._configure(message)
        response = SimulatorResponse()
        _add(response, errors)
        return response

    def _responds(self) -> bool:
        """Return whether a robot's response gets through."""
        loss = self._cameras.realism.response_loss
        return not (loss > 0.0 and self._field.draw() < loss)

    def _on_control(self, team: Team, receiver: Receiver, packet: Packet) -> None:
        _answer(receiver, packet, self.control(team, packet.data))

    def _on_simulator_command(self, receiver: Receiver, packet: Packet) -> None:
        _answer(receiver, packet, self.simulator_command(packet.data))

    def _teleport(self, request: Request) -> list[str]:
        """Teleport robots and ball; return the reasons of what cannot be done."""
        problems = [self._field.teleport(robot) for robot in request.teleports]
        if request.ball is not None:
            problems.append(self._field.teleport_ball(request.ball))
        return [problem for problem in problems if problem is not None]

    def _configure(self, message: SimulatorCommand) -> list[tuple[str, str]]:
        """Apply a configuration; return code and message of what cannot be applied."""
        config, errors = message.config, []
        if config.HasField("geometry") or config.HasField("vision_port"):
            errors.append(("FIXED", "field and ports are fixed: restart the server to change them"))
        for spec in config.robot_specs:
            team = TEAMS.get(int(spec.id.team))
            if team is None or not spec.HasField("limits"):
                continue
            robot = RobotId(team, spec.id.id)
            limits = _limits(spec, self._field.settings.limits)
            if limits is None or not self._field.limit(robot, limits):
                errors.append(("ROBOT_SPECS", f"limits of {robot} must be positive, its number below 16"))
        for custom in config.realism_config.custom:
            if custom.type_url.rpartition("/")[2].rpartition(".")[2] != "RealismConfigErForce":
                continue
            realism = RealismConfigErForce()
            try:
                realism.MergeFromString(custom.value)
                self.set_realism(_realism(realism, self._cameras.realism))
            except (DecodeError, ValueError):
                errors.append(("REALISM", "a value of the realism is out of range"))
        return errors


def _add(response: RobotControlResponse | SimulatorResponse, errors: Iterable[tuple[str, str]]) -> None:
    for code, problem in errors:
        response.errors.add(code=code, message=problem)


def _answer(
    receiver: Receiver, packet: Packet, response: RobotControlResponse | SimulatorResponse | None
) -> None:
    if response is not None:
        receiver.answer(response.SerializeToString(), packet.sender)


def _limits(spec: RobotSpecs, base: RobotLimits) -> RobotLimits | None:
    """Return the limits lowered to what a client specifies; None when that is not positive."""
    changes = {}
    for theirs, ours in (("vel_absolute_max", "max_speed"), ("vel_angular_max", "max_turn")):
        value = optional(spec.limits, theirs)
        if value is None:
            continue
        if not value > 0.0:
            return None
        changes[ours] = min(value, getattr(base, ours))
    return base.model_copy(update=changes)


def _realism(message: RealismConfigErForce, base: RealismSettings) -> RealismSettings:
    """Return the level with what the message sets replaced."""
    set_fields = [(theirs, ours) for theirs, ours in _REALISM.items() if message.HasField(theirs)]
    changes = {ours: getattr(message, theirs) for theirs, ours in set_fields}
    for theirs, ours in (("vision_delay", "vision_delay"), ("vision_processing_time", "processing_time")):
        if message.HasField(theirs):
            changes[ours] = getattr(message, theirs) / 1e9
    if message.HasField("ball_visibility_threshold"):
        changes["hidden_below"] = message.ball_visibility_threshold
    if message.HasField("enable_invisible_ball") and not message.enable_invisible_ball:
        changes["hidden_below"] = 0.0
    return RealismSettings.model_validate({**base.model_dump(), **changes})
