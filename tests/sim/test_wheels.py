"""grSim's wheels slip: turning and driving share their grip, and abrupt commands cost the heading."""

from __future__ import annotations

from math import hypot

import pytest

from robobt.sim import SimWorld, preset
from robobt.sim.robot_settings import WheelSettings
from robobt.world import DIVISION_B, Placement, RobotCommand
from tests.sim.rig import HUGE, ME, one_robot


def test_a_fast_robot_turns_less_than_a_slow_one() -> None:
    turned = {}
    for speed in (0.0, 2.0):
        world = one_robot("grsim", period=1 / 60, pose=(-2, 0, 0))
        for _ in range(60):
            world.act({ME: RobotCommand(speed)})
        for _ in range(18):
            world.act({ME: RobotCommand(speed, omega=10.0)})
        turned[speed] = world.truth().own[0].heading
    # Measured in grSim: 1.97 and 1.24 rad.
    assert turned == {0.0: pytest.approx(1.97, abs=0.05), 2.0: pytest.approx(1.24, abs=0.1)}


def square(acceleration: float | None) -> float:
    """How far off a robot ends that is sent round a square at 2 m/s, a second a side [m]."""
    world = one_robot("grsim", period=1 / 60, field=HUGE)
    now = [0.0, 0.0]
    shift = [0.0, 0.0]
    for tick in range(360):
        goal = ((2, 0), (0, 2), (-2, 0), (0, -2), (0, 0), (0, 0))[tick // 60]
        dx, dy = goal[0] - now[0], goal[1] - now[1]
        share = 1.0 if acceleration is None else min(1.0, acceleration / 60 / max(hypot(dx, dy), 1e-9))
        now = [now[0] + share * dx, now[1] + share * dy]
        shift = [shift[0] + now[0] / 60, shift[1] + now[1] / 60]
        world.act({ME: RobotCommand(now[0], now[1])})
    me = world.truth().own[0]
    return hypot(me.x - shift[0], me.y - shift[1])


def test_abrupt_changes_of_direction_cost_the_way_and_gentle_ones_do_not() -> None:
    # Measured in grSim: 2.8 m off, and 70 mm with commands that change by 2 m/s^2.
    assert square(None) > 1.0
    assert square(2.0) < 0.1


def test_wheels_with_more_grip_follow_better() -> None:
    followed = []
    for grip in (0.8, 3.0):
        wheels = WheelSettings(tangent_friction=grip, torque=2.0)
        world = one_robot(preset("grsim", wheels=wheels), period=1 / 60, pose=(-2, 0, 0))
        for tick in range(78):
            world.act({ME: RobotCommand(2.0, omega=10.0 if tick >= 60 else 0.0)})
        followed.append(world.truth().own[0].heading)
    assert followed[1] > followed[0] + 0.4


def test_a_command_takes_effect_after_a_frame() -> None:
    world = one_robot("grsim", period=1 / 60)
    speeds = []
    for _ in range(3):
        world.act({ME: RobotCommand(1.0)})
        speeds.append(world.truth().own[0].vx)
    assert speeds[0] == pytest.approx(0.0, abs=1e-9)
    # On the way to twice what 4 m/s^2 allow in a frame.
    assert 0.05 < speeds[1] < 0.15


def test_a_command_within_a_frame_takes_effect_when_the_frame_ends() -> None:
    world = one_robot("grsim", period=1 / 120)
    speeds = []
    for tick in range(4):
        world.act({ME: RobotCommand(1.0 if tick > 0 else 0.0)})
        speeds.append(world.truth().own[0].vx)
    assert speeds[1] == pytest.approx(0.0, abs=1e-9)
    assert speeds[3] > 0.05


@pytest.mark.parametrize(
    ("commands", "pose"),
    [
        (
            """2 2.196 2.044 4.013, 4 2.348 1.867 3.708, 4 2.743 -1.215 -1.337, 3 2.399 -1.801 -1.643,
            4 2.547 1.585 1.725, 4 2.762 -1.172 -0.239, 3 2.746 -1.208 -0.126, 4 2.862 0.898 0.435,
            4 2.813 -1.043 -0.103, 3 2.878 -0.843 -0.179, 4 2.868 0.132 0.171, 4 2.781 -0.78 -0.08,
            3 2.734 -0.691 -0.187, 2 2.683 -0.035 0.171""",
            (0.4522, 0.0827, 0.3652),
        ),
        (
            """2 2.179 2.062 4.045, 4 2.3 1.927 3.39, 4 2.917 -0.701 -1.732, 3 2.51 -1.643 -1.598,
            4 2.307 1.918 0.991, 4 2.787 -1.111 -0.323, 3 2.92 -0.688 -0.023, 4 2.582 1.527 0.166,
            4 2.845 -0.952 -0.013, 3 2.924 -0.565 -0.099, 4 2.919 0.372 0.049, 4 2.892 -0.753 0.068,
            3 2.866 -0.504 0.011, 2 2.848 -0.043 0.204""",
            (0.4463, 0.1099, 0.3418),
        ),
    ],
)
def test_a_robot_follows_a_policy_as_in_the_real_grsim(
    commands: str, pose: tuple[float, float, float]
) -> None:
    # From rest for 0.8 s: ticks, then velocity ahead, to the left and turning. While all of the moved load
    # counted for the grip, it ended 0.08 to 0.10 m and 0.11 to 0.17 rad off.
    world = one_robot("grsim", period=1 / 60)
    for words in commands.split(","):
        ticks, vx, vy, omega = map(float, words.split())
        for _ in range(int(ticks)):
            world.act({ME: RobotCommand(vx, vy, omega)})
    me = world.truth().own[0]
    assert hypot(me.x - pose[0], me.y - pose[1]) < 0.045
    assert me.heading == pytest.approx(pose[2], abs=0.08)


def test_the_wheels_of_a_robot_that_is_placed_in_motion_roll() -> None:
    world = SimWorld(DIVISION_B, {ME: None}, preset("grsim"), 1 / 60)
    command = RobotCommand(1.0, 0.5, 1.0)
    world.reset(
        Placement(
            {ME: (0.0, 0.0, 0.5)},
            (3.0, 1.0, 0.0, 0.0),
            velocities={ME: (0.638, 0.918)},
            turning={ME: 1.0},
            commands={ME: command},
        ),
        0,
    )
    world.act({ME: command})
    assert world.truth().own[0].speed == pytest.approx(1.118, abs=0.03)


def test_a_robot_stands_still_in_the_end() -> None:
    world = one_robot("grsim", period=1 / 60)
    for _ in range(30):
        world.act({ME: RobotCommand(1.0, 0.5, 3.0)})
    for _ in range(60):
        world.act({})
    me = world.truth().own[0]
    assert me.speed < 1e-3
    assert abs(me.omega) < 1e-3
