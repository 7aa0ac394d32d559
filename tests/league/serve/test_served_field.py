"""The served field obeys commands and teleports of robots that are there, and stops who hears nothing."""

from __future__ import annotations

from math import nan, pi

import pytest

from robobt.league.serve.served_field import COMMAND_TIMEOUT, ServedField, line_up
from robobt.league.wire.commands import BallTeleport, Teleport
from robobt.league.wire.geometry import CAMERA_HEIGHT
from robobt.sim.realism import REALISM
from robobt.sim.settings import SimSettings
from robobt.world.command import CHIP_ANGLE, RobotCommand
from robobt.world.field import DIVISION_A, DIVISION_B, FieldGeometry
from robobt.world.game import Team
from robobt.world.protocol import Placement
from robobt.world.state import BALL_RADIUS, RobotId
from tests.league.served import poses

ME, HER, ABSENT = RobotId(Team.BLUE, 0), RobotId(Team.YELLOW, 5), RobotId(Team.BLUE, 9)


@pytest.fixture
def field() -> ServedField:
    return ServedField(
        DIVISION_B, Placement({ME: (0.0, 0.0, 0.0), HER: (2.0, 1.0, pi)}, (1.0, 0.0, 0.0, 0.0))
    )


def speed(field: ServedField) -> float:
    return next(robot.speed for robot in field.truth().own if robot.id == ME.number)


def drive(field: ServedField, seconds: float, command: RobotCommand | None = None) -> None:
    for _ in range(round(seconds / field.period)):
        if command is not None:
            field.command(ME, command)
        field.step()


@pytest.mark.parametrize("geometry", [DIVISION_A, DIVISION_B], ids=["division_a", "division_b"])
@pytest.mark.parametrize("robots", [0, 1, 6, 16])
def test_teams_line_up_apart_in_their_own_halves(geometry: FieldGeometry, robots: int) -> None:
    placement = line_up(geometry, robots)
    field = ServedField(geometry, placement)
    field.step()
    standing = poses(field)
    assert len(standing) == 2 * robots
    for robot, (x, y, _) in standing.items():
        assert (x < 0.0) == (robot.team is Team.BLUE)
        assert geometry.contains(x, y)
        # Nobody was pushed by anybody.
        assert (x, y) == pytest.approx(placement.robots[robot][:2], abs=1e-6)


def test_a_commanded_robot_drives_and_stops_when_nothing_more_is_heard(field: ServedField) -> None:
    drive(field, 0.3, RobotCommand(0.5))
    assert speed(field) == pytest.approx(0.5)
    assert field.driven()
    drive(field, COMMAND_TIMEOUT + field.period)
    assert not field.driven()
    drive(field, 0.1)
    assert speed(field) == 0.0


def test_robots_that_are_not_there_obey_nobody(field: ServedField) -> None:
    assert not field.command(ABSENT, RobotCommand(1.0))
    assert not field.command(RobotId(Team.BLUE, 4_000_000_000), RobotCommand(1.0))
    assert not field.command(ME, RobotCommand(nan))
    assert set(poses(field)) == {ME, HER}


def test_commands_are_bounded_by_the_robots_limits(field: ServedField) -> None:
    drive(field, 0.7, RobotCommand(50.0))
    assert speed(field) <= field.settings.limits.max_speed + 1e-9


def test_a_robot_is_teleported_with_its_velocity(field: ServedField) -> None:
    assert field.teleport(Teleport(ME, -1.0, 2.0, 1.0, vx=0.5)) is None
    assert poses(field)[ME] == (-1.0, 2.0, 1.0)
    assert speed(field) == 0.5
    assert poses(field)[HER][:2] == (2.0, 1.0)


def test_what_a_teleport_leaves_out_stays(field: ServedField) -> None:
    assert field.teleport(Teleport(ME, x=-1.0)) is None
    assert poses(field)[ME] == (-1.0, 0.0, 0.0)
    assert field.teleport_ball(BallTeleport(y=0.5)) is None
    assert field.truth().ball.position == (1.0, 0.5)


