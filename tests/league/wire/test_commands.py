"""Commands are limited before they are sent."""

from __future__ import annotations

from math import hypot

import pytest

from robobt.league.wire.commands import clamp_command
from robobt.sim.robot_settings import KickerSettings
from robobt.world.command import CHIP_ANGLE, RobotCommand
from robobt.world.limits import RobotLimits


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
