"""The simulation protocol: robot control and its feedback, teleports.

At this edge a dribbler spins in turns a minute, and angles of kicks are degrees.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from math import cos, degrees, radians, sin

from robobt.league.wire.commands import (
    BallTeleport,
    Request,
    Teleport,
    known_robots,
    optional,
    velocity_from_wheels,
)
from robobt.league.wire.messages import RobotCommand as RobotCommandMessage
from robobt.league.wire.messages import RobotControl, RobotControlResponse, SimulatorCommand
from robobt.league.wire.packets import MAX_OBJECTS, PacketCounts, read
from robobt.world.command import KickTrigger, RobotCommand
from robobt.world.game import Team
from robobt.world.state import RobotId

_DRIBBLER_RPM = 1500.0
"""Speed of a dribbler that is on [rpm]; ER-Force's roller does 150 rad/s."""

_STRAIGHT_UP = 90.0
"""Kicks leave at less than this from the ground [deg]."""

_MIN_RPM = 1.0
"""A dribbler slower than this is off [rpm]."""

TEAMS = {1: Team.YELLOW, 2: Team.BLUE}
"""Teams by their numbers in the protocol."""

_TEAM_NUMBERS = {team: number for number, team in TEAMS.items()}


def write_control(commands: Mapping[int, RobotCommand]) -> bytes:
    """Return the packet with the commands of a team's robots, by number.

    Without commands it is the empty message, which serves as a keep-alive.
    """
    packet = RobotControl()
    for number, command in commands.items():
        robot = packet.robot_commands.add(id=number)
        local = robot.move_command.local_velocity
        local.forward, local.left, local.angular = command.vx, command.vy, command.omega
        if command.kick_speed > 0.0:
            robot.kick_speed = command.kick_speed
            robot.kick_angle = degrees(command.kick_angle)
        robot.dribbler_speed = _DRIBBLER_RPM if command.dribbler else 0.0
    return bytes(packet.SerializeToString())


def write_teleport(robots: Iterable[Teleport], ball: BallTeleport | None) -> bytes:
    """Return the packet that teleports robots and ball."""
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
        put.x, put.y, put.z = ball.x or 0.0, ball.y or 0.0, ball.z
        put.vx, put.vy, put.vz = ball.vx or 0.0, ball.vy or 0.0, ball.vz
        if ball.rolls and (ball.vx or ball.vy):
            # Only where it matters: grSim answers this field with an error.
            put.roll = True
    return bytes(packet.SerializeToString())


def read_feedback(data: bytes, counts: PacketCounts) -> dict[int, bool]:
    """Return whether each robot in a control response has the ball in its break-beam sensor, by number."""

    def convert(message: RobotControlResponse) -> dict[int, bool] | None:
        known = [robot for robot in message.feedback if robot.HasField("dribbler_ball_contact")]
        return known_robots({robot.id: robot.dribbler_ball_contact for robot in known})

    return read(RobotControlResponse, data, counts, convert) or {}


def read_control(
    data: bytes, team: Team, headings: Mapping[int, float], counts: PacketCounts
) -> Request | None:
    """Return the commands of a control packet, or None (counted) when it is malformed or implausible.

    ``headings``, those of the team's robots, convert velocities given in field coordinates [rad].
    """

    def convert(message: RobotControl) -> Request | None:
        if len(message.robot_commands) > MAX_OBJECTS:
            return None
        request = Request()
        for robot in message.robot_commands:
            if robot.kick_speed > 0.0 and not 0.0 <= robot.kick_angle < _STRAIGHT_UP:
                problem = f"no kick has an angle of {robot.kick_angle:g} degrees; it is left out"
                request.errors.append(("KICK_ANGLE", problem))
            request.commands[RobotId(team, robot.id)] = _command(robot, headings.get(robot.id, 0.0))
        return request if request.finite() else None

    return read(RobotControl, data, counts, convert)


def _command(robot: RobotCommandMessage, heading: float) -> RobotCommand:
    vx = vy = omega = 0.0
    move = robot.move_command
    kind = move.WhichOneof("command")
    if kind == "local_velocity":
        local = move.local_velocity
        vx, vy, omega = local.forward, local.left, local.angular
    elif kind == "global_velocity":
        world = move.global_velocity
        c, s = cos(heading), sin(heading)
        vx, vy, omega = c * world.x + s * world.y, c * world.y - s * world.x, world.angular
    elif kind == "wheel_velocity":
        wheels = move.wheel_velocity
        vx, vy, omega = velocity_from_wheels(
            [wheels.front_left, wheels.back_left, wheels.back_right, wheels.front_right]
        )
    # NaN compares as false.
    possible = 0.0 <= robot.kick_angle < _STRAIGHT_UP
    kick, angle = (robot.kick_speed, radians(robot.kick_angle)) if possible else (0.0, 0.0)
    dribbles = robot.dribbler_speed >= _MIN_RPM
    return RobotCommand(vx, vy, omega, kick, KickTrigger.ON_CONTACT, dribbles, angle)


def read_teleports(message: SimulatorCommand) -> Request | None:
    """Return the teleports of a simulator command; None when it is implausible."""
    control, config = message.control, message.config
    repeated = (control.teleport_robot, config.robot_specs, config.realism_config.custom)
    if max(map(len, repeated)) > MAX_OBJECTS:
        return None
    request = Request()
    for robot in control.teleport_robot:
        team = TEAMS.get(int(robot.id.team))
        if team is None or not robot.id.HasField("id"):
            continue
        x, y, heading = (optional(robot, name) for name in ("x", "y", "orientation"))
        present = robot.present if robot.HasField("present") else None
        number = RobotId(team, robot.id.id)
        request.teleports.append(
            Teleport(number, x, y, heading, robot.v_x, robot.v_y, robot.v_angular, present)
        )
    if control.HasField("teleport_ball"):
        put = control.teleport_ball
        x, y, vx, vy = (optional(put, name) for name in ("x", "y", "vx", "vy"))
        request.ball = BallTeleport(x, y, vx, vy, put.roll, put.z, put.vz)
    return request if request.finite() else None
