"""A ball in a robot's mouth moves with the robot."""

from __future__ import annotations

from math import pi

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robobt.league.estimate.ball_track import BallMotion
from robobt.league.estimate.possession import CarriedBall, Possession
from robobt.league.estimate.robot_track import RobotMotion
from robobt.sim.robot_settings import BodySettings
from robobt.world.game import Team
from robobt.world.state import BALL_RADIUS, RobotId


@given(heading=st.floats(-pi, pi), omega=st.floats(-5.0, 5.0))
def test_a_carried_ball_circles_the_robot_that_turns(heading: float, omega: float) -> None:
    hold, step = CarriedBall(RobotId(Team.BLUE, 2), 0.1, 0.02), 1e-5
    ball = hold.ball(RobotMotion(1.0, 0.5, heading, 0.3, -0.2, omega))
    then = hold.ball(RobotMotion(1.0 + 0.3 * step, 0.5 - 0.2 * step, heading + omega * step))
    assert ((then.x - ball.x) / step, (then.y - ball.y) / step) == pytest.approx((ball.vx, ball.vy), abs=1e-4)


def test_a_sensor_may_be_silent_for_a_moment_while_the_ball_is_at_the_mouth() -> None:
    body, me, still = BodySettings(), RobotId(Team.BLUE, 2), RobotMotion(0.0, 0.0, 0.0)
    watched, mouth = Possession(body), body.face + BALL_RADIUS
    watched.hear([(me, True)], 1.0)
    watched.hear([(me, False)], 1.05)
    assert watched.has_ball(me, still, BallMotion(mouth + 0.015, 0.0))
    assert not watched.has_ball(me, still, BallMotion(mouth + 0.04, 0.0))
    watched.hear([(me, False)], 1.1)
    assert not watched.has_ball(me, still, BallMotion(mouth + 0.015, 0.0))
