from __future__ import annotations

from math import atan2, hypot

import pytest

from robobt.skills.aim.aim_upfield import AimUpfield
from robobt.skills.ball.kick_to_target import KickToTarget
from robobt.testing import Trial, always, blue, eventually, frame, robot
from robobt.tree import Sequence, Status
from robobt.world import DIVISION_B, RobotState
from robobt.world.geometry import segment_distance
from tests.skills.fixed_world import Alone

Point = tuple[float, float]


def aim(ball: Point, *opponents: RobotState) -> Point:
    alone = Alone(AimUpfield())
    assert alone.tick(frame(robot(-4.0, -2.9), ball, opponents=opponents)) is Status.SUCCESS
    shot = alone.store.shot
    assert shot is not None
    return shot.target


@pytest.mark.parametrize("ball", [(-3.0, 0.0), (-3.0, 2.0), (0.0, -1.0)], ids=str)
def test_a_free_ball_goes_straight_towards_their_goal(ball: Point) -> None:
    x, y = aim(ball)
    assert atan2(y - ball[1], x - ball[0]) == pytest.approx(atan2(-ball[1], 4.5 - ball[0]))


def test_the_ball_goes_past_opponents_in_the_lane() -> None:
    ball = (-3.0, 0.0)
    opponent = robot(-1.5, 0.0, number=1)
    target = aim(ball, opponent)
    assert segment_distance(opponent.position, ball, target) > 0.3
    assert target[0] > ball[0]


def test_it_takes_the_side_that_is_free() -> None:
    ball = (-3.0, 0.0)
    assert aim(ball, robot(-1.5, 0.0, number=1), robot(-1.7, 0.8, number=2))[1] < 0.0
    assert aim(ball, robot(-1.5, 0.0, number=1), robot(-1.7, -0.8, number=2))[1] > 0.0


@pytest.mark.parametrize("ball", [(4.3, 2.8), (4.3, -2.8), (0.0, 2.8), (-4.3, -2.8)], ids=str)
def test_it_does_not_aim_out_of_the_field(ball: Point) -> None:
    assert DIVISION_B.contains(*aim(ball), tolerance=0.01)


def test_the_kick_wins_ground() -> None:
    tree = Sequence("clear", memory=False, children=[AimUpfield(), KickToTarget(kick_speed=3.0)])
    trial = Trial({blue(1): tree}, {blue(1): (-3.5, 0.5, 0.0)}, ball=(-3.0, 0.0))
    trial.run(
        5.0,
        eventually("the ball is two metres up the field", lambda f: f.ball.x > -1.0),
        always("it stays in the field", lambda f: hypot(f.ball.x, f.ball.y) < 4.0),
    )
