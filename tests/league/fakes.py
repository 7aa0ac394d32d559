"""Small stand-ins for grSim and ER-Force's simulator, with what is peculiar about them.

Source of the peculiarities: the two simulators as observed, ``docs/league.md``.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from math import cos, hypot, inf, radians, sin

from robobt.league.wire.endpoints import Endpoints
from robobt.league.wire.geometry import write_geometry
from robobt.league.wire.messages import (
    RobotControl,
    RobotControlResponse,
    SimulatorCommand,
    SSL_WrapperPacket,
    grSim_Packet,
)
from robobt.league.wire.sockets import Receiver, Sender
from robobt.world.field import DIVISION_B, FieldGeometry
from robobt.world.game import Team
from robobt.world.state import RobotId
from tests.waiting import LIMIT

_TEAMS = {1: Team.YELLOW, 2: Team.BLUE}


@dataclass
class _Robot:
    x: float
    y: float
    heading: float
    vx: float = 0.0
    vy: float = 0.0
    omega: float = 0.0
    present: bool = True


@dataclass
class FakeSimulator:
    """Robots that have their commanded velocity at once, and a ball that lies where it was put.

    Attributes:
        rate: frames a second.
        cameras: packets a frame, one a quarter of the field.
        delay: how late the vision is, and how much of that its packets tell [s].
        occludes: whether a robot hides a ball at its mouth.
        watchdog: grSim's crossed one: a team stands after every frame unless the other team's
            control port has heard something within so long, a second there [s].
        geometry: what is told of the field; None tells nothing.
    """

    endpoints: Endpoints
    rate: float = 60.0
    cameras: int = 1
    delay: float = 0.0
    told_delay: float = 0.0
    occludes: bool = False
    watchdog: float = inf
    geometry: FieldGeometry | None = DIVISION_B
    clock_from: float = 0.0
    robots: dict[RobotId, _Robot] = field(default_factory=dict)
    ball: tuple[float, float] = (0.0, 0.0)
    time: float = 0.0
    zeroed: int = 0
    errors: list[str] = field(default_factory=list)
    directions: list[float] = field(default_factory=list)

    def __post_init__(self) -> None:
        if not self.robots:
            for team, side in ((Team.BLUE, -1.0), (Team.YELLOW, 1.0)):
                for number in range(2):
                    self.robots[RobotId(team, number)] = _Robot(side * 2.0, float(number), 0.0)
        self._vision = Sender(*self.endpoints.vision)
        ports = (self.endpoints.grsim, self.endpoints.control)
        self._grsim, self._control = (Receiver("127.0.0.1", port) for port in ports)
        self._teams = {
            Team.BLUE: Receiver("127.0.0.1", self.endpoints.blue),
            Team.YELLOW: Receiver("127.0.0.1", self.endpoints.yellow),
        }
        self._heard = dict.fromkeys(Team, -1e9)
        self._outbox: list[tuple[float, list[bytes]]] = []
        self._frame = 0

    def close(self) -> None:
        sockets: list[Sender | Receiver] = [self._vision, self._grsim, self._control, *self._teams.values()]
        for sock in sockets:
            sock.close()

    def frame(self) -> None:
        """One period of the simulator."""
        self._obey()
        period = 1 / self.rate
        for robot in self.robots.values():
            c, s = cos(robot.heading), sin(robot.heading)
            robot.x += (c * robot.vx - s * robot.vy) * period
            robot.y += (s * robot.vx + c * robot.vy) * period
            robot.heading += robot.omega * period
        self.time += period
        self._frame += 1
        self._outbox.append((self.time + self.delay, self._packets()))
        while self._outbox and self._outbox[0][0] <= self.time + 1e-9:
            for data in self._outbox.pop(0)[1]:
                self._vision.send(data)
        for number, robot in self.robots.items():
            if self.time - self._heard[number.team.other] > self.watchdog:
                self.zeroed += bool(robot.vx or robot.vy or robot.omega)
                robot.vx = robot.vy = robot.omega = 0.0

    def _obey(self) -> None:
        for packet in self._grsim.receive():
            # Strict, as generated C++ code is: a required field that is missing drops the packet.
            message = grSim_Packet.FromString(packet.data)
            if not message.IsInitialized():
                self.errors.append("grSim packet without a required field")
            team = Team.YELLOW if message.commands.isteamyellow else Team.BLUE
            for command in message.commands.robot_commands:
                self._drive(
                    RobotId(team, command.id), command.veltangent, command.velnormal, command.velangular
                )
            for place in message.replacement.robots:
                number = RobotId(Team.YELLOW if place.yellowteam else Team.BLUE, place.id)
                self.directions.append(place.dir)
                self._place(number, place.x, place.y, radians(place.dir), place.turnon)
            if message.replacement.HasField("ball"):
                self.ball = (message.replacement.ball.x, message.replacement.ball.y)
        for team, receiver in self._teams.items():
            for packet in receiver.receive():
                self._heard[team] = self.time
                control = RobotControl.FromString(packet.data)
                for one in control.robot_commands:
                    local = one.move_command.local_velocity
                    self._drive(RobotId(team, one.id), local.forward, local.left, local.angular)
                receiver.answer(RobotControlResponse().SerializeToString(), packet.sender)
        for packet in self._control.receive():
            order = SimulatorCommand.FromString(packet.data)
            for robot in order.control.teleport_robot:
                number = RobotId(_TEAMS[int(robot.id.team)], robot.id.id)
                present = robot.present if robot.HasField("present") else True
                self._place(number, robot.x, robot.y, robot.orientation, present)
            if order.control.HasField("teleport_ball"):
                self.ball = (order.control.teleport_ball.x, order.control.teleport_ball.y)

    def _drive(self, number: RobotId, vx: float, vy: float, omega: float) -> None:
        robot = self.robots.get(number)
        if robot is not None:
            robot.vx, robot.vy, robot.omega = vx, vy, omega

    def _place(self, number: RobotId, x: float, y: float, heading: float, present: bool) -> None:
        self.robots[number] = _Robot(x, y, heading, present=present)

    def _packets(self) -> list[bytes]:
        packets = []
        for camera in range(self.cameras):
            message = SSL_WrapperPacket()
            frame = message.detection
            frame.frame_number, frame.camera_id = self._frame, camera
            frame.t_sent = self.clock_from + self.time + self.delay
            frame.t_capture = frame.t_sent - self.told_delay
            for number, robot in self.robots.items():
                if robot.present and self._sees(camera, robot.x, robot.y):
                    team = frame.robots_blue if number.team is Team.BLUE else frame.robots_yellow
                    team.add(
                        confidence=1.0,
                        robot_id=number.number,
                        x=robot.x * 1e3,
                        y=robot.y * 1e3,
                        orientation=robot.heading,
                        pixel_x=0.0,
                        pixel_y=0.0,
                    )
            if self._sees(camera, *self.ball) and not self._hidden():
                x, y = self.ball
                frame.balls.add(confidence=1.0, x=x * 1e3, y=y * 1e3, pixel_x=0.0, pixel_y=0.0)
            if self.geometry is not None and camera == 0 and self._frame % 30 == 1:
                message.geometry.CopyFrom(write_geometry(self.geometry))
            packets.append(message.SerializeToString())
        return packets

    def _sees(self, camera: int, x: float, y: float) -> bool:
        """grSim's four cameras share the field in quarters that overlap."""
        if self.cameras == 1:
            return True
        right, upper = camera in (0, 1), camera in (0, 3)
        return (x > -0.2 if right else x < 0.2) and (y > -0.2 if upper else y < 0.2)

    def _hidden(self) -> bool:
        x, y = self.ball
        return self.occludes and any(
            hypot(robot.x - x, robot.y - y) < 0.125 for robot in self.robots.values() if robot.present
        )


@contextmanager
def running(simulator: FakeSimulator) -> Iterator[FakeSimulator]:
    """The simulator at its rate, until the end of the block."""
    ended = threading.Event()

    def run() -> None:
        began = time.monotonic()
        frames = 0
        while not ended.is_set():
            simulator.frame()
            frames += 1
            ended.wait(max(0.0, began + frames / simulator.rate - time.monotonic()))

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    try:
        yield simulator
    finally:
        ended.set()
        thread.join(LIMIT)
        simulator.close()
