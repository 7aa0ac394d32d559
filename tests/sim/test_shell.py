"""The ball on a robot of grSim: pushed and left, in the gaps between the wheels, caught and missed."""

from __future__ import annotations

from math import hypot, pi

import pytest

from robobt.world import DIVISION_B, RobotCommand
from tests.sim.rig import ME, one_robot


def test_a_pushed_ball_rolls_off_when_the_robot_brakes() -> None:
    world = one_robot("grsim", (-2, 0, 0), (-1.5, 0, 0, 0), 1 / 60, DIVISION_B)
    for tick in range(180):
        world.act({ME: RobotCommand(1.5 if tick < 72 else 0.0)})
    me, ball = world.truth().own[0], world.truth().ball
    # Measured in grSim: the robot stands at -0.200 m, the ball was at 0.94 m and still rolled.
    assert me.x == pytest.approx(-0.2, abs=0.02)
    assert ball.x - me.x > 1.1


def test_a_ball_from_the_side_comes_to_rest_between_the_wheels() -> None:
    world = one_robot("grsim", (0, 0, pi / 2), (-0.6, 0, 2.0, 0), 1 / 60, DIVISION_B)
    for _ in range(90):
        world.act({})
    ball = world.truth().ball
    assert ball.speed < 0.01
    # Its centre is 0.07 m from the robot's, nearer than any disc would let it.
    assert hypot(ball.x, ball.y) == pytest.approx(0.07, abs=0.004)


def caught(ahead: float, speed: float) -> bool:
    """Whether a robot that drives over a resting ball has it half a second after."""
    world = one_robot("grsim", (-2, 0, 0), (-2 + ahead, 0, 0, 0), 1 / 60, DIVISION_B)
    while world.truth().ball.x == -2 + ahead:
        world.act({ME: RobotCommand(speed, dribbler=True)})
    for _ in range(6):
        world.act({ME: RobotCommand(speed, dribbler=True)})
    for _ in range(30):
        world.act({ME: RobotCommand(0.8 * speed, omega=-3.0, dribbler=True)})
    return world.truth().own[0].ball_contact


def test_whether_a_fast_robot_gets_the_ball_depends_on_the_instant() -> None:
    # As in grSim, where 20 mm decide at 4 m/s: it looks once a frame, in which the robot drives 67 mm.
    assert all(caught(0.9 + 0.5 + 0.01 * i, 1.0) for i in range(4))
    fast = [caught(2.9 + 0.01 * i, 4.0) for i in range(7)]
    assert any(fast)
    assert not all(fast)
