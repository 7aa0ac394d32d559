"""The dribbler holds the ball up to a limit, and beyond it loses the ball."""

from __future__ import annotations

from math import pi, sqrt

import pytest

from robobt.sim import PRESETS, SimWorld, preset
from robobt.world import BALL_RADIUS, DIVISION_A, DIVISION_B, Placement, RobotCommand
from tests.sim.rig import IT, ME, ball_offset, holding, one_robot, time_lost


def turning(rate: float) -> RobotCommand:
    return RobotCommand(omega=rate, dribbler=True)


@pytest.mark.parametrize(("vx", "vy"), [(1, 0), (-1, 0), (0, 1), (0, -1), (-0.7, 0.7)])
@pytest.mark.parametrize("turn", [2.0, -2.0])
def test_the_default_holds_while_turning_and_accelerating(vx: float, vy: float, turn: float) -> None:
    world = holding()
    speed = 0.0
    while speed < 2.0:
        # 1.5 m/s^2 in a direction that turns with the robot.
        speed += 1.5 * world.period
        world.act({ME: RobotCommand(vx * speed, vy * speed, turn, dribbler=True)})
        assert ball_offset(world)[0] < 0.105, f"lost at {speed:.2f} m/s"
        assert world.truth().own[0].ball_contact


def test_the_default_loses_the_ball_when_turning_faster_than_its_pull() -> None:
    settings = preset("default")
    # A ball on a circle needs w^2 L; the dribbler pulls with at most ``pull``.
    limit = sqrt(settings.dribbler.pull / (settings.body.face + 0.0215))
    assert 6.0 < limit < 7.0
    assert time_lost(holding(), turning(0.9 * limit)) is None
    assert time_lost(holding(), turning(1.15 * limit)) is not None


def test_the_default_loses_the_ball_when_braking_harder_than_its_pull() -> None:
    lost = {}
    for braking in (0.8, 2.0):
        world = holding()
        pull = world.settings.dribbler.pull
        speed = 0.0
        while speed < 2.0:
            speed += 1.5 * world.period
            world.act({ME: RobotCommand(vx=speed, dribbler=True)})
        while speed > 0.0:
            speed = max(0.0, speed - braking * pull * world.period)
            world.act({ME: RobotCommand(vx=speed, dribbler=True)})
        for _ in range(40):
            world.act({ME: RobotCommand(dribbler=True)})
        lost[braking] = ball_offset(world)[0] > 0.12
    assert lost == {0.8: False, 2.0: True}


@pytest.mark.parametrize("rate", [1, 5, 10, 15])
def test_grsim_holds_the_ball_while_turning(rate: float) -> None:
    world = holding("grsim")
    for _ in range(600):
        world.act({ME: turning(rate)})
        distance, angle = ball_offset(world)
        assert distance < 0.113
        assert abs(angle) <= 8


@pytest.mark.parametrize(
    "command", [RobotCommand(2, 0), RobotCommand(-2, 0), RobotCommand(0, 2), RobotCommand(0, -2)]
)
def test_grsim_holds_the_ball_while_driving(command: RobotCommand) -> None:
    command.dribbler = True
    assert time_lost(holding("grsim"), command, 1.5) is None


@pytest.mark.parametrize(("rate", "away"), [(3, 0.1187), (5, 0.1325), (7, 0.1462)])
def test_grsim_loses_the_ball_without_dribbler(rate: float, away: float) -> None:
    world = holding("grsim", period=1 / 60)
    for _ in range(20):
        world.act({ME: RobotCommand(omega=rate)})
    # Measured in grSim a third of a second after the command.
    assert ball_offset(world)[0] == pytest.approx(away, abs=0.008)
    assert not world.truth().own[0].ball_contact


def test_grsim_leaves_the_ball_when_it_backs_away_without_dribbler() -> None:
    assert time_lost(holding("grsim"), RobotCommand(vx=-1.0)) is not None


