"""grSim's own packets: commands, replacements and robot status.

At this edge replacements turn robots in degrees.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from math import atan2, cos, degrees, hypot, radians, sin

from robobt.league.wire.commands import (
    BallTeleport,
    Request,
    Teleport,
    known_robots,
    optional,
    velocity_from_wheels,
)
from robobt.league.wire.messages import Robots_Status, grSim_Packet
from robobt.league.wire.packets import MAX_OBJECTS, PacketCounts, read
from robobt.world.command import KickTrigger, RobotCommand
from robobt.world.game import Team
from robobt.world.state import RobotId

_WHEEL_RADIUS = 0.027
"""Radius of grSim's wheels [m]."""


def write_grsim(team: Team, commands: Mapping[int, RobotCommand], time: float) -> bytes:
    """Return the packet with the commands of one team's robots, by number."""
    packet = grSim_Packet()
    packet.commands.timestamp = time
    packet.commands.isteamyellow = team is Team.YELLOW
    for number, command in commands.items():
        packet.commands.robot_commands.add(
            id=number,
            kickspeedx=command.kick_speed * cos(command.kick_angle),
            kickspeedz=command.kick_speed * sin(command.kick_angle),
            veltangent=command.vx,
            velnormal=command.vy,
            velangular=command.omega,
            spinner=bool(command.dribbler),
            wheelsspeed=False,
        )
    return bytes(packet.SerializeToString())


def write_grsim_replacement(robots: Iterable[Teleport], ball: BallTeleport | None) -> bytes:
    """Return the packet that teleports robots and ball; every robot needs a full pose."""
    packet = grSim_Packet()
    packet.replacement.SetInParent()
    for robot in robots:
        packet.replacement.robots.add(
            x=robot.x,
            y=robot.y,
            dir=degrees(robot.heading or 0.0),
            id=robot.robot.number,
            yellowteam=robot.robot.team is Team.YELLOW,
            turnon=robot.present is not False,
        )
    if ball is not None:
        packet.replacement.ball.x = ball.x or 0.0
        packet.replacement.ball.y = ball.y or 0.0
        packet.replacement.ball.vx = ball.vx or 0.0
        packet.replacement.ball.vy = ball.vy or 0.0
    return bytes(packet.SerializeToString())


def read_grsim(data: bytes, counts: PacketCounts) -> Request | None:
    """Return what a packet asks for, or None (counted) when it is malformed or implausible."""
    return read(grSim_Packet, data, counts, _request)


def _request(message: grSim_Packet) -> Request | None:
    if not (message.HasField("commands") or message.HasField("replacement")):
        return None
    if max(len(message.commands.robot_commands), len(message.replacement.robots)) > MAX_OBJECTS:
        return None
    request = Request()
    team = Team.YELLOW if message.commands.isteamyellow else Team.BLUE
    for robot in message.commands.robot_commands:
        vx, vy, omega = robot.veltangent, robot.velnormal, robot.velangular
        if robot.wheelsspeed:
            wheels = (robot.wheel1, robot.wheel2, robot.wheel3, robot.wheel4)
            vx, vy, omega = velocity_from_wheels([speed * _WHEEL_RADIUS for speed in wheels])
        kick, angle = robot.kickspeedx, 0.0
        if robot.kickspeedz > 0.0:
            kick, angle = hypot(kick, robot.kickspeedz), atan2(robot.kickspeedz, max(kick, 0.0))
        request.commands[RobotId(team, robot.id)] = RobotCommand(
            vx, vy, omega, kick, KickTrigger.ON_CONTACT, robot.spinner, angle
        )
    for place in message.replacement.robots:
        number = RobotId(Team.YELLOW if place.yellowteam else Team.BLUE, place.id)
        present = place.turnon if place.HasField("turnon") else True
        request.teleports.append(Teleport(number, place.x, place.y, radians(place.dir), present=present))
    if message.replacement.HasField("ball"):
        x, y, vx, vy = (optional(message.replacement.ball, name) for name in ("x", "y", "vx", "vy"))
        request.ball = BallTeleport(x, y, vx, vy)
    return request if request.finite() else None


def read_status(data: bytes, counts: PacketCounts) -> dict[int, bool]:
    """Return whether each robot in a status packet has the ball in its break-beam sensor, by number."""

    def convert(message: Robots_Status) -> dict[int, bool] | None:
        return known_robots({status.robot_id: status.infrared for status in message.robots_status})

    return read(Robots_Status, data, counts, convert) or {}
