"""Commands, replacements and status keep their meaning in grSim's packets."""

from __future__ import annotations

from math import atan2, pi

import pytest

from robobt.league.wire.commands import BallTeleport, Teleport
from robobt.league.wire.grsim import read_grsim, read_status, write_grsim, write_grsim_replacement
from robobt.league.wire.messages import Robots_Status, grSim_Packet
from robobt.league.wire.packets import PacketCounts
from robobt.world.command import RobotCommand
from robobt.world.game import Team
from robobt.world.state import RobotId

COMMAND = RobotCommand(1.5, -0.5, 2.0, 4.0, dribbler=True)
YELLOW_3 = RobotId(Team.YELLOW, 3)


def test_a_grsim_command_comes_back_as_it_was() -> None:
    request = read_grsim(write_grsim(Team.YELLOW, {3: COMMAND}, 1.0), PacketCounts())
    assert request is not None
    assert request.commands == {YELLOW_3: COMMAND}


def test_a_grsim_chip_has_a_speed_ahead_and_one_upwards() -> None:
    chip = RobotCommand(kick_speed=5.0, kick_angle=atan2(4.0, 3.0))
    data = write_grsim(Team.YELLOW, {3: chip}, 1.0)
    (robot,) = grSim_Packet.FromString(data).commands.robot_commands
    assert (robot.kickspeedx, robot.kickspeedz) == (pytest.approx(3.0), pytest.approx(4.0))
    request = read_grsim(data, PacketCounts())
    assert request is not None
    read = request.commands[YELLOW_3]
    assert (read.kick_speed, read.kick_angle) == (pytest.approx(5.0), pytest.approx(chip.kick_angle))


def test_every_required_field_of_a_grsim_command_is_set() -> None:
    packet = grSim_Packet.FromString(write_grsim(Team.BLUE, {0: RobotCommand()}, 0.0))
    assert packet.IsInitialized()
    assert len(packet.commands.robot_commands[0].ListFields()) == 8


def test_grsim_places_robots_in_degrees() -> None:
    data = write_grsim_replacement([Teleport(YELLOW_3, 1.0, -2.0, pi / 2, present=True)], None)
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
    request = read_grsim(write_grsim_replacement(robots, ball), PacketCounts())
    assert request is not None
    assert request.teleports[0].heading == pytest.approx(0.5)
    assert [robot.present for robot in request.teleports] == [True, False]
    assert request.ball == ball


def test_grsims_wheels_drive_forward_when_all_push_forward() -> None:
    packet = grSim_Packet.FromString(write_grsim(Team.BLUE, {0: RobotCommand()}, 0.0))
    robot = packet.commands.robot_commands[0]
    robot.wheelsspeed = True
    # Left wheels turn against, right wheels with the sense of their angle.
    speeds = [-1.0 * 0.866, -1.0 * 0.707, 1.0 * 0.707, 1.0 * 0.866]
    robot.wheel1, robot.wheel2, robot.wheel3, robot.wheel4 = (speed / 0.027 for speed in speeds)
    request = read_grsim(packet.SerializeToString(), PacketCounts())
    assert request is not None
    command = request.commands[RobotId(Team.BLUE, 0)]
    assert command.vx == pytest.approx(1.0, abs=0.01)
    assert command.vy == pytest.approx(0.0, abs=0.01)
    assert command.omega == pytest.approx(0.0, abs=0.05)


def test_a_status_tells_who_has_the_ball() -> None:
    status = Robots_Status()
    status.robots_status.add(robot_id=4, infrared=True, flat_kick=False, chip_kick=False)
    assert read_status(status.SerializeToString(), PacketCounts()) == {4: True}
