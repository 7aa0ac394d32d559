"""Our simulator as one of the league's: vision and tracker out, commands and teleports in."""

from __future__ import annotations

import heapq
import select
import time as clocks
from collections.abc import Callable, Mapping
from functools import partial
from itertools import count
from math import isfinite
from typing import Self
from uuid import UUID

import numpy as np

from robobt.league.log.files import LogKind, LogWriter
from robobt.league.serve.cameras import Cameras
from robobt.league.serve.served_field import ServedField
from robobt.league.wire.commands import read_control, read_grsim, read_teleports
from robobt.league.wire.endpoints import Endpoint, Endpoints
from robobt.league.wire.messages import (
    DecodeError,
    RealismConfigErForce,
    RobotControlResponse,
    Robots_Status,
    SimulatorCommand,
    SimulatorResponse,
)
from robobt.league.wire.sockets import LOOPBACK, Packet, PacketCounts, Receiver, Sender, decode
from robobt.league.wire.tracker import write_tracked
from robobt.league.wire.vision import write_field, write_vision
from robobt.sim.settings import RealismSettings
from robobt.world.game import Team
from robobt.world.limits import RobotLimits
from robobt.world.state import RobotId

_GEOMETRY_EVERY = 60
"""Frames from one geometry packet to the next."""

_BEHIND = 0.25
"""A server that is later than this skips what it missed instead of hurrying after it [s]."""

_MOST_READING = 0.002
"""For how long one port is read at a time, so that no flood keeps the others or the field waiting [s]."""

_SPEEDS = (0.05, 20.0)
"""Slowest and fastest simulation that may be asked for, in shares of real time."""

_TEAM_NUMBERS = {1: Team.YELLOW, 2: Team.BLUE}


