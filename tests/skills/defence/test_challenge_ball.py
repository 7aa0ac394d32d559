from __future__ import annotations

from math import pi

from robobt.skills.defence.challenge_ball import ChallengeBall
from robobt.testing import held, robot
from robobt.tree import Status
from robobt.world.geometry import distance, wrap_angle
from tests.skills.refereed import OPEN, Drive


def test_it_stands_before_the_holder_and_looks_at_the_ball() -> None:
    holder = robot(1.0, 0.0, pi, number=4, contact=True)
    ball = held(holder)
    end = Drive(ChallengeBall(), robot(-1.0, 1.0, number=1), OPEN, ball, opponents=(holder,)).end
    assert distance(end.position, (ball[0] - 0.27, 0.0)) < 0.02
    assert abs(wrap_angle(end.heading)) < 0.05


def test_there_is_nobody_to_challenge_while_the_ball_is_free_or_ours() -> None:
    me = robot(0.0, 0.0, number=1, contact=True)
    assert Drive(ChallengeBall(), me, OPEN, held(me), seconds=0.1).status is Status.FAILURE
    assert Drive(ChallengeBall(), me, OPEN, (3.0, 0.0), seconds=0.1).status is Status.FAILURE
