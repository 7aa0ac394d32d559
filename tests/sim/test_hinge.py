"""Two robots that hold the same ball, beside what grSim does with them."""

from __future__ import annotations

from math import hypot, pi

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robobt.sim import SimWorld, preset
from robobt.sim.hinge import take_hold, tie
from robobt.sim.parameters import wheel_parameters
from robobt.sim.records import BODY, WHEEL_DRIVE
from robobt.world import DIVISION_B, BallState, Placement, RobotCommand, RobotState
from robobt.world.command import KickTrigger
from tests.sim.rig import IT, ME

PERIOD = 1 / 60
MOUTH = 0.0805 + 0.0215

number = st.floats(-1.0, 1.0)


class FaceToFace:
    """One robot has the ball, and another comes up from the other side and takes hold of it too."""

    def __init__(self) -> None:
        self.world = SimWorld(DIVISION_B, {ME: None, IT: None}, preset("grsim"), PERIOD)
        apart = MOUTH + 0.004
        self.world.reset(Placement({ME: (-apart, 0.0, 0.0), IT: (apart + 0.02, 0.0, pi)}, (0, 0, 0, 0)), 0)
        self.drive(0.75, RobotCommand(vx=0.02, dribbler=True), RobotCommand(vx=0.1, dribbler=True))

    def drive(self, seconds: float, mine: RobotCommand, its: RobotCommand) -> None:
        for _ in range(round(seconds / PERIOD)):
            self.world.act({ME: mine, IT: its})

    def see(self) -> tuple[RobotState, RobotState, BallState]:
        frame = self.world.truth()
        return frame.own[0], frame.opponents[0], frame.ball


def gap(robot: RobotState, ball: BallState) -> float:
    return hypot(robot.x - ball.x, robot.y - ball.y)


HOLD = RobotCommand(dribbler=True)
BACK = RobotCommand(vx=-1.0, dribbler=True)


@pytest.mark.parametrize("its", [HOLD, BACK], ids=["alone", "both"])
def test_neither_gets_away_with_the_ball_by_backing_off(its: RobotCommand) -> None:
    # grSim: 2 mm in 1.5 s.
    two = FaceToFace()
    before = two.see()
    two.drive(1.5, BACK, its)
    for was, now in zip(before, two.see(), strict=True):
        assert hypot(now.x - was.x, now.y - was.y) < 0.03
    me, it, ball = two.see()
    assert gap(me, ball) < MOUTH + 0.015 > gap(it, ball)


def test_both_turn_about_the_ball() -> None:
    # grSim: 3.1 rad/s at a command of 4, with the ball at rest between them.
    two = FaceToFace()
    turn = RobotCommand(omega=4.0, dribbler=True)
    two.drive(0.5, turn, turn)
    (me, it, ball), seen = two.see(), []
    for _ in range(60):
        two.drive(PERIOD, turn, turn)
        seen.append(two.see()[0].omega)
    after = two.see()[2]
    assert np.mean(seen) == pytest.approx(3.1, rel=0.1)
    assert hypot(after.x - ball.x, after.y - ball.y) < 0.05
    assert abs(me.omega - it.omega) < 0.3


def test_a_kick_does_not_free_the_ball_from_the_other() -> None:
    two = FaceToFace()
    two.drive(1.0, RobotCommand(kick_speed=2.0, kick_trigger=KickTrigger.ON_CONTACT), HOLD)
    _, it, ball = two.see()
    assert ball.speed < 0.05
    assert gap(it, ball) < MOUTH + 0.015


def test_whoever_lets_go_leaves_the_ball_to_the_other() -> None:
    # grSim: the other is 0.85 m away after 1 s.
    two = FaceToFace()
    two.drive(1.0, RobotCommand(), BACK)
    me, it, ball = two.see()
    assert gap(it, ball) < MOUTH + 0.015
    assert gap(me, ball) == pytest.approx(0.96, abs=0.05)


@given(st.lists(number, min_size=6, max_size=6), st.lists(number, min_size=6, max_size=6), number, number)
def test_a_tie_conserves_momentum_and_stops_the_parting(
    one: list[float], other: list[float], x: float, y: float
) -> None:
    rows, drives = np.array([one, other]), np.zeros(2, WHEEL_DRIVE)
    bodies, w = rows.view(BODY)[:, 0], wheel_parameters(preset("grsim").wheels)[()]
    ball = np.array((x, y, 0.0, 0.0, 0.0, 0.0), BODY)[()]
    for body, hinge in zip(bodies, drives["hinge"], strict=True):
        take_hold(ball, body, hinge)

    def momentum() -> np.ndarray:
        linear = w["mass"] * rows[:, 3:5].sum(axis=0)
        orbit = w["mass"] * (rows[:, 0] * rows[:, 4] - rows[:, 1] * rows[:, 3]) + w["inertia"] * rows[:, 5]
        return np.array([*linear, orbit.sum()])

    def energy() -> float:
        return float((w["mass"] * rows[:, 3:5] ** 2).sum() + (w["inertia"] * rows[:, 5] ** 2).sum())

    before, had = momentum(), energy()
    tie(bodies, drives, 0, w, 1 / 300)
    assert momentum() == pytest.approx(before, abs=1e-9)
    assert energy() <= had + 1e-9
    arms = np.array([x, y]) - rows[:, :2]
    at_ball = rows[:, 3:5] + rows[:, 5:6] * np.stack((-arms[:, 1], arms[:, 0]), axis=1)
    assert at_ball[0] == pytest.approx(at_ball[1], abs=1e-6)