def test_a_robot_leaves_the_field_and_comes_back(field: ServedField) -> None:
    assert field.teleport(Teleport(HER, present=False)) is None
    assert set(poses(field)) == {ME}
    assert field.truth().opponents == ()
    problem = field.teleport(Teleport(HER, present=True))
    assert problem is not None
    assert "full pose" in problem
    assert field.teleport(Teleport(HER, 1.0, 1.0, 0.0, present=True)) is None
    assert poses(field)[HER] == (1.0, 1.0, 0.0)


@pytest.mark.parametrize(("x", "y"), [(99.0, 0.0), (0.0, -99.0), (1e300, 0.0)])
def test_nothing_is_put_beyond_the_walls(field: ServedField, x: float, y: float) -> None:
    assert field.teleport(Teleport(ME, x, y, 0.0)) is not None
    assert field.teleport_ball(BallTeleport(x, y)) is not None
    assert poses(field)[ME] == (0.0, 0.0, 0.0)
    assert field.truth().ball.position == (1.0, 0.0)


def test_a_ball_that_rolls_keeps_more_of_its_speed_than_one_that_slides(field: ServedField) -> None:
    ways = []
    for rolls in (True, False):
        field.teleport_ball(BallTeleport(0.0, -1.0, 2.0, 0.0, rolls=rolls))
        drive(field, 0.5)
        ways.append(field.truth().ball.position[0])
    assert ways[0] > ways[1] + 0.1


def test_a_standing_kick_fires_when_the_ball_arrives_and_is_reported(field: ServedField) -> None:
    for _ in range(90):
        field.command(ME, RobotCommand(1.0, kick_speed=3.0))
        field.step()
        if field.kicked:
            break
    assert field.kicked == [ME]
    assert field.truth().ball.vx == pytest.approx(3.0, abs=0.1)


def test_lost_commands_are_lost_by_chance() -> None:
    lossy = SimSettings(realism=REALISM["none"].model_copy(update={"command_loss": 1.0}))
    field = ServedField(DIVISION_B, Placement({ME: (0.0, 0.0, 0.0)}), lossy)
    drive(field, 0.3, RobotCommand(0.5))
    assert speed(field) == 0.0


def test_the_same_orders_give_the_same_field() -> None:
    ends = []
    for _ in range(2):
        field = ServedField(
            DIVISION_B, line_up(DIVISION_B, 6), SimSettings(realism=REALISM["realistic"]), seed=3
        )
        drive(field, 0.5, RobotCommand(1.0, 0.5, 2.0))
        ends.append(field.truth())
    assert ends[0] == ends[1]


def test_a_placement_outside_the_field_is_one_plain_error() -> None:
    with pytest.raises(ValueError, match="blue 0 cannot be put at"):
        ServedField(DIVISION_B, Placement({ME: (50.0, 0.0, 0.0)}))


def test_a_commanded_chip_flies_and_is_told_as_one(field: ServedField) -> None:
    mouth = field.settings.body.face + BALL_RADIUS
    for angle in (0.0, CHIP_ANGLE):
        drive(field, 0.3)
        field.teleport_ball(BallTeleport(poses(field)[ME][0] + mouth, 0.0, 0.0, 0.0))
        drive(field, field.period, RobotCommand(kick_speed=4.0, kick_angle=angle))
        assert field.kicked == [ME]
        assert field.chipped == ([ME] if angle else [])
        drive(field, 0.1)
        assert (field.truth().ball.z > 0.2) is (angle > 0.0)
        assert field.chipped == []


def test_the_ball_can_be_put_into_the_air(field: ServedField) -> None:
    assert field.teleport_ball(BallTeleport(1.0, 1.0, 0.0, 0.0, z=1.0, vz=2.0)) is None
    ball = field.truth().ball
    assert (ball.z, ball.vz) == (1.0, 2.0)
    assert field.teleport_ball(BallTeleport(1.0, 1.0, 0.0, 0.0, z=1e9)) is None
    assert field.truth().ball.z < CAMERA_HEIGHT
