"""Driving into the ball along a line."""

from __future__ import annotations

from math import cos, hypot, sin

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robobt.motion.run_up import RUN_UP_SPEED, run_up
from robobt.testing import robot
from robobt.world import BallState
from tests.skills.fixed_world import moved

PERIOD = 1 / 60


@settings(max_examples=40)
@given(
    back=st.floats(1.2, 2.5),  # from nearer, a ball that rolls is met before any robot can be on its line
    slope=st.floats(-0.7, 0.7),
    facing=st.floats(-3.0, 3.0),
    velocity=st.tuples(st.floats(-1.0, 1.0), st.floats(-0.5, 0.5)),
    rolling=st.tuples(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5)),
)
def test_from_anywhere_behind_it_meets_the_ball_on_the_line(
    back: float,
    slope: float,
    facing: float,
    velocity: tuple[float, float],
    rolling: tuple[float, float],
) -> None:
    c, s = cos(facing), sin(facing)
    along, across = -back, slope * back
    me = robot(c * along - s * across, s * along + c * across, facing, velocity=(*velocity, 0.0))
    ball = BallState(0.0, 0.0, *rolling)
    for _ in range(240):
        me = moved(me, run_up(me, ball, facing, me.limits, PERIOD), PERIOD)
        ball = BallState(ball.x + ball.vx * PERIOD, ball.y + ball.vy * PERIOD, ball.vx, ball.vy)
        dx, dy = ball.x - me.x, ball.y - me.y
        if c * dx + s * dy < 0.1:
            break
    else:
        pytest.fail("it does not get there")
    assert abs(c * dy - s * dx) < 0.035, "the ball meets the mouth"


def test_on_the_line_it_meets_the_ball_at_full_run_up_speed() -> None:
    me, ball = robot(-1.0, 0.0), BallState(0.0, 0.0)
    while me.x < -0.12:
        me = moved(me, run_up(me, ball, 0.0, me.limits, PERIOD), PERIOD)
    assert hypot(me.vx, me.vy) == pytest.approx(RUN_UP_SPEED, rel=0.1)


def test_beside_the_line_it_waits_with_the_ball_until_it_is_on_it() -> None:
    beside, on_line = robot(-0.2, 0.15), robot(-0.2, 0.0)
    ball = BallState(0.0, 0.0)
    assert run_up(on_line, ball, 0.0, on_line.limits, PERIOD).vx > 0.5
    command = run_up(beside, ball, 0.0, beside.limits, PERIOD)
    assert command.vx < 0.3
    assert command.vy < -0.5
