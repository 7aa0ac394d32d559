"""Commands and placements keep their meaning on the wire, in either form."""

from __future__ import annotations

from math import hypot, inf, nan, pi

import pytest

from robobt.league.wire.commands import (
    BallTeleport,
    Teleport,
    bounded,
    read_control,
    read_grsim,
    read_status,
    read_teleports,
    write_control,
    write_grsim,
    write_grsim_placement,
    write_teleport,
)
from robobt.league.wire.messages import (
    MoveGlobalVelocity,
    MoveWheelVelocity,
    RobotControl,
    Robots_Status,
    SimulatorCommand,
    grSim_Packet,
)
from robobt.league.wire.sockets import PacketCounts
from robobt.world.command import RobotCommand
from robobt.world.game import Team
from robobt.world.limits import RobotLimits
from robobt.world.state import RobotId

COMMAND = RobotCommand(1.5, -0.5, 2.0, 4.0, dribbler=True)
YELLOW_3 = RobotId(Team.YELLOW, 3)


def test_commands_are_bounded_by_robot_and_rules() -> None:
    limits = RobotLimits(max_speed=2.0, max_turn=6.0)
    command = bounded(RobotCommand(30.0, -40.0, -100.0, 99.0), limits, 6.5)
    assert hypot(command.vx, command.vy) == pytest.approx(2.0)
    assert command.vy / command.vx == pytest.approx(-4 / 3)
    assert (command.omega, command.kick_speed) == (-6.0, 6.5)


def test_a_grsim_command_comes_back_as_it_was() -> None:
    orders = read_grsim(write_grsim(Team.YELLOW, {3: COMMAND}, 1.0), PacketCounts())
    assert orders is not None
    assert orders.commands == {YELLOW_3: COMMAND}


def test_every_required_field_of_a_grsim_command_is_set() -> None:
    packet = grSim_Packet.FromString(write_grsim(Team.BLUE, {0: RobotCommand()}, 0.0))
    assert packet.IsInitialized()
    assert len(packet.commands.robot_commands[0].ListFields()) == 8


def test_grsim_places_robots_in_degrees() -> None:
    data = write_grsim_placement([Teleport(YELLOW_3, 1.0, -2.0, pi / 2, present=True)], None)
    (robot,) = grSim_Packet.FromString(data).replacement.robots
    assert (robot.x, robot.y, robot.dir, robot.id, robot.yellowteam, robot.turnon) == (
        1.0,
        -2.0,
        pytest.approx(90.0),
        3,
        True,
        True,
    )


def test_a_grsim_placement_comes_back_as_it_was() -> None:
    robots = [
        Teleport(YELLOW_3, 1.0, -2.0, 0.5, present=True),
        Teleport(RobotId(Team.BLUE, 0), 0.0, 0.0, 0.0),
    ]
    robots[1].present = False
    ball = BallTeleport(0.25, 0.5, -1.0, 2.0)
    orders = read_grsim(write_grsim_placement(robots, ball), PacketCounts())
    assert orders is not None
    assert orders.robots[0].heading == pytest.approx(0.5)
    assert [robot.present for robot in orders.robots] == [True, False]
    assert orders.ball == ball


def test_grsims_wheels_drive_forward_when_all_push_forward() -> None:
    packet = grSim_Packet.FromString(write_grsim(Team.BLUE, {0: RobotCommand()}, 0.0))
    robot = packet.commands.robot_commands[0]
    robot.wheelsspeed = True
    # Left wheels turn against, right wheels with the sense of their angle.
    speeds = [-1.0 * 0.866, -1.0 * 0.707, 1.0 * 0.707, 1.0 * 0.866]
    robot.wheel1, robot.wheel2, robot.wheel3, robot.wheel4 = (speed / 0.027 for speed in speeds)
    orders = read_grsim(packet.SerializeToString(), PacketCounts())
    assert orders is not None
    command = orders.commands[RobotId(Team.BLUE, 0)]
    assert command.vx == pytest.approx(1.0, abs=0.01)
    assert command.vy == pytest.approx(0.0, abs=0.01)
    assert command.omega == pytest.approx(0.0, abs=0.05)


