"""Commands and teleports keep their meaning in the simulation protocol's packets."""

from __future__ import annotations

from math import hypot, inf, nan, pi

import pytest

from robobt.league.wire.commands import BallTeleport, Request, Teleport, clamp_command
from robobt.league.wire.grsim import read_grsim, write_grsim, write_grsim_replacement
from robobt.league.wire.messages import MoveGlobalVelocity, MoveWheelVelocity, RobotControl, SimulatorCommand
from robobt.league.wire.packets import PacketCounts
from robobt.league.wire.simulation import read_control, read_teleports, write_control, write_teleport
from robobt.sim.robot_settings import KickerSettings
from robobt.world.command import CHIP_ANGLE, RobotCommand
from robobt.world.game import Team
from robobt.world.limits import RobotLimits
from robobt.world.state import RobotId

COMMAND = RobotCommand(1.5, -0.5, 2.0, 4.0, dribbler=True)
YELLOW_3 = RobotId(Team.YELLOW, 3)


def test_a_protocol_command_comes_back_as_it_was() -> None:
    result = read_control(write_control({3: COMMAND}), Team.YELLOW, {}, PacketCounts())
    assert result is not None
    assert result == Request({YELLOW_3: COMMAND})


def test_keeping_a_port_alive_takes_the_empty_message() -> None:
    assert write_control({}) == b""
    assert read_control(b"", Team.BLUE, {}, PacketCounts()) == Request()


def test_a_velocity_in_field_coordinates_is_turned_into_the_robots() -> None:
    packet = RobotControl()
    robot = packet.robot_commands.add(id=3)
    robot.move_command.global_velocity.CopyFrom(MoveGlobalVelocity(x=0.0, y=1.0, angular=0.5))
    result = read_control(packet.SerializeToString(), Team.YELLOW, {3: pi / 2}, PacketCounts())
    assert result is not None
    command = result.commands[YELLOW_3]
    assert (command.vx, command.vy, command.omega) == (pytest.approx(1.0), pytest.approx(0.0), 0.5)


def test_equal_wheels_turn_on_the_spot() -> None:
    packet = RobotControl()
    wheels = MoveWheelVelocity(front_right=0.9, back_right=0.9, back_left=0.9, front_left=0.9)
    packet.robot_commands.add(id=3).move_command.wheel_velocity.CopyFrom(wheels)
    result = read_control(packet.SerializeToString(), Team.YELLOW, {}, PacketCounts())
    assert result is not None
    assert result.commands[YELLOW_3].omega == pytest.approx(10.0, rel=0.02)


def test_a_chip_has_its_angle_in_degrees() -> None:
    packet = RobotControl.FromString(write_control({3: RobotCommand(kick_speed=4.0, kick_angle=CHIP_ANGLE)}))
    assert packet.robot_commands[0].kick_angle == pytest.approx(45.0)
    assert packet.robot_commands[0].kick_speed == 4.0
    result = read_control(packet.SerializeToString(), Team.YELLOW, {}, PacketCounts())
    assert result is not None
    assert result.commands[YELLOW_3].kick_angle == pytest.approx(CHIP_ANGLE)
    assert not result.errors


@pytest.mark.parametrize("angle", [-10.0, 90.0, nan, inf])
def test_a_kick_at_an_impossible_angle_is_left_out_and_answered_with_an_error(angle: float) -> None:
    packet = RobotControl()
    packet.robot_commands.add(id=3, kick_speed=4.0, kick_angle=angle)
    result = read_control(packet.SerializeToString(), Team.YELLOW, {}, PacketCounts())
    assert result is not None
    assert result.commands[YELLOW_3].kick_speed == 0.0
    assert [code for code, _ in result.errors] == ["KICK_ANGLE"]


def test_teleports_come_back_as_they_were() -> None:
    robots = [Teleport(YELLOW_3, 1.0, -2.0, 0.5, 0.25, 0.5, -1.0, True)]
    ball = BallTeleport(0.25, 0.5, -1.0, 2.0, rolls=True, z=0.5, vz=-1.5)
    message = SimulatorCommand.FromString(write_teleport(robots, ball))
    assert read_teleports(message) == Request(teleports=robots, ball=ball)


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
def test_request_that_are_not_finite_are_dropped_and_counted(value: float) -> None:
    counts = PacketCounts()
    spoiled = RobotCommand(value)
    assert read_grsim(write_grsim(Team.BLUE, {0: spoiled}, 0.0), counts) is None
    assert read_control(write_control({0: spoiled}), Team.BLUE, {}, counts) is None
    placement = write_grsim_replacement([Teleport(YELLOW_3, value, 0.0, 0.0)], None)
    assert read_grsim(placement, counts) is None
    message = SimulatorCommand.FromString(write_teleport([], BallTeleport(0.0, value)))
    assert read_teleports(message) is None
    assert counts.implausible == 3


def test_commands_are_bounded_by_robot_and_rules() -> None:
    limits, kicker = RobotLimits(max_speed=2.0, max_turn=6.0), KickerSettings(max_chip_speed=5.0)
    command = clamp_command(RobotCommand(30.0, -40.0, -100.0, 99.0), limits, kicker)
    assert hypot(command.vx, command.vy) == pytest.approx(2.0)
    assert command.vy / command.vx == pytest.approx(-4 / 3)
    assert (command.omega, command.kick_speed) == (-6.0, 6.5)
    chip = clamp_command(RobotCommand(kick_speed=99.0, kick_angle=CHIP_ANGLE), limits, kicker)
    assert (chip.kick_speed, chip.kick_angle) == (5.0, CHIP_ANGLE)


def test_a_robot_that_reaches_a_part_of_its_commands_may_be_commanded_more() -> None:
    limits = RobotLimits(max_speed=2.0, max_turn=6.0, gain=0.8, side_gain=0.9, turn_gain=0.5)
    command = clamp_command(RobotCommand(30.0, 0.0, 100.0), limits, KickerSettings())
    assert limits.gain * command.vx == pytest.approx(2.0)
    assert limits.turn_gain * command.omega == pytest.approx(6.0)
