"""Commands, placements and feedback as packets: grSim's form and the simulation protocol's.

Written by whoever plays, read by whoever serves. Units at this edge: grSim's
replacement turns robots in degrees, a dribbler spins in turns a minute.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from math import cos, degrees, isfinite, radians, sin

import numpy as np

from robobt.league.wire.messages import (
    Message,
    RobotControl,
    RobotControlResponse,
    Robots_Status,
    SimulatorCommand,
    grSim_Packet,
)
from robobt.league.wire.messages import RobotCommand as RobotCommandMessage
from robobt.league.wire.sockets import PacketCounts, decode
from robobt.league.wire.vision import MOST_NUMBER
from robobt.world.command import KickTrigger, RobotCommand
from robobt.world.game import Team
from robobt.world.geometry import limit_norm
from robobt.world.limits import RobotLimits
from robobt.world.state import RobotId

_DRIBBLER_RPM = 1500.0
"""Turns a minute of a dribbler that is on; ER-Force's roller does 150 rad/s."""

_CAREFUL_RPM = 1.0
"""A dribbler slower than this is off."""

_WHEELS = (60.0, 135.0, 225.0, 300.0)
"""Direction of grSim's wheels from straight ahead [deg]: front left, back left, back right, front right."""

_WHEEL_RADIUS = 0.027
"""Of grSim's wheels [m]."""

_MOST_OBJECTS = 64
"""Most objects of a kind in a packet; nobody has so many robots."""

_TEAM_NUMBERS = {Team.YELLOW: 1, Team.BLUE: 2}
_TEAMS = {number: team for team, number in _TEAM_NUMBERS.items()}

# Velocity (forward, left, angular) from the wheels' surface speeds.
_FROM_WHEELS = np.linalg.pinv(
    np.array([[-sin(radians(a)), cos(radians(a)), 0.09] for a in _WHEELS], dtype=np.float64)
)


@dataclass(slots=True)
class Teleport:
    """Where a robot is put [m, rad, m/s, rad/s]; None leaves a value as it is."""

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
    """Where the ball is put [m, m/s]; None leaves a value as it is. It slides unless it ``rolls``."""

    x: float | None = None
    y: float | None = None
    vx: float | None = None
    vy: float | None = None
    rolls: bool = False


def bounded(command: RobotCommand, limits: RobotLimits, max_kick: float) -> RobotCommand:
    """The command within what the robot can do and the kicker may [m/s]."""
    vx, vy = limit_norm(command.vx, command.vy, limits.max_speed)
    omega = min(max(command.omega, -limits.max_turn), limits.max_turn)
    kick = min(max(command.kick_speed, 0.0), max_kick)
    return RobotCommand(vx, vy, omega, kick, command.kick_trigger, command.dribbler)


# What is sent.


def write_grsim(team: Team, commands: Mapping[int, RobotCommand], time: float) -> bytes:
    """grSim's packet with the commands of one team's robots, by number."""
    packet = grSim_Packet()
    packet.commands.timestamp = time
    packet.commands.isteamyellow = team is Team.YELLOW
    for number, command in commands.items():
        packet.commands.robot_commands.add(
            id=number,
            kickspeedx=command.kick_speed,
            kickspeedz=0.0,
            veltangent=command.vx,
            velnormal=command.vy,
            velangular=command.omega,
            spinner=bool(command.dribbler),
            wheelsspeed=False,
        )
    return bytes(packet.SerializeToString())


def write_grsim_placement(robots: Iterable[Teleport], ball: BallTeleport | None) -> bytes:
    """grSim's packet that puts robots and ball somewhere; every robot needs a full pose."""
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


def write_control(commands: Mapping[int, RobotCommand]) -> bytes:
    """The simulation protocol's packet with the commands of a team's robots, by number.

    Without any it is the empty message, which keeps a port alive.
    """
    packet = RobotControl()
    for number, command in commands.items():
        robot = packet.robot_commands.add(id=number)
        local = robot.move_command.local_velocity
        local.forward, local.left, local.angular = command.vx, command.vy, command.omega
        if command.kick_speed > 0.0:
            robot.kick_speed = command.kick_speed
            robot.kick_angle = 0.0
        robot.dribbler_speed = _DRIBBLER_RPM if command.dribbler else 0.0
    return bytes(packet.SerializeToString())


