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
