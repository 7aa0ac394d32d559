from __future__ import annotations

from math import hypot, pi

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robobt.skills.defence.close_down import CloseDown
from robobt.testing import frame, robot
from robobt.tree import Status
from robobt.world import RobotState
from tests.skills.fixed_world import Alone, moved


def settled(
    ball: tuple[float, float], *opponents: RobotState, me: RobotState | None = None, **parameters: float
) -> RobotState:
    me = me or robot(-4.4, 0.0)
    alone = Alone(CloseDown(**parameters))  # type: ignore[arg-type]
    for _ in range(180):
        alone.tick(frame(me, ball, opponents=opponents))
        me = moved(me, alone.command, 1 / 60)
    return me


def kicker(heading: float, x: float = -1.4, y: float = 0.0) -> RobotState:
    return robot(x, y, heading=heading, contact=True)


def test_it_comes_out_of_its_area_as_far_as_it_may() -> None:
    me = settled((1.5, 0.0), stand_out=2.0)
    assert (me.x, me.y) == pytest.approx((-2.5, 0.0), abs=0.02)


def test_it_keeps_off_the_ball() -> None:
    me = settled((-2.5, 0.0), gap=0.6)
    assert me.x == pytest.approx(-3.1, abs=0.02)


def test_where_it_hides_the_whole_goal_it_goes_no_farther() -> None:
    me = settled((1.5, 0.0), stand_out=9.0)
    # The goal is 1 m wide and 6 m away, hull and ball 0.223 m.
    assert me.x == pytest.approx(1.5 - 6.0 * 0.223, abs=0.02)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_it_stands_on_the_line_of_the_aim(side: float) -> None:
    me = settled((-1.5, 0.0), kicker(pi - side * 0.1), stand_out=1.5)
    assert me.y == pytest.approx(side * 0.15, abs=0.02)


def test_who_points_beside_the_goal_does_not_draw_it_away() -> None:
    assert settled((-1.5, 0.0), kicker(pi - 0.5), stand_out=1.5).y == pytest.approx(0.0, abs=0.02)


def test_a_ball_behind_the_line_is_not_covered() -> None:
    assert Alone(CloseDown()).tick(frame(robot(-4.3, 0.0), (-4.6, 1.0))) is Status.FAILURE


@settings(max_examples=20)
@given(st.floats(-4.0, 1.5), st.floats(-2.0, 2.0))
def test_it_is_always_nearer_to_the_goal_than_the_ball(x: float, y: float) -> None:
    me = settled((x, y))
    assert hypot(me.x + 4.5, me.y) < hypot(x + 4.5, y) + 0.1
