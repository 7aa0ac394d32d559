"""The ball slides, then rolls, as the closed form of the two-phase model says."""

from __future__ import annotations

from math import hypot

import pytest

from robobt.sim import PRESETS, preset
from robobt.sim.settings import BallSettings
from tests.sim.rig import HUGE, holding, kick, one_robot


def closed_form(ball: BallSettings, speed: float) -> tuple[float, float]:
    """Distance [m] and time [s] until a ball kicked at ``speed`` without spin rests."""
    switch = ball.switch_share * speed
    distance = (speed**2 - switch**2) / (2 * ball.slide_deceleration) + switch**2 / (
        2 * ball.roll_deceleration
    )
    time = (speed - switch) / ball.slide_deceleration + switch / ball.roll_deceleration
    return distance, time


@pytest.mark.integration
@pytest.mark.parametrize("name", sorted(PRESETS))
@pytest.mark.parametrize("speed", [1.0, 3.0, 6.5])
@pytest.mark.parametrize("period", [0.005, 1 / 60])
def test_a_kicked_ball_rolls_as_far_and_as_long_as_the_closed_form(
    name: str, speed: float, period: float
) -> None:
    settings = preset(name)
    distance, time = closed_form(settings.ball, speed)
    world = one_robot(settings, pose=(-24.5, 0, 0), ball=(0, 0, 0, 0), period=period, field=HUGE)
    gap = settings.body.face + 0.0215 + 0.0003
    world.place_ball(-24.5 + gap, 0)
    # Only as far as the field is long; the closed form then gives the speed there.
    kick(world, speed)
    kicked = world.time - period
    x0 = -24.5 + gap
    while world.truth().ball.speed > 0 and world.truth().ball.x - x0 < 45:
        world.act({})
    ball = world.truth().ball
    if ball.speed == 0:
        assert ball.x - x0 == pytest.approx(distance, rel=0.01)
        assert world.time - kicked == pytest.approx(time, abs=0.01 * time + period)
    else:
        rolled = ball.x - x0
        assert ball.speed**2 == pytest.approx(
            2 * settings.ball.roll_deceleration * (distance - rolled), rel=0.01
        )


def test_a_ball_placed_with_a_velocity_rolls_from_the_start() -> None:
    world = one_robot(ball=(-5, 4, 2.0, 0))
    world.act({})
    roll = world.settings.ball.roll_deceleration
    assert world.truth().ball.vx == pytest.approx(2.0 - roll * world.period, abs=1e-9)


def test_friction_never_turns_a_ball_nor_speeds_it_up() -> None:
    world = one_robot(ball=(-5, -4, 3.0, 1.5))
    last = world.truth().ball.speed
    while last > 0.0:
        world.act({})
        ball = world.truth().ball
        assert ball.speed <= last
        if ball.speed > 0.02:
            assert ball.vy / ball.vx == pytest.approx(0.5, abs=1e-9)
        last = ball.speed
        if ball.x > 5 or ball.y > 4:
            break


def test_a_slow_ball_comes_to_rest_and_stays() -> None:
    world = one_robot(ball=(-5, 4, 0.2, 0))
    while world.truth().ball.speed > 0.0:
        world.act({})
    rest = world.truth().ball.position
    for _ in range(100):
        world.act({})
    assert world.truth().ball.position == rest


MEASURED = {
    # Speed after a 5 m/s kick, measured in the running simulators.
    "grsim": {0.01: 4.895, 0.05: 4.468, 0.1: 3.953, 0.2: 3.430, 0.5: 3.220, 1.0: 2.870},
    "erforce": {0.01: 4.97, 0.05: 4.81, 0.1: 4.58, 0.2: 4.20, 0.5: 3.21, 1.0: 3.03},
}


@pytest.mark.parametrize("name", MEASURED)
def test_the_ball_slows_as_measured_in_the_simulator_it_stands_for(name: str) -> None:
    world = holding(name)
    kick(world, 5.0)
    kicked = world.time - world.period
    for time, speed in MEASURED[name].items():
        while world.time < kicked + time - 1e-9:
            world.act({})
        ball = world.truth().ball
        assert hypot(ball.vx, ball.vy) == pytest.approx(speed, rel=0.03), f"after {time} s"


@pytest.mark.parametrize(
    ("velocity", "path"),
    [
        (
            (5.4773, -2.4682),
            [(0.0895, -0.0393), (0.2599, -0.1095), (0.4190, -0.1694), (0.5666, -0.2270), (0.8931, -0.3697)],
        ),
        (
            (4.8026, -3.4103),
            [(0.0783, -0.0550), (0.2264, -0.1566), (0.3631, -0.2470), (0.4884, -0.3278), (0.7691, -0.5251)],
        ),
        (
            (5.1136, 3.1008),
            [(0.0834, 0.0499), (0.2418, 0.1413), (0.3887, 0.2215), (0.5243, 0.2942), (0.8256, 0.4738)],
        ),
    ],
)
def test_a_kicked_ball_slides_aside_as_in_the_real_grsim(
    velocity: tuple[float, float], path: list[tuple[float, float]]
) -> None:
    # Seen 1, 3, 5, 7 and 12 frames after kicks by a robot. A straight way would end 41 to 45 mm beside.
    world = one_robot("grsim", pose=(-3, -2, 0), ball=(0, 0, *velocity), period=1 / 60)
    seen = []
    for _ in range(12):
        world.act({})
        seen.append(world.truth().ball.position)
    for tick, (x, y) in zip((1, 3, 5, 7, 12), path, strict=True):
        assert hypot(seen[tick - 1][0] - x, seen[tick - 1][1] - y) < 0.004
