"""Robots move within their limits."""

from __future__ import annotations

from math import hypot

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robobt.sim import preset
from robobt.world import RobotCommand, RobotLimits
from tests.sim.rig import ME, one_robot

# Measured in the running simulators: time to 90 % of 1.5 m/s forward and sideways, and to brake from it [s].
MEASURED = {"grsim": (0.333, 0.383, 0.367), "rsim": (0.425, 0.575, 0.400), "erforce": (0.215, 0.315, 0.195)}


@pytest.mark.parametrize("name", MEASURED)
def test_a_preset_speeds_up_and_brakes_as_measured(name: str) -> None:
    forward, sideways, brake = MEASURED[name]
    for command, expected in ((RobotCommand(vx=1.5), forward), (RobotCommand(vy=1.5), sideways)):
        world = one_robot(name)
        late = 0.005 if name == "erforce" else 0.0
        while world.truth().own[0].speed < 1.35:
            world.act({ME: command})
        assert world.time - late == pytest.approx(expected, rel=0.10)
    world = one_robot(name, pose=(-4, 0, 0))
    while world.truth().own[0].speed < 1.499:
        world.act({ME: RobotCommand(vx=1.5)})
    start = world.time
    while world.truth().own[0].speed > 0.001:
        world.act({})
    assert world.time - start - late == pytest.approx(brake, rel=0.10)


# Commands of 60 ms each on all axes at once, and where a robot of ER-Force's simulator then was: time [s],
# place from the start [m] and heading [rad].
UNSTEADY = (
    (-0.45, 0.31, -0.73),
    (1.74, -0.29, -1.11),
    (-0.68, 1.38, -1.01),
    (1.93, -1.54, -2.44),
    (0.04, 1.04, -1.66),
    (1.59, -0.71, -3.28),
    (1.69, -1.23, -1.35),
    (0.63, 1.10, -1.68),
    (2.03, -2.21, -0.67),
    (1.09, -1.76, -0.47),
    (2.19, 0.99, -0.50),
    (1.29, -2.37, -0.96),
)
WENT = {0.30: (-0.051, 0.027, -0.377), 0.60: (0.069, -0.142, -0.834), 0.72: (0.142, -0.281, -0.914)}


def test_robots_of_erforce_follow_each_axis_by_itself_as_measured() -> None:
    world = one_robot("erforce", pose=(0, 0, 0), period=0.03)
    for k in range(24):
        vx, vy, omega = UNSTEADY[k // 2]
        world.act({ME: RobotCommand(vx, vy, omega)})
        expected = WENT.get(round(world.time, 2))
        if expected is not None:
            me = world.truth().own[0]
            x, y, heading = expected
            # With limits that share an ellipse it is 6, 15 and 19 cm off.
            assert hypot(me.x - x, me.y - y) < 0.03
            assert me.heading == pytest.approx(heading, abs=0.06)


def test_axes_with_limits_of_their_own_do_not_wait_for_each_other() -> None:
    limits = RobotLimits(
        acceleration=3, braking=6, side_acceleration=2, side_braking=4, max_speed=9, separate_axes=True
    )
    world = one_robot(limits=limits, period=0.02)
    for _ in range(10):
        world.act({ME: RobotCommand(vx=5.0, vy=5.0)})
    me = world.truth().own[0]
    assert (me.vx, me.vy) == pytest.approx((0.6, 0.4))
    # One brakes while the other speeds up.
    for _ in range(5):
        world.act({ME: RobotCommand(vx=-5.0, vy=5.0)})
    me = world.truth().own[0]
    assert (me.vx, me.vy) == pytest.approx((0.0, 0.6))


@settings(max_examples=30)
@given(
    vx=st.floats(-10, 10),
    vy=st.floats(-10, 10),
    omega=st.floats(-50, 50),
    heading=st.floats(-3.1, 3.1),
)
def test_no_command_drives_a_robot_beyond_its_limits(
    vx: float, vy: float, omega: float, heading: float
) -> None:
    limits = RobotLimits(
        max_speed=2, acceleration=3, braking=4, side_acceleration=2, side_braking=3, max_turn=8
    )
    world = one_robot(pose=(0, 0, heading), limits=limits, ball=(5.9, 4.4, 0, 0))
    before = world.truth().own[0]
    for _ in range(60):
        world.act({ME: RobotCommand(vx, vy, omega)})
        now = world.truth().own[0]
        assert now.speed <= 2 + 1e-9
        assert abs(now.omega) <= 8 + 1e-9
        assert hypot(now.vx - before.vx, now.vy - before.vy) <= 4 * world.period + 1e-9
        assert abs(now.omega - before.omega) <= limits.turn_acceleration * world.period + 1e-9
        before = now


def test_commands_are_in_the_robots_own_frame() -> None:
    world = one_robot(pose=(0, 0, 1.5707963267948966))
    for _ in range(200):
        world.act({ME: RobotCommand(vx=1.0)})
    me = world.truth().own[0]
    assert me.vy == pytest.approx(1.0, abs=1e-6)
    assert me.vx == pytest.approx(0.0, abs=1e-6)
    assert me.y > 0.5


def test_a_robot_without_a_command_brakes_to_rest() -> None:
    world = one_robot()
    for _ in range(100):
        world.act({ME: RobotCommand(vx=1.0, omega=3.0)})
    for _ in range(200):
        world.act({})
    me = world.truth().own[0]
    assert (me.speed, me.omega) == (0.0, 0.0)


def test_a_command_delay_shifts_the_effect_and_nothing_else() -> None:
    realism = preset("default").realism
    delayed = preset("default", realism=realism.model_copy(update={"command_delay": 0.040}))
    world, late = one_robot(period=0.025), one_robot(delayed, period=0.025)
    speeds, late_speeds = [], []
    for _ in range(30):
        world.act({ME: RobotCommand(vx=1.5)})
        late.act({ME: RobotCommand(vx=1.5)})
        speeds.append(world.truth().own[0].vx)
        late_speeds.append(late.truth().own[0].vx)
    # 40 ms are one period of 25 ms and three sub-steps of 5 ms.
    acceleration = world.settings.limits.acceleration
    assert late_speeds[0] == 0.0
    for prompt, slow in zip(speeds, late_speeds, strict=True):
        assert (
            slow == pytest.approx(max(0.0, min(1.5, prompt - 0.040 * acceleration)), abs=1e-9)
            or prompt == 1.5
        )
    assert late_speeds[-1] == pytest.approx(1.5)
