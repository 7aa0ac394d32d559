"""Commands and teleports, as grSim's packets and the simulation protocol both express them."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos, isfinite, nan, radians, sin

import numpy as np

from robobt.league.wire.messages import Message
from robobt.league.wire.packets import MAX_ROBOT_NUMBER
from robobt.sim.robot_settings import KickerSettings
from robobt.world.command import RobotCommand
from robobt.world.geometry import limit_norm
from robobt.world.limits import RobotLimits
from robobt.world.state import RobotId

_WHEEL_DIRECTIONS = (60.0, 135.0, 225.0, 300.0)
"""Directions of grSim's wheels from straight ahead [deg]: front left, back left, back right, front right."""

# Velocity (forward, left, angular) from the wheels' surface speeds.
_FROM_WHEELS = np.linalg.pinv(
    np.array([[-sin(radians(a)), cos(radians(a)), 0.09] for a in _WHEEL_DIRECTIONS], dtype=np.float64)
)


@dataclass(slots=True)
class Teleport:
    """Where to put a robot [m, rad, m/s, rad/s]; None keeps the present value.

    ``present`` takes the robot off the field (False) or brings it back (True).
    """

    robot: RobotId
    x: float | None = None
    y: float | None = None
    heading: float | None = None
    vx: float = 0.0
    vy: float = 0.0
    omega: float = 0.0
    present: bool | None = None


@dataclass(slots=True)
class BallTeleport:
    """Where to put the ball [m, m/s]; None keeps the present value. It slides unless it ``rolls``.

    ``z`` is its height above where it lies, ``vz`` how fast it rises.
    """

    x: float | None = None
    y: float | None = None
    vx: float | None = None
    vy: float | None = None
    rolls: bool = False
    z: float = 0.0
    vz: float = 0.0


@dataclass(slots=True)
class Request:
    """The requests in a packet to a simulator.

    ``errors`` holds code and message of what is not supported.
    """

    commands: dict[RobotId, RobotCommand] = field(default_factory=dict)
    teleports: list[Teleport] = field(default_factory=list)
    ball: BallTeleport | None = None
    errors: list[tuple[str, str]] = field(default_factory=list)

    def finite(self) -> bool:
        """Return whether every number in the request is finite."""
        numbers: list[float | None] = []
        for robot in self.teleports:
            numbers += [robot.x, robot.y, robot.heading, robot.vx, robot.vy, robot.omega]
        if self.ball is not None:
            numbers += [self.ball.x, self.ball.y, self.ball.vx, self.ball.vy, self.ball.z, self.ball.vz]
        return all(number is None or isfinite(number) for number in numbers) and all(
            command.finite() for command in self.commands.values()
        )


def clamp_command(command: RobotCommand, limits: RobotLimits, kicker: KickerSettings) -> RobotCommand:
    """Return the command within the robot's limits, as far as its gains reach them, and its kicker's."""
    vx, vy = limit_norm(command.vx, command.vy, limits.max_speed / min(limits.gain, limits.side_gain, 1.0))
    most = limits.max_turn / min(limits.turn_gain, 1.0)
    omega = min(max(command.omega, -most), most)
    fastest = kicker.max_chip_speed if command.kick_angle > 0.0 else kicker.max_speed
    kick = min(max(command.kick_speed, 0.0), fastest)
    return RobotCommand(vx, vy, omega, kick, command.kick_trigger, command.dribbler, command.kick_angle)


def velocity_from_wheels(speeds: list[float]) -> tuple[float, float, float]:
    """Return the velocity (forward, left, angular) of a robot whose wheels have these surface speeds [m/s].

    A speed that is not finite gives a velocity that is not finite.
    """
    if not all(map(isfinite, speeds)):
        return (nan, 0.0, 0.0)
    vx, vy, omega = (_FROM_WHEELS @ np.array(speeds)).tolist()
    return vx, vy, omega


def optional(message: Message, name: str) -> float | None:
    """Return a field's value, None when the packet leaves it out."""
    return float(getattr(message, name)) if message.HasField(name) else None


def known_robots(contacts: dict[int, bool]) -> dict[int, bool] | None:
    """Return the entries of possible robot numbers; None when there are only impossible ones."""
    known = {number: contact for number, contact in contacts.items() if 0 <= number <= MAX_ROBOT_NUMBER}
    return None if contacts and not known else known