def write_teleport(robots: Iterable[Teleport], ball: BallTeleport | None) -> bytes:
    """The simulation protocol's packet that puts robots and ball somewhere."""
    packet = SimulatorCommand()
    control = packet.control
    control.SetInParent()
    for robot in robots:
        teleport = control.teleport_robot.add()
        teleport.id.id = robot.robot.number
        teleport.id.team = _TEAM_NUMBERS[robot.robot.team]
        if robot.x is not None and robot.y is not None and robot.heading is not None:
            teleport.x, teleport.y, teleport.orientation = robot.x, robot.y, robot.heading
        teleport.v_x, teleport.v_y, teleport.v_angular = robot.vx, robot.vy, robot.omega
        if robot.present is not None:
            teleport.present = robot.present
    if ball is not None:
        put = control.teleport_ball
        put.x, put.y, put.z = ball.x or 0.0, ball.y or 0.0, 0.0
        put.vx, put.vy, put.vz = ball.vx or 0.0, ball.vy or 0.0, 0.0
        if ball.rolls and (ball.vx or ball.vy):
            # Only where it matters: grSim answers this field with an error.
            put.roll = True
    return bytes(packet.SerializeToString())


# What comes back to whoever plays.


def read_status(data: bytes, counts: PacketCounts) -> dict[int, bool]:
    """From grSim's status: whether each robot it speaks of has the ball before its sensor."""
    message = decode(Robots_Status, data, counts)
    if message is None:
        return {}
    told = {status.robot_id: status.infrared for status in message.robots_status}
    return _of_robots(told, counts)


def read_feedback(data: bytes, counts: PacketCounts) -> dict[int, bool]:
    """The same from the simulation protocol's answer."""
    message = decode(RobotControlResponse, data, counts)
    if message is None:
        return {}
    told = {
        robot.id: robot.dribbler_ball_contact
        for robot in message.feedback
        if robot.HasField("dribbler_ball_contact")
    }
    return _of_robots(told, counts)


def _of_robots(told: dict[int, bool], counts: PacketCounts) -> dict[int, bool]:
    """What is told of numbers that robots can have; a packet that knows only others is counted."""
    known = {number: contact for number, contact in told.items() if 0 <= number <= MOST_NUMBER}
    if told and not known:
        counts.implausible += 1
    else:
        counts.accepted += 1
    return known


# What whoever serves reads.


@dataclass(slots=True)
class GrSimOrders:
    """What a packet of grSim's asks for."""

    commands: dict[RobotId, RobotCommand]
    robots: list[Teleport]
    ball: BallTeleport | None


def read_grsim(data: bytes, counts: PacketCounts) -> GrSimOrders | None:
    """What a grSim packet asks for; None, counted, when it is none or cannot be meant."""
    message = decode(grSim_Packet, data, counts)
    if message is None:
        return None
    if max(len(message.commands.robot_commands), len(message.replacement.robots)) > _MOST_OBJECTS:
        counts.implausible += 1
        return None
    orders = GrSimOrders({}, [], None)
    team = Team.YELLOW if message.commands.isteamyellow else Team.BLUE
    for robot in message.commands.robot_commands:
        vx, vy, omega = robot.veltangent, robot.velnormal, robot.velangular
        if robot.wheelsspeed:
            wheels = (robot.wheel1, robot.wheel2, robot.wheel3, robot.wheel4)
            vx, vy, omega = _from_wheels([speed * _WHEEL_RADIUS for speed in wheels])
        # The ball rolls here: of a chip, what it moves along the ground.
        kick = robot.kickspeedx
        orders.commands[RobotId(team, robot.id)] = RobotCommand(
            vx, vy, omega, kick, KickTrigger.ON_CONTACT, robot.spinner
        )
    for place in message.replacement.robots:
        number = RobotId(Team.YELLOW if place.yellowteam else Team.BLUE, place.id)
        present = place.turnon if place.HasField("turnon") else True
        orders.robots.append(Teleport(number, place.x, place.y, radians(place.dir), present=present))
    if message.HasField("replacement") and message.replacement.HasField("ball"):
        ball = message.replacement.ball
        x, y, vx, vy = [_given(ball, name) for name in ("x", "y", "vx", "vy")]
        orders.ball = BallTeleport(x, y, vx, vy)
    if not (message.HasField("commands") or message.HasField("replacement")) or not _sane(orders):
        counts.implausible += 1
        return None
    counts.accepted += 1
    return orders


