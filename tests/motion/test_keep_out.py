from __future__ import annotations

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from robobt.motion.keep_out import keep_out
from robobt.testing import frame, robot
from robobt.world import DIVISION_B, RobotCommand, RobotState
from robobt.world.game import Team
from robobt.world.rules import area_distance
from tests.skills.fixed_world import moved
from tests.skills.refereed import OPEN, STOP

PERIOD = 1 / 60


def drives(me: RobotState, vx: float, vy: float, ticks: int = 90) -> RobotState:
    """The robot, which looks along +x, after it has been told to drive like that with the ball beside it."""
    for _ in range(ticks):
        ball = (me.x, me.y + 0.2)
        me = moved(me, keep_out(frame(me, ball, game=OPEN), me, RobotCommand(vx, vy)), PERIOD)
    return me


def gap(me: RobotState, team: Team) -> float:
    return area_distance(DIVISION_B, team, me.x, me.y)


@pytest.mark.parametrize("speed", [0.5, 1.5, 3.0])
def test_a_defender_stops_before_its_own_area(speed: float) -> None:
    me = drives(robot(-2.8, 0.3), -speed, 0.0)
    assert 0.09 <= gap(me, Team.BLUE) < 0.2


@pytest.mark.parametrize("speed", [0.5, 1.5, 3.0])
def test_an_attacker_stops_before_the_other_area(speed: float) -> None:
    me = drives(robot(2.8, 0.3), speed, 0.0)
    assert 0.09 <= gap(me, Team.YELLOW) < 0.2


def test_it_may_drive_along_the_area() -> None:
    me = drives(robot(-3.38, -0.5), 0.0, 1.0, 30)
    assert me.y > -0.2
    assert me.x == pytest.approx(-3.38, abs=0.02)


def test_who_is_hardly_too_fast_may_speed_up_along_the_area_and_who_is_much_too_fast_only_brakes() -> None:
    along = []
    for inwards in (1.27, 1.6):
        me = robot(-3.0, 0.0, velocity=(-inwards, 0.0, 0.0))
        along.append(keep_out(frame(me, (-3.0, 0.2), game=OPEN), me, RobotCommand(-1.5, 1.5)).vy)
    assert along[0] > 1.2
    assert along[1] == pytest.approx(0.0, abs=1e-9)


def test_who_was_shoved_in_drives_out() -> None:
    assert gap(drives(robot(-3.56, 0.0), 0.0, 0.0), Team.BLUE) >= 0.08


def test_wholly_inside_it_gets_off_the_ball() -> None:
    me = robot(-3.62, 0.0)
    order = keep_out(frame(me, (-3.51, 0.0), game=OPEN), me, RobotCommand(1.0, 0.0))
    assert order.vx < 0.0


def test_where_the_ball_is_far_it_may_cross_the_area() -> None:
    me = robot(-3.38, 0.0)
    assert keep_out(frame(me, (0.0, 0.0), game=OPEN), me, RobotCommand(-2.0, 0.0)).vx == -2.0


def test_a_ball_that_comes_fast_is_near() -> None:
    me = robot(-3.38, 0.0)
    order = keep_out(frame(me, (-2.2, 0.0, -5.0, 0.0), game=OPEN), me, RobotCommand(-2.0, 0.0))
    assert order.vx > -0.5


def test_a_ball_that_the_robot_drives_at_fast_is_near() -> None:
    me = robot(-2.8, 0.0, velocity=(-3.0, 0.0, 0.0))
    order = keep_out(frame(me, (-3.6, 0.0), game=OPEN), me, RobotCommand(-3.0, 0.0))
    assert order.vx > -2.0


def test_in_a_stop_nothing_is_changed() -> None:
    me = robot(-3.38, 0.0)
    assert keep_out(frame(me, (-3.2, 0.0), game=STOP), me, RobotCommand(-2.0, 0.0)).vx == -2.0


@settings(max_examples=200)
@given(
    st.floats(-4.4, 4.4), st.floats(-2.9, 2.9), st.floats(0.0, 0.15), st.floats(-3.0, 3.0), st.floats(-3, 3)
)
@example(x=-3.0, y=1.0, aside=0.0, vx=-1.0, vy=-3.0)  # braking lacked what speeding up along the area took
def test_it_never_drives_in_whatever_it_is_told(
    x: float, y: float, aside: float, vx: float, vy: float
) -> None:
    me = robot(x, y)
    if min(gap(me, Team.BLUE), gap(me, Team.YELLOW)) < 0.11:
        return
    for _ in range(90):
        ball = (me.x, me.y + aside + 0.12)
        me = moved(me, keep_out(frame(me, ball, game=OPEN), me, RobotCommand(vx, vy)), PERIOD)
        assert min(gap(me, Team.BLUE), gap(me, Team.YELLOW)) > 0.07