class SimServer:
    """Serves a field over the league's protocols.

    Args:
        field: what is simulated.
        endpoints: where it sends, and listens.
        interface: own address of the interface it sends on and listens to: the
            loopback unless named.
        cameras: how many share the field.
        speed: simulated time in shares of real time.
        seed: of the cameras' noise.
        epoch: the captures' times count from here [s].
        log: where all that goes out is written down as well.

    Attributes:
        endpoints: as they came out, with the ports that were free.
        counts: what became of the packets, by port.
        speed: as above; a client may change it.
        frames: how many were sent.

    Raises:
        OSError: a port is taken, or there is no such interface.
        ValueError: an argument out of range.
    """

    def __init__(
        self,
        field: ServedField,
        endpoints: Endpoints | None = None,
        interface: str = LOOPBACK,
        cameras: int = 1,
        speed: float = 1.0,
        seed: int = 0,
        epoch: float = 0.0,
        log: LogWriter | None = None,
    ) -> None:
        if not _SPEEDS[0] <= speed <= _SPEEDS[1]:
            raise ValueError(f"the speed must be {_SPEEDS[0]} to {_SPEEDS[1]}, not {speed}")
        self.field = field
        self.speed = speed
        self.frames = 0
        self._epoch, self._log = epoch, log
        self._rng = np.random.default_rng(seed)
        self._camera_count = cameras
        self._set_realism(field.settings.realism)
        self._uuid = str(UUID(bytes=self._rng.bytes(16), version=4))
        self._open: list[Receiver | Sender] = []
        wanted = endpoints or Endpoints()
        try:
            self._vision = self._sender(wanted.vision, interface)
            self._tracker = self._sender(wanted.tracker, interface)
            self._grsim = self._receiver(wanted.grsim, interface)
            self._control = self._receiver(wanted.control, interface)
            self._teams = {
                Team.BLUE: self._receiver(wanted.blue, interface),
                Team.YELLOW: self._receiver(wanted.yellow, interface),
            }
        except (OSError, ValueError):
            self.close()
            raise
        self.endpoints = wanted.model_copy(
            update={
                "grsim": self._grsim.port,
                "control": self._control.port,
                "blue": self._teams[Team.BLUE].port,
                "yellow": self._teams[Team.YELLOW].port,
            }
        )
        self.counts: dict[str, PacketCounts] = {
            "grsim": self._grsim.counts,
            "control": self._control.counts,
            "blue": self._teams[Team.BLUE].counts,
            "yellow": self._teams[Team.YELLOW].counts,
        }
        self._readers: list[tuple[Receiver, Callable[[Packet], None]]] = [
            (self._grsim, self._obey_grsim),
            *(
                (receiver, partial(self._obey_control, team, receiver))
                for team, receiver in self._teams.items()
            ),
            (self._control, self._obey_simulator),
        ]
        self._status_to: dict[Team, str] = {}
        self._status: dict[RobotId, tuple[bool, bool]] = {}
        # Packets on their way: when they are due, in what order, to whom.
        self._outbox: list[tuple[float, int, Sender, bytes]] = []
        self._order = count()

    def run(
        self,
        seconds: float | None = None,
        on_step: Callable[[ServedField], None] | None = None,
        stop: Callable[[], bool] | None = None,
    ) -> None:
        """Serve in real time, or at ``speed`` times it, for so long or until interrupted.

        Args:
            seconds: of this machine's clock [s].
            on_step: called after every step, for whoever wants to look or judge.
            stop: asked after every step whether to end.
        """
        began = clocks.monotonic()
        base, base_time = began, self.field.time
        speed = self.speed
        while True:
            now = clocks.monotonic()
            if seconds is not None and now - began >= seconds:
                return
            if self.speed != speed:
                base, base_time, speed = now, self.field.time, self.speed
            simulated = base_time + (now - base) * speed
            if simulated - self.field.time > _BEHIND + self.field.period:
                base, base_time = now, self.field.time + self.field.period
                simulated = base_time
            if simulated >= self.field.time + self.field.period:
                self.receive()
                self.step()
                if on_step is not None:
                    on_step(self.field)
                if stop is not None and stop():
                    return
            self.send_due(simulated)
            due = self.field.time + self.field.period
            if self._outbox:
                due = min(due, self._outbox[0][0])
            left = (due - base_time) / speed + base - clocks.monotonic()
            if left > 0.0 and select.select(self._sources(), [], [], left)[0]:
                self.receive()

    def receive(self) -> None:
        """Take in the packets that wait; a flood of them not all at once."""
        for receiver, obey in self._readers:
            end = clocks.monotonic() + _MOST_READING
            for packet in receiver.receive():
                obey(packet)
                if clocks.monotonic() > end:
                    break

    def step(self) -> None:
        """Simulate one period, and put what the cameras then see into the outbox."""
        field = self.field
        field.step()
        self.frames += 1
        now = field.time
        sent = now + self._realism.vision_delay
        frames = self._cameras.look(self._epoch + now, self._epoch + sent, field.poses(), field.ball())
        geometry = write_field(field.field) if self.frames % _GEOMETRY_EVERY == 1 else None
        for frame in frames:
            self._post(sent, self._vision, write_vision(frame, geometry))
            geometry = None
        tracked = write_tracked(field.truth(), self.frames, self._epoch + now, self._uuid)
        self._post(now, self._tracker, tracked)
        self._report_status()

    def send_due(self, time: float) -> None:
        """Send what is due at a simulated time [s]."""
        while self._outbox and self._outbox[0][0] <= time + 1e-9:
            due, _, sender, data = heapq.heappop(self._outbox)
            sender.send(data)
            if self._log is not None:
                kind = LogKind.VISION if sender is self._vision else LogKind.TRACKER
                self._log.write(round((self._epoch + due) * 1e9), kind, data)

    def close(self) -> None:
        """Free all ports."""
        for socket in self._open:
            socket.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _sender(self, to: Endpoint, interface: str) -> Sender:
        sender = Sender(to.address, to.port, interface)
        self._open.append(sender)
        return sender

    def _receiver(self, port: int, interface: str) -> Receiver:
        receiver = Receiver(interface, port, interface if interface != LOOPBACK else None)
        self._open.append(receiver)
        return receiver

    def _sources(self) -> list[Receiver]:
        return [self._grsim, self._control, *self._teams.values()]

    def _post(self, due: float, sender: Sender, data: bytes) -> None:
        heapq.heappush(self._outbox, (due, next(self._order), sender, data))

    def _set_realism(self, realism: RealismSettings) -> None:
        self._realism = realism
        self._cameras = Cameras(self.field.field, realism, self._camera_count, self._rng)
        self.field.lose_commands(realism)

    def _obey_grsim(self, packet: Packet) -> None:
        orders = read_grsim(packet.data, self._grsim.counts)
        if orders is None:
            return
        for robot, command in orders.commands.items():
            self._status_to[robot.team] = packet.sender[0]
            self.field.command(robot, command)
        for teleport in orders.robots:
            self.field.teleport(teleport)
        if orders.ball is not None:
            self.field.teleport_ball(orders.ball)

    def _obey_control(self, team: Team, receiver: Receiver, packet: Packet) -> None:
        headings = {robot.number: pose[2] for robot, pose in self.field.poses().items() if robot.team is team}
        orders = read_control(packet.data, team, headings, receiver.counts)
        if orders is None:
            return
        commands, errors = orders
        response = RobotControlResponse()
        for code, problem in errors:
            response.errors.add(code=code, message=problem)
        contacts = self.field.contacts()
        for robot, command in commands.items():
            if self.field.command(robot, command):
                response.feedback.add(id=robot.number, dribbler_ball_contact=contacts.get(robot, False))
            else:
                response.errors.add(code="NO_ROBOT", message=f"there is no robot {robot} on the field")
        receiver.answer(response.SerializeToString(), packet.sender)

    def _obey_simulator(self, packet: Packet) -> None:
        counts = self._control.counts
        message = decode(SimulatorCommand, packet.data, counts)
        if message is None:
            return
        teleports = read_teleports(message)
        speed = message.control.simulation_speed
        if teleports is None or not isfinite(speed):
            counts.implausible += 1
            return
        counts.accepted += 1
        problems = [self.field.teleport(robot) for robot in teleports[0]]
        if teleports[1] is not None:
            problems.append(self.field.teleport_ball(teleports[1]))
        response = SimulatorResponse()
        for problem in problems:
            if problem is not None:
                response.errors.add(code="CANNOT_TELEPORT", message=problem)
        if message.control.HasField("simulation_speed"):
            if _SPEEDS[0] <= speed <= _SPEEDS[1]:
                self.speed = speed
            else:
                there = f"the speed must be {_SPEEDS[0]} to {_SPEEDS[1]}"
                response.errors.add(code="SPEED", message=there)
        for code, problem in self._configure(message):
            response.errors.add(code=code, message=problem)
        self._control.answer(response.SerializeToString(), packet.sender)

    def _configure(self, message: SimulatorCommand) -> list[tuple[str, str]]:
        """Take over a configuration; returns what of it cannot be."""
        config, problems = message.config, []
        if config.HasField("geometry") or config.HasField("vision_port"):
            problems.append(("FIXED", "field and ports are those the server was started with"))
        for spec in config.robot_specs:
            team = _TEAM_NUMBERS.get(int(spec.id.team))
            if team is None or not spec.HasField("limits"):
                continue
            robot = RobotId(team, spec.id.id)
            asked = {
                "max_speed": spec.limits.vel_absolute_max
                if spec.limits.HasField("vel_absolute_max")
                else None,
                "max_turn": spec.limits.vel_angular_max if spec.limits.HasField("vel_angular_max") else None,
            }
            limits = _limited(self.field.settings.limits, asked)
            if limits is None or not self.field.limit(robot, limits):
                problems.append(("ROBOT_SPECS", f"limits of {robot} cannot be so"))
        for custom in config.realism_config.custom:
            realism = RealismConfigErForce()
            if custom.type_url.rpartition("/")[2].rpartition(".")[2] != "RealismConfigErForce":
                continue
            try:
                realism.MergeFromString(custom.value)
                self._set_realism(_realism_from(realism, self._realism))
            except (DecodeError, ValueError):
                problems.append(("REALISM", "no such realism"))
        return problems

    def _report_status(self) -> None:
        """grSim's status of robots whose ball sensor or kicker has changed, to whoever commands them."""
        kicked = set(self.field.kicked)
        ports = {Team.BLUE: self.endpoints.blue_status, Team.YELLOW: self.endpoints.yellow_status}
        changed: dict[Team, Robots_Status] = {}
        for robot, contact in self.field.contacts().items():
            now = (contact, robot in kicked)
            if robot.team in self._status_to and self._status.get(robot) != now:
                self._status[robot] = now
                changed.setdefault(robot.team, Robots_Status()).robots_status.add(
                    robot_id=robot.number, infrared=contact, flat_kick=now[1], chip_kick=False
                )
        for team, status in changed.items():
            self._grsim.answer(status.SerializeToString(), (self._status_to[team], ports[team]))


def _limited(base: RobotLimits, asked: Mapping[str, float | None]) -> RobotLimits | None:
    """The limits lowered to what was asked for; None when that is no limit."""
    changes = {}
    for name, value in asked.items():
        if value is None:
            continue
        if not value > 0.0:
            return None
        changes[name] = min(value, getattr(base, name))
    return base.model_copy(update=changes)


def _realism_from(message: RealismConfigErForce, base: RealismSettings) -> RealismSettings:
    """The level with what the message sets replaced.

    Raises:
        ValueError: a value out of range.
    """
    names = {
        "stddev_ball_p": "ball_noise",
        "stddev_robot_p": "robot_noise",
        "stddev_robot_phi": "heading_noise",
        "missing_ball_detections": "missing_ball",
        "robot_command_loss": "command_loss",
    }
    changes = {ours: getattr(message, theirs) for theirs, ours in names.items() if message.HasField(theirs)}
    if message.HasField("vision_delay"):
        changes["vision_delay"] = message.vision_delay / 1e9
    return RealismSettings.model_validate({**base.model_dump(), **changes})
