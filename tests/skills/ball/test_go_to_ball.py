from __future__ import annotations

from math import atan2, hypot, pi

import pytest

from robobt.motion.pilot import travel_time
from robobt.skills import GoToBall, PickUpBall
from robobt.skills.ball.go_to_ball import HANDOVER_DISTANCE, meeting_point
from robobt.testing import (
    alone,
    always,
    blue,
    eventually,
    frame,
    held,
    inside_the_field,
    robot,
    succeeds,
)
from robobt.tree import Sequence, Status
from robobt.world import Frame, RobotLimits
from robobt.world.geometry import wrap_angle
from tests.skills.fixed_world import Alone, shot_at


def test_an_unknown_policy_is_refused_by_name() -> None:
    with pytest.raises(ValueError, match=r"'clever'.*geometric"):
        GoToBall(policy="clever")


def test_an_unknown_approach_is_refused_by_name() -> None:
    with pytest.raises(ValueError, match="'sideways'"):
        GoToBall(approach="sideways")  # type: ignore[arg-type]


def test_it_hands_over_near_the_ball_and_facing_it() -> None:
    assert Alone(GoToBall()).tick(frame(robot(), ball=(0.19, 0.0))) is Status.SUCCESS
    assert Alone(GoToBall()).tick(frame(robot(), ball=(0.21, 0.0))) is Status.RUNNING
    assert Alone(GoToBall()).tick(frame(robot(), ball=(0.0, 0.19))) is Status.RUNNING
    assert Alone(GoToBall()).tick(frame(robot(), ball=held(robot()))) is Status.SUCCESS


def test_once_handed_over_it_stays_so_until_the_ball_has_gone() -> None:
    alone = Alone(GoToBall())
    assert alone.tick(frame(robot(), ball=(0.19, 0.0))) is Status.SUCCESS
    assert alone.tick(frame(robot(), ball=(0.28, 0.0))) is Status.SUCCESS
    assert alone.tick(frame(robot(), ball=(0.31, 0.0))) is Status.RUNNING
    assert alone.tick(frame(robot(), ball=(0.28, 0.0))) is Status.RUNNING


def test_behind_the_target_it_does_not_hand_over_on_the_wrong_side() -> None:
    alone = Alone(GoToBall(approach="behind_target"))
    assert alone.tick(frame(robot(0.19, 0.0, pi), ball=(0.0, 0.0))) is Status.RUNNING
    assert alone.tick(frame(robot(-0.19, 0.0, 0.0), ball=(0.0, 0.0))) is Status.SUCCESS


def test_a_rolling_ball_is_met_ahead() -> None:
    me = robot()
    world = frame(me, ball=(2.0, 0.0, 0.0, 1.0))
    x, y = meeting_point(world, me, me.limits)
    assert x == pytest.approx(2.0)
    assert 0.8 < y < 2.0
    assert meeting_point(frame(me, ball=(2.0, 0.0)), me, me.limits) == (2.0, 0.0)


@pytest.mark.parametrize("ball", [(2.0, 1.0), (-1.0, -2.0), (-3.2, 0.4)])
def test_approach_and_pick_up_cost_little_more_than_the_way(ball: tuple[float, float]) -> None:
    tree = Sequence("win the ball", memory=False, children=[GoToBall(), PickUpBall()])
    trial = alone(tree, (-2.0, 0.0, 1.0), ball=ball)
    end = trial.run(
        4.0,
        eventually("it has the ball", succeeds(tree)),
        always("inside the field", inside_the_field),
    )
    way = hypot(ball[0] + 2.0, ball[1]) - 0.1
    assert end.time < travel_time(way, 0.0, RobotLimits()) + 0.2


@pytest.mark.parametrize("velocity", [(1.0, 0.5), (-1.0, 0.3), (0.0, -1.0)])
def test_it_wins_a_rolling_ball(velocity: tuple[float, float]) -> None:
    tree = Sequence("win the ball", memory=False, children=[GoToBall(), PickUpBall()])
    trial = alone(tree, (-2.0, 0.0, 0.0), ball=(-0.5, 0.3, *velocity))
    trial.run(5.0, eventually("it has the ball", succeeds(tree)))


def test_behind_the_target_it_comes_from_the_far_side_without_moving_the_ball() -> None:
    go = GoToBall(approach="behind_target")
    trial = alone(go, (2.0, 0.5, pi), ball=(1.0, 0.0))
    trial.stores[blue(0)].shot = shot_at(4.5, 0.3)

    def behind(frame: Frame) -> bool:
        me, ball = frame.own[0], frame.ball
        line = atan2(0.3 - ball.y, 4.5 - ball.x)
        return (
            hypot(ball.x - me.x, ball.y - me.y) <= HANDOVER_DISTANCE + 0.01
            and abs(wrap_angle(atan2(ball.y - me.y, ball.x - me.x) - line)) < 0.55
            and abs(wrap_angle(me.heading - line)) < 0.55
        )

    trial.run(
        3.0,
        eventually("it is behind the ball", behind),
        always("the ball lies still", lambda frame: frame.ball.speed == 0.0),
    )


def test_a_ball_at_a_wall_is_taken_from_where_one_can() -> None:
    tree = Sequence("win", memory=False, children=[GoToBall(approach="behind_target"), PickUpBall()])
    trial = alone(tree, (0.0, 0.0, 0.0), ball=(-4.7, 2.0))
    trial.run(4.0, eventually("it has the ball", succeeds(tree)))
