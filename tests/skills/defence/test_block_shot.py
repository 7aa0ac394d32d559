from __future__ import annotations

from math import pi

import pytest

from robobt.motion.pilot import ROBOBULLS_LIMITS
from robobt.skills.defence.block_shot import BlockShot
from robobt.testing import Trial, alone, blue, eventually, frame, goal_for, robot
from robobt.tree import Status
from robobt.world import DIVISION_B, RobotLimits, RobotState, Team
from tests.skills.fixed_world import Alone, moved

TARGET = (-4.41, 0.3)
BALL = (-2.0, 0.3)


def after(seconds: float, skill: BlockShot) -> RobotState:
    me = robot(-4.35, -0.3)
    alone = Alone(skill, target=TARGET)
    for _ in range(round(60 * seconds)):
        alone.tick(frame(me, BALL))
        me = moved(me, alone.command, 1 / 60)
    return me


def test_it_gets_onto_the_line_and_faces_the_ball() -> None:
    me = after(1.5, BlockShot())
    assert me.y == pytest.approx(0.3, abs=0.01)
    assert me.heading == pytest.approx(0.0, abs=0.03)


def test_it_takes_the_shortest_way_to_the_line() -> None:
    assert after(1.5, BlockShot()).x == pytest.approx(-4.35, abs=0.02)


def test_at_half_speed_it_gets_less_far() -> None:
    fast, slow = (
        after(0.8, BlockShot(limits=ROBOBULLS_LIMITS)),
        after(0.8, BlockShot(limits=ROBOBULLS_LIMITS, speed_factor=0.3)),
    )
    assert slow.y < fast.y - 0.05
    assert abs(slow.vy) <= 0.3 * ROBOBULLS_LIMITS.max_speed + 1e-6


def test_it_fails_without_a_target() -> None:
    assert Alone(BlockShot()).tick(frame(robot(-4.3, 0.0), BALL)) is Status.FAILURE


def test_it_catches_with_the_dribbler_unless_told_otherwise() -> None:
    for dribbler in (True, False):
        alone = Alone(BlockShot(dribbler=dribbler), target=TARGET)
        alone.tick(frame(robot(-4.3, 0.0), BALL))
        assert alone.command.dribbler is dribbler


def test_it_stops_a_slow_ball() -> None:
    trial = alone(BlockShot(), (-4.3, 0.0, 0.0), ball=(-2.5, 0.3, -2.0, 0.0))
    trial.stores[blue(0)].target = TARGET
    trial.run(3.0, eventually("the ball no longer comes", lambda frame: frame.ball.vx > -0.05))
    assert trial.frames[-1].ball.x > -DIVISION_B.half_length
    assert abs(trial.frames[-1].own[0].heading) < pi / 4


@pytest.mark.parametrize("dive", [True, False])
def test_a_robot_that_brakes_slowly_saves_by_diving_what_it_could_not_otherwise(dive: bool) -> None:
    slow_to_stop = RobotLimits(max_speed=2.25, acceleration=2.5, braking=0.8)
    trial = Trial(
        {blue(0): BlockShot(dive=dive)},
        {blue(0): (-4.35, 0.0, 0.0)},
        ball=(-1.5, 0.0, -6.0, 0.72),
        limits=slow_to_stop,
    )
    trial.stores[blue(0)].target = (-4.41, 0.35)
    trial.run(1.0)
    assert any(map(goal_for(Team.YELLOW), trial.frames)) is not dive


def test_with_time_enough_it_does_not_dive() -> None:
    alone = Alone(BlockShot(), target=TARGET)
    alone.tick(frame(robot(-4.35, -0.1), (0.0, 0.3, -2.0, 0.0)))
    assert "diving" not in alone.tree.feedback_message
    alone.tick(frame(robot(-4.35, -0.3), (-2.0, 0.3, -6.0, 0.0)))
    assert "diving" in alone.tree.feedback_message