def test_a_protocol_command_comes_back_as_it_was() -> None:
    result = read_control(write_control({3: COMMAND}), Team.YELLOW, {}, PacketCounts())
    assert result is not None
    assert result == ({YELLOW_3: COMMAND}, [])


def test_keeping_a_port_alive_takes_the_empty_message() -> None:
    assert write_control({}) == b""
    assert read_control(b"", Team.BLUE, {}, PacketCounts()) == ({}, [])


def test_a_velocity_in_field_coordinates_is_turned_into_the_robots() -> None:
    packet = RobotControl()
    robot = packet.robot_commands.add(id=3)
    robot.move_command.global_velocity.CopyFrom(MoveGlobalVelocity(x=0.0, y=1.0, angular=0.5))
    result = read_control(packet.SerializeToString(), Team.YELLOW, {3: pi / 2}, PacketCounts())
    assert result is not None
    command = result[0][YELLOW_3]
    assert (command.vx, command.vy, command.omega) == (pytest.approx(1.0), pytest.approx(0.0), 0.5)


def test_equal_wheels_turn_on_the_spot() -> None:
    packet = RobotControl()
    wheels = MoveWheelVelocity(front_right=0.9, back_right=0.9, back_left=0.9, front_left=0.9)
    packet.robot_commands.add(id=3).move_command.wheel_velocity.CopyFrom(wheels)
    result = read_control(packet.SerializeToString(), Team.YELLOW, {}, PacketCounts())
    assert result is not None
    assert result[0][YELLOW_3].omega == pytest.approx(10.0, rel=0.02)


def test_a_chip_is_answered_with_an_error_and_kicked_along_the_ground() -> None:
    packet = RobotControl()
    packet.robot_commands.add(id=3, kick_speed=4.0, kick_angle=60.0)
    result = read_control(packet.SerializeToString(), Team.YELLOW, {}, PacketCounts())
    assert result is not None
    commands, errors = result
    assert commands[YELLOW_3].kick_speed == pytest.approx(2.0)
    assert [code for code, _ in errors] == ["NO_CHIP"]


def test_teleports_come_back_as_they_were() -> None:
    robots = [Teleport(YELLOW_3, 1.0, -2.0, 0.5, 0.25, 0.5, -1.0, True)]
    ball = BallTeleport(0.25, 0.5, -1.0, 2.0, rolls=True)
    message = SimulatorCommand.FromString(write_teleport(robots, ball))
    assert read_teleports(message) == (robots, ball)


def test_the_field_that_grsim_refuses_is_left_out_where_it_does_not_matter() -> None:
    message = SimulatorCommand.FromString(write_teleport([], BallTeleport(0.0, 0.0, 0.0, 0.0, rolls=True)))
    assert not message.control.teleport_ball.HasField("roll")
    assert not message.control.teleport_ball.HasField("teleport_safely")


def test_a_robot_is_taken_off_the_field() -> None:
    message = SimulatorCommand.FromString(write_teleport([Teleport(YELLOW_3, present=False)], None))
    (robot,) = message.control.teleport_robot
    assert not robot.present
    assert not robot.HasField("x")


@pytest.mark.parametrize("value", [nan, inf, -inf])
def test_orders_that_are_not_finite_are_dropped_and_counted(value: float) -> None:
    counts = PacketCounts()
    spoiled = RobotCommand(value)
    assert read_grsim(write_grsim(Team.BLUE, {0: spoiled}, 0.0), counts) is None
    assert read_control(write_control({0: spoiled}), Team.BLUE, {}, counts) is None
    placement = write_grsim_placement([Teleport(YELLOW_3, value, 0.0, 0.0)], None)
    assert read_grsim(placement, counts) is None
    message = SimulatorCommand.FromString(write_teleport([], BallTeleport(0.0, value)))
    assert read_teleports(message) is None
    assert counts.implausible == 3


def test_a_status_tells_who_has_the_ball() -> None:
    status = Robots_Status()
    status.robots_status.add(robot_id=4, infrared=True, flat_kick=False, chip_kick=False)
    assert read_status(status.SerializeToString(), PacketCounts()) == {4: True}
