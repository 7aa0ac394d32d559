from __future__ import annotations

from robobt.skills.ball.fetch_ball import FetchBall
from robobt.testing import alone, always, eventually, frame, robot
from robobt.tree import Status
from tests.skills.fixed_world import Alone


def test_it_pulls_a_ball_from_the_edge_of_the_area_to_the_goal() -> None:
    trial = alone(FetchBall(), (-4.35, 0.0, 0.0), ball=(-3.45, 0.4))
    trial.run(
        12.0,
        eventually("the ball is back", lambda frame: frame.ball.x < -4.05),
        always("out of our goal", lambda frame: frame.ball.x > -4.45),
    )


def test_it_goes_behind_the_ball_first() -> None:
    me = robot(-3.0, 0.0, heading=3.0)
    alone = Alone(FetchBall())
    assert alone.tick(frame(me, (-3.45, 0.0))) is Status.RUNNING
    assert abs(alone.command.vy) > 0.05 * abs(alone.command.vx), "round the ball, not into it"


def test_it_is_done_when_the_ball_lies_before_the_goal() -> None:
    assert Alone(FetchBall()).tick(frame(robot(-4.4, 0.0), (-4.2, 0.1))) is Status.SUCCESS
