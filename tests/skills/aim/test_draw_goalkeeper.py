from math import atan2

from robobt.skills.aim.draw_goalkeeper import DrawGoalkeeper
from robobt.testing import alone, always, eventually, frame, held, robot
from robobt.tree import Status
from tests.skills.fixed_world import Alone

ME = robot(3.2, 0.0, contact=True)
POST = atan2(0.43, 4.5 - 3.2)


def test_it_points_at_one_post_and_then_at_the_other_and_keeps_the_ball():
    trial = alone(DrawGoalkeeper(), (3.2, 0.0, 0.1), ball=(3.298, 0.0))
    trial.run(
        4.0,
        eventually("it points at the left post", lambda frame: abs(frame.own[0].heading - POST) < 0.08),
        eventually("it points at the right post", lambda frame: abs(frame.own[0].heading + POST) < 0.08),
        always("it has the ball", lambda frame: frame.own[0].ball_contact or frame.time < 0.2),
    )


def test_it_begins_with_the_post_that_is_nearer_to_its_heading():
    for heading, turns in ((0.1, 1.0), (-0.1, -1.0)):
        me = robot(3.2, 0.0, heading, contact=True)
        alone = Alone(DrawGoalkeeper())
        assert alone.tick(frame(me, held(me))) is Status.RUNNING
        assert alone.command.omega * turns > 0.0
        assert alone.command.dribbler


def test_without_the_ball_it_fails():
    assert Alone(DrawGoalkeeper()).tick(frame(robot(3.2, 0.0), (0.0, 0.0))) is Status.FAILURE


def test_its_patience_ends_even_when_it_is_interrupted_for_a_moment():
    alone = Alone(DrawGoalkeeper(patience=1.0))
    for time in (0.0, 0.5, 1.0):
        assert alone.tick(frame(ME, held(ME), time=time)) is Status.RUNNING
    assert alone.tick(frame(ME, held(ME), time=1.1)) is Status.FAILURE
    assert alone.tick(frame(ME, held(ME), time=1.2)) is Status.FAILURE
    # Long after that it is another attack.
    assert alone.tick(frame(ME, held(ME), time=9.0)) is Status.RUNNING
