from __future__ import annotations

from math import hypot

from robobt.skills import GoToBall, HasBall, PickUpBall
from robobt.testing import alone, eventually, frame, held, robot, succeeds
from robobt.tree import Selector, Sequence, Status
from tests.skills.fixed_world import Alone


def test_it_holds_with_the_ball_in_the_mouth_only() -> None:
    me = robot(1.0, 1.0, 2.0)
    assert Alone(HasBall()).tick(frame(me, ball=held(me))) is Status.SUCCESS
    assert Alone(HasBall()).tick(frame(me, ball=(1.5, 1.0))) is Status.FAILURE


def test_a_robot_that_went_and_took_the_ball_has_it() -> None:
    has_ball = HasBall()
    win = Sequence("win the ball", memory=False, children=[GoToBall(), PickUpBall()])
    tree = Selector("ball", memory=False, children=[has_ball, win])
    trial = alone(tree, (-1.0, 0.0, 0.0))
    end = trial.run(3.0, eventually("it has the ball", succeeds(has_ball)))
    assert hypot(end.ball.x - end.own[0].x, end.ball.y - end.own[0].y) < 0.14
