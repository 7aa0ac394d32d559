from __future__ import annotations

from math import hypot, pi

import pytest

from robobt.motion.pilot import travel_time
from robobt.skills import Intercept
from robobt.skills.ball.intercept import earliest_meeting, meet
from robobt.testing import (
    Trial,
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
from robobt.tree import Status
from robobt.world.ball_model import DEFAULT_BALL
from tests.skills.fixed_world import Alone


def test_the_meeting_is_the_first_point_reached_in_time() -> None:
    me = robot(0.0, -1.0)
    world = frame(me, ball=(-2.0, 0.0, 2.0, 0.0))
    (x, y), time = earliest_meeting(world, me, me.limits, 2.0)
    assert y == pytest.approx(0.0)
    assert x + 2.0 == pytest.approx(DEFAULT_BALL.way_in(time, 2.0, 2.0), abs=0.01)
    # Within 0.15 m of its place behind the meeting point the robot counts as there.
    assert travel_time(hypot(x + 0.1, 1.0) - 0.15, 0.0, me.limits) <= time + 0.01
    earlier = DEFAULT_BALL.way_in(time - 0.1, 2.0, 2.0) - 2.0
    assert travel_time(hypot(earlier + 0.1, 1.0) - 0.15, 0.0, me.limits) > time - 0.1


@pytest.mark.parametrize(
    ("away", "slack", "turns"), [(3.0, 0.0, True), (3.0, 0.35, False), (0.8, 0.35, True)]
)
def test_a_ball_from_afar_need_not_be_faced_exactly(away: float, slack: float, turns: bool) -> None:
    me = robot(heading=0.3)
    order = meet(frame(me, ball=(away, 0.0, -1.0, 0.0)), me, me.limits, 1.0, slack=slack)
    assert (abs(order.omega) > 0.1) is turns


def test_a_sliding_ball_is_met_nearer_than_a_rolling_one() -> None:
    me = robot(0.0, -1.5)
    world = frame(me, ball=(-2.0, 0.0, 4.0, 0.0))
    (rolling, _), _ = earliest_meeting(world, me, me.limits, 4.0)
    (sliding, _), _ = earliest_meeting(world, me, me.limits, 2.6)
    assert sliding < rolling


def test_a_ball_that_cannot_be_met_is_awaited_where_it_leaves() -> None:
    me = robot(-4.0, 2.5)
    (x, y), _ = earliest_meeting(frame(me, ball=(2.0, -2.0, 6.0, 0.0)), me, me.limits, 6.0)
    assert (x, y) == pytest.approx((4.5, -2.0))


def test_it_waits_on_the_line_facing_the_ball() -> None:
    alone = Alone(Intercept())
    me = robot(0.0, 0.0, pi)
    assert alone.tick(frame(me, ball=(-2.0, 0.0, 2.0, 0.0))) is Status.RUNNING
    # In its own frame the robot looks at the ball, so left of it is -y on the field.
    assert abs(alone.command.vy) < 0.01
    alone.tick(frame(robot(0.0, 0.5, pi), ball=(-2.0, 0.0, 2.0, 0.0)))
    assert alone.command.vy > 0.3


def test_it_succeeds_with_the_ball_in_the_mouth() -> None:
    alone, me = Alone(Intercept(settle=0.03)), robot(contact=True)
    ticks = [alone.tick(frame(me, ball=held(me), time=k / 60)) for k in range(3)]
    assert ticks == [Status.RUNNING, Status.RUNNING, Status.SUCCESS]


@pytest.mark.parametrize(
    ("pose", "ball"),
    [
        ((1.0, 0.0, pi), (-2.0, 0.1, 3.0, 0.0)),
        ((0.0, -1.0, 0.0), (-2.5, 0.5, 2.0, 0.0)),
        ((2.0, 1.0, 0.0), (-2.0, -1.0, 5.0, 2.0)),
        ((-1.0, 1.0, 0.0), (-2.0, 0.0, 1.0, 0.0)),
        ((0.0, 0.0, 0.0), (0.5, 0.5, 0.0, 0.0)),
    ],
)
@pytest.mark.parametrize("preset", ["default", "grsim"])
def test_it_takes_balls_that_come_by(preset: str, pose: tuple[float, ...], ball: tuple[float, ...]) -> None:
    intercept = Intercept()
    trial = alone(intercept, pose, ball, settings=preset)  # type: ignore[dict-item]
    trial.run(
        4.0,
        eventually("it has the ball", succeeds(intercept)),
        always("inside the field", inside_the_field),
    )


@pytest.mark.parametrize("ball", [(1.5, 0.0, -0.9, 0.0), (1.2, 0.5, -0.6, -0.2), (2.0, 0.0, -0.5, 0.0)])
def test_a_weak_dribbler_does_not_drive_into_the_ball(ball: tuple[float, float, float, float]) -> None:
    trial = Trial({blue(1): Intercept()}, {blue(1): (0.0, 0.0, 0.0)}, ball, "erforce")
    trial.run(1.5)
    met = next(frame for frame in trial.frames if frame.own[0].ball_contact)
    assert met.own[0].speed < 0.5
