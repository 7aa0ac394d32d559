"""A field in miniature whose cameras can be made to err, without a network and on a clock of its own."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import cos, hypot, inf, sin
from typing import Any

import numpy as np

from robobt.league.wire.sockets import Address, Packet
from robobt.league.wire.vision import BallDetection, CameraFrame, RobotDetection, write_vision
from robobt.league.world import LeagueWorld
from robobt.world.command import RobotCommand
from robobt.world.game import Team
from robobt.world.state import RobotId
from tests.league.served import free_endpoints

PERIOD = 1 / 60
REACTION = 0.05
"""How long a command takes to have an effect [s]."""

ACCELERATION = 3.0
"""Of the robots [m/s^2]."""

FIRST, SECOND = ("10.0.0.5", 10006), ("10.0.0.6", 40006)
"""Two senders of vision."""

Sent = list[tuple[CameraFrame, Address]]


class FaultyField(LeagueWorld):
    """A world whose robots obey, seen by one camera or two that share the field at x = 0.

    Attributes:
        poses: x, y, heading of each robot [m, rad].
        stuck: robots that do not move.
        noise: standard deviation of the detected positions [m].
        fault: changes what the cameras send at a time.
        moved: when a command that moves a robot was sent last, by robot [s].
        sent: the commands that were sent last.
    """

    def __init__(self, robots: int = 2, cameras: int = 1, noise: float = 0.0013, **options: Any) -> None:
        self.machine_time = 100.0
        self.poses = {
            RobotId(team, number): [side * (1.0 + number), 0.8 * number - 1.0, 0.3 * number]
            for team, side in ((Team.BLUE, -1.0), (Team.YELLOW, 1.0))
            for number in range(robots)
        }
        self.stuck: set[RobotId] = set()
        self.noise, self._cameras = noise, cameras
        self.fault: Callable[[float, list[CameraFrame]], Sent] = lambda _, frames: [
            (it, FIRST) for it in frames
        ]
        self.moved = dict.fromkeys(self.poses, -inf)
        self.sent: Mapping[RobotId, RobotCommand] = {}
        self._velocities = {robot: [0.0, 0.0] for robot in self.poses}
        self._orders: list[tuple[float, Mapping[RobotId, RobotCommand]]] = []
        self._number, self._next = 0, self.machine_time + PERIOD
        self._rng = np.random.default_rng(0)
        super().__init__(
            robots=dict.fromkeys(self.poses),
            endpoints=free_endpoints(),
            clock=lambda: self.machine_time,
            place=False,
            **options,
        )
        self._feed.receive = self._receive  # type: ignore[method-assign]
        self._link.send = self._obey  # type: ignore[method-assign]

    def play(self, seconds: float, commands: Mapping[RobotId, RobotCommand] | None = None) -> float:
        """Play on; return how far robots seem to be from their places, at most; inf for one missing [m]."""
        worst = 0.0
        end = self.machine_time + seconds
        while self.machine_time < end:
            self.act(commands or {})
            seen = self.observe().robots()
            for robot, (x, y, _) in self.poses.items():
                state = seen.get(robot)
                worst = max(worst, inf if state is None else hypot(state.x - x, state.y - y))
        return worst

    def _receive(self, wait: float) -> None:
        end = self.machine_time + wait
        if wait <= 0.0:
            return
        if self._next > end:
            self.machine_time = end
            return
        self.machine_time = self._next
        self._next += PERIOD
        self._move()
        feed = self._feed
        for frame, sender in self.fault(self.machine_time, self._look()):
            used = feed._read(Packet(write_vision(frame), sender), self.machine_time)
            if used is not None:
                feed.add(used, self.machine_time)

    def _obey(self, commands: Mapping[RobotId, RobotCommand], _: float) -> None:
        self.sent = commands
        for robot, command in commands.items():
            if command.vx or command.vy or command.omega:
                self.moved[robot] = self.machine_time
        self._orders.append((self.machine_time + REACTION, commands))

    def _move(self) -> None:
        while len(self._orders) > 1 and self._orders[1][0] <= self.machine_time:
            del self._orders[0]
        orders = self._orders[0][1] if self._orders and self._orders[0][0] <= self.machine_time else {}
        for robot, pose in self.poses.items():
            if robot in self.stuck:
                continue
            command, velocity = orders.get(robot, RobotCommand()), self._velocities[robot]
            c, s = cos(pose[2]), sin(pose[2])
            wanted = (c * command.vx - s * command.vy, s * command.vx + c * command.vy)
            for axis in (0, 1):
                most = ACCELERATION * PERIOD
                velocity[axis] += min(max(wanted[axis] - velocity[axis], -most), most)
                pose[axis] += velocity[axis] * PERIOD
            pose[2] += command.omega * PERIOD

    def _look(self) -> list[CameraFrame]:
        now = self.machine_time
        self._number += 1
        frames = [CameraFrame(camera, self._number, now, now) for camera in range(self._cameras)]
        for robot, (x, y, heading) in self.poses.items():
            dx, dy = self._rng.normal(0.0, 1.0, 2) * self.noise
            camera = int(self._cameras > 1 and x > 0.0)
            frames[camera].robots.append(RobotDetection(robot, x + dx, y + dy, heading))
        dx, dy = self._rng.normal(0.0, 1.0, 2) * self.noise
        frames[0].balls.append(BallDetection(-0.5 + dx, 0.5 + dy))
        return frames
