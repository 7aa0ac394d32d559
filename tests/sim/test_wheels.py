"""grSim's wheels slip: turning and driving share their grip, and abrupt commands cost the heading."""

from __future__ import annotations

from math import hypot

import pytest

from robobt.sim import preset
from robobt.sim.robot_settings import WheelSettings
from robobt.world import RobotCommand
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


def test_a_robot_stands_still_in_the_end() -> None:
    world = one_robot("grsim", period=1 / 60)
    for _ in range(30):
        world.act({ME: RobotCommand(1.0, 0.5, 3.0)})
    for _ in range(60):
        world.act({})
    me = world.truth().own[0]
    assert me.speed < 1e-3
    assert abs(me.omega) < 1e-3
