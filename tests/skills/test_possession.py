"""Who has the ball."""

from __future__ import annotations

from math import cos, pi, radians, sin

import pytest

from robobt.skills.possession import REACH, carries, has_ball, owner
from robobt.world import BallState, RobotId, Team
from tests.skills.fixed_world import frame, held, robot


@pytest.mark.parametrize("heading", [0.0, 1.0, -2.5, pi])
def test_a_ball_in_the_mouth_is_had(heading: float) -> None:
    me = robot(1.0, -1.0, heading)
    assert has_ball(me, BallState(*held(me)))


def test_the_sensor_is_believed_wherever_the_ball_is_seen() -> None:
    assert has_ball(robot(contact=True), BallState(1.0, 1.0))


@pytest.mark.parametrize(
    ("degrees", "expected"), [(0, True), (44, True), (-44, True), (46, False), (180, False)]
)
def test_only_a_ball_ahead_counts(degrees: float, expected: bool) -> None:
    angle = radians(degrees)
    assert has_ball(robot(), BallState(0.11 * cos(angle), 0.11 * sin(angle))) is expected


def test_a_ball_out_of_reach_is_not_had() -> None:
    assert has_ball(robot(), BallState(REACH - 0.001, 0.0))
    assert not has_ball(robot(), BallState(REACH + 0.001, 0.0))


def test_nobody_owns_a_free_ball() -> None:
    assert owner(frame(robot(), ball=(2.0, 0.0))) is None


def test_the_owner_is_named_with_its_team() -> None:
    me, opponent = robot(number=3), robot(1.0, 0.0, pi, number=4)
    assert owner(frame(me, ball=held(me), opponents=(opponent,))) == RobotId(Team.BLUE, 3)
    assert owner(frame(me, ball=held(opponent), opponents=(opponent,))) == RobotId(Team.YELLOW, 4)
    assert owner(frame(me, ball=held(me), team=Team.YELLOW)) == RobotId(Team.YELLOW, 3)


def test_of_two_that_have_it_the_nearer_owns_it() -> None:
    near, far = robot(0.0, 0.0, 0.0, number=1), robot(0.22, 0.0, pi, number=2)
    assert owner(frame(near, ball=(0.1, 0.0), opponents=(far,))) == RobotId(Team.BLUE, 1)
    assert owner(frame(near, ball=(0.12, 0.0), opponents=(far,))) == RobotId(Team.YELLOW, 2)


def test_a_ball_is_carried_while_it_moves_along_and_no_longer_once_kicked() -> None:
    me = robot(velocity=(1.5, 0.0, 0.0))
    x, y = held(me)
    assert carries(me, BallState(x, y, 1.5, 0.2))
    assert not carries(me, BallState(x, y, 6.0, 0.0))
    assert not carries(me, BallState(x + 0.5, y, 1.5, 0.0))
