from __future__ import annotations

from math import atan2, hypot

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robobt.skills.defence.cover_angle import CoverAngle
from robobt.testing import frame, robot
from robobt.tree import Status
from robobt.world import DIVISION_B, RobotState
from robobt.world.rules import in_own_defense_area
from tests.skills.fixed_world import Alone, moved


def settled(ball: tuple[float, float], **parameters: float) -> RobotState:
    me = robot(-4.3, 0.0)
    alone = Alone(CoverAngle(**parameters))  # type: ignore[arg-type]
    for _ in range(150):
        alone.tick(frame(me, ball))
        me = moved(me, alone.command, 1 / 60)
    return me


def test_before_a_ball_in_the_middle_it_stands_out_in_the_middle() -> None:
    me = settled((-1.0, 0.0))
    assert (me.x, me.y) == pytest.approx((-4.0, 0.0), abs=0.02)


def test_it_leaves_as_much_on_either_side() -> None:
    ball = (-2.0, 1.5)
    me = settled(ball)
    to_me = atan2(me.y - ball[1], me.x - ball[0])
    left = atan2(0.5 - ball[1], -4.5 - ball[0])
    right = atan2(-0.5 - ball[1], -4.5 - ball[0])
    assert abs(to_me - left) == pytest.approx(abs(right - to_me), abs=0.02)


@settings(max_examples=20)
@given(st.floats(-4.4, 4.0), st.floats(-2.9, 2.9))
def test_it_never_asks_to_leave_the_area(x: float, y: float) -> None:
    me = settled((x, y), stand_out=2.0)
    assert in_own_defense_area(DIVISION_B, me.x, me.y, 0.05)


def test_a_ball_behind_the_line_is_not_covered() -> None:
    assert Alone(CoverAngle()).tick(frame(robot(-4.3, 0.0), (-4.6, 1.0))) is Status.FAILURE


def test_close_to_the_ball_it_does_not_drive_into_it() -> None:
    me = settled((-4.2, 0.0))
    assert hypot(me.x + 4.2, me.y) > 0.1


def test_a_new_goalkeeper_goes_round_its_own_wall() -> None:
    wall = tuple(robot(-3.38, y, number=number) for number, y in ((1, -0.1), (2, 0.1)))
    me = robot(-2.5, 0.0)
    alone = Alone(CoverAngle())
    for _ in range(240):
        alone.tick(frame(me, (0.0, 0.0), mates=wall))
        assert min(hypot(me.x - mate.x, me.y - mate.y) for mate in wall) > 2 * 0.09
        me = moved(me, alone.command, 1 / 60)
    assert (me.x, me.y) == pytest.approx((-4.0, 0.0), abs=0.02)