@pytest.mark.parametrize("rate", [1, 5, 10, 20])
def test_rsim_never_loses_the_ball(rate: float) -> None:
    assert time_lost(holding("rsim"), turning(rate)) is None


def test_rsim_loses_the_ball_without_dribbler_at_any_spin() -> None:
    assert time_lost(holding("rsim"), RobotCommand(omega=5)) is not None


def test_a_stronger_dribbler_wins_the_ball() -> None:
    # Two robots face each other with the ball between; blue backs away and pulls, yellow does not pull.
    settings = preset("default")
    gap = 2 * (settings.body.face + 0.0215 + 0.0003)
    world = SimWorld(DIVISION_A, {ME: None, IT: None}, settings, 0.005)
    start = Placement({ME: (0, 0, 0), IT: (gap, 0, 3.141592653589793)}, (gap / 2, 0, 0, 0))
    world.reset(start, 0)
    for _ in range(200):
        world.act({ME: RobotCommand(vx=-0.4, dribbler=True), IT: RobotCommand()})
    assert world.truth().own[0].ball_contact
    world.reset(start, 0)
    for _ in range(200):
        # Both pull: neither dribbler beats the other, so the ball does not simply follow blue.
        world.act({ME: RobotCommand(vx=-0.4, dribbler=True), IT: RobotCommand(vx=-0.4, dribbler=True)})
    frame = world.truth()
    assert not (frame.own[0].ball_contact and frame.opponents[0].ball_contact)


@pytest.mark.parametrize("speed", [2.0, 4.0])
def test_a_glued_mouth_catches_an_arriving_ball(speed: float) -> None:
    world = holding("grsim")
    world.reset(Placement({ME: (0, 0, 0)}, (1.0, 0, -speed, 0)), 0)
    for _ in range(400):
        world.act({ME: RobotCommand(dribbler=True)})
    assert world.truth().own[0].ball_contact
    assert world.truth().ball.speed < 0.1


@pytest.mark.parametrize("name", sorted(PRESETS))
def test_no_dribbler_carries_the_ball_through_the_side_of_a_goal(name: str) -> None:
    side = DIVISION_B.goal_width / 2
    pose, ball = (DIVISION_B.half_length + 0.02, side + 0.17, -pi / 2), (4.52, side + 0.05, 0, 0)
    world = one_robot(name, pose, ball, field=DIVISION_B)
    for _ in range(200):
        world.act({ME: RobotCommand(5, dribbler=True)})
        # The middle of the wall, from where it would be pushed out on the other side.
        assert world.truth().ball.y > side + 0.01


@pytest.mark.parametrize("name", sorted(PRESETS))
def test_a_ball_that_is_taken_from_the_dribbler_stays_where_it_is_put(name: str) -> None:
    for ticks in range(1, 8):  # grSim's dribbler decides once a frame: at different times in it
        world = holding(name, period=0.007)
        for _ in range(ticks):
            world.act({ME: RobotCommand(dribbler=True)})
        assert world.truth().own[0].ball_contact
        world.place_ball(-1.5, -1.0)
        world.act({ME: RobotCommand(dribbler=True)})
        ball = world.truth().ball
        assert (ball.x, ball.y, ball.speed) == (-1.5, -1.0, 0.0)


@pytest.mark.parametrize("kind", ["default", "grsim", "rsim", "sumatra", "robobulls"])
@pytest.mark.parametrize("backing", [0.0, 0.7, 1.5])
def test_an_arriving_ball_stays_up_to_the_speed_among_the_limits(kind: str, backing: float) -> None:
    world = one_robot(kind, ball=(0.5, 0, 0, 0), period=1 / 60)
    fast = backing + world.settings.limits.receives
    world.reset(Placement({ME: (0, 0, 0)}, (0.5, 0.015, -fast, 0), {ME: (-backing, 0)}), seed=0)
    for _ in range(40):
        world.act({ME: RobotCommand(vx=-backing, dribbler=True)})
    offset, _ = ball_offset(world)
    assert offset < world.settings.body.face + BALL_RADIUS + 0.01