def read_control(
    data: bytes, team: Team, headings: Mapping[int, float], counts: PacketCounts
) -> tuple[dict[RobotId, RobotCommand], list[tuple[str, str]]] | None:
    """Commands of the simulation protocol, with the errors to answer (code and message).

    Args:
        headings: of the team's robots, for velocities given in field coordinates [rad].

    Returns:
        None, counted, for a packet that is none or cannot be meant.
    """
    message = decode(RobotControl, data, counts)
    if message is None:
        return None
    if len(message.robot_commands) > _MOST_OBJECTS:
        counts.implausible += 1
        return None
    commands, errors = {}, []
    for robot in message.robot_commands:
        command, problem = _read_command(robot, headings.get(robot.id, 0.0))
        if not command.finite():
            counts.implausible += 1
            return None
        if problem is not None:
            errors.append(problem)
        commands[RobotId(team, robot.id)] = command
    counts.accepted += 1
    return commands, errors


def read_teleports(message: SimulatorCommand) -> tuple[list[Teleport], BallTeleport | None] | None:
    """Teleports of the simulation protocol; None when one of them is not finite, or too much is asked."""
    control, config = message.control, message.config
    asked = (control.teleport_robot, config.robot_specs, config.realism_config.custom)
    if max(map(len, asked)) > _MOST_OBJECTS:
        return None
    robots = []
    for robot in control.teleport_robot:
        team = _TEAMS.get(int(robot.id.team))
        if team is None or not robot.id.HasField("id"):
            continue
        x, y, heading = _given(robot, "x"), _given(robot, "y"), _given(robot, "orientation")
        present = robot.present if robot.HasField("present") else None
        robots.append(
            Teleport(
                RobotId(team, robot.id.id), x, y, heading, robot.v_x, robot.v_y, robot.v_angular, present
            )
        )
    ball = None
    if control.HasField("teleport_ball"):
        put = control.teleport_ball
        x, y, vx, vy = [_given(put, name) for name in ("x", "y", "vx", "vy")]
        ball = BallTeleport(x, y, vx, vy, put.roll)
    orders = GrSimOrders({}, robots, ball)
    return (robots, ball) if _sane(orders) else None


def _read_command(robot: RobotCommandMessage, heading: float) -> tuple[RobotCommand, tuple[str, str] | None]:
    vx = vy = omega = 0.0
    problem = None
    kind = robot.move_command.WhichOneof("command")
    if kind == "local_velocity":
        local = robot.move_command.local_velocity
        vx, vy, omega = local.forward, local.left, local.angular
    elif kind == "global_velocity":
        world = robot.move_command.global_velocity
        c, s = cos(heading), sin(heading)
        vx, vy, omega = c * world.x + s * world.y, c * world.y - s * world.x, world.angular
    elif kind == "wheel_velocity":
        wheels = robot.move_command.wheel_velocity
        vx, vy, omega = _from_wheels(
            [wheels.front_left, wheels.back_left, wheels.back_right, wheels.front_right]
        )
    kick = robot.kick_speed
    if kick > 0.0 and robot.kick_angle != 0.0:
        problem = ("NO_CHIP", "the ball cannot fly here; it is kicked along the ground")
        kick *= cos(radians(robot.kick_angle)) if isfinite(robot.kick_angle) else 0.0
    dribbler = robot.dribbler_speed >= _CAREFUL_RPM
    return RobotCommand(vx, vy, omega, kick, KickTrigger.ON_CONTACT, dribbler), problem


def _given(message: Message, name: str) -> float | None:
    """A field's value, None when the packet leaves it out."""
    return float(getattr(message, name)) if message.HasField(name) else None


def _from_wheels(speeds: list[float]) -> tuple[float, float, float]:
    if not all(map(isfinite, speeds)):
        return (float("nan"), 0.0, 0.0)
    vx, vy, omega = (_FROM_WHEELS @ np.array(speeds)).tolist()
    return vx, vy, omega


def _sane(orders: GrSimOrders) -> bool:
    numbers: list[float | None] = []
    for robot in orders.robots:
        numbers += [robot.x, robot.y, robot.heading, robot.vx, robot.vy, robot.omega]
    if orders.ball is not None:
        numbers += [orders.ball.x, orders.ball.y, orders.ball.vx, orders.ball.vy]
    if not all(number is None or isfinite(number) for number in numbers):
        return False
    return all(command.finite() for command in orders.commands.values())


__all__ = [
    "BallTeleport",
    "GrSimOrders",
    "Teleport",
    "bounded",
    "read_control",
    "read_feedback",
    "read_grsim",
    "read_status",
    "read_teleports",
    "write_control",
    "write_grsim",
    "write_grsim_placement",
    "write_teleport",
]
