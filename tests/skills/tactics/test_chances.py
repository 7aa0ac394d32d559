from __future__ import annotations

from collections.abc import Sequence
from math import atan2, cos, hypot, pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robobt.skills.tactics.chances import (
    aim_of,
    point_worth,
    redirect_angle,
    redirect_kick,
    shot_chance,
)
from robobt.skills.tactics_settings import DEFAULT_TACTICS, TACTICS, applied
from robobt.testing import robot
from robobt.world import DIVISION_B
from robobt.world.ball_model import DEFAULT_BALL
from robobt.world.geometry import wrap_angle
from robobt.world.records import Mover
from tests.skills.tactics.teams import records_of

APPLIED = applied(DEFAULT_TACTICS, DIVISION_B, DEFAULT_BALL).view(TACTICS)[0]
SPEEDS = DEFAULT_TACTICS.shot_speed, DEFAULT_TACTICS.fastest
NOBODY = records_of()


def chance(x: float, y: float, opponents: Sequence[Mover] = NOBODY, delay: float = 0.0) -> float:
    return shot_chance(x, y, delay, opponents, APPLIED).chance


def test_an_open_goal_is_as_good_as_scored_from_nearby() -> None:
    assert chance(3.0, 0.3) > 0.9


def test_it_falls_with_the_distance_and_is_nil_behind_the_goal_line() -> None:
    assert chance(3.0, 0.0) > chance(1.0, 0.0) > chance(-2.0, 0.0) > 0.0
    assert chance(4.6, 0.0) == 0.0


def test_a_goalkeeper_close_by_leaves_nothing() -> None:
    assert chance(3.5, 0.0, records_of(robot(3.7, 0.06), robot(3.7, -0.06))) < 0.1


def test_the_aim_avoids_the_goalkeeper() -> None:
    best = shot_chance(2.5, 0.0, 0.0, records_of(robot(4.3, 0.3)), APPLIED)
    assert best.y < -0.1
    assert best.half_angle > 0.0


def test_a_goalkeeper_on_its_way_is_aimed_behind() -> None:
    moving = records_of(robot(4.3, 0.0, velocity=(0.0, 1.5, 0.0)))
    assert shot_chance(2.5, 0.0, 0.0, moving, APPLIED).y < 0.0


def test_with_time_the_defenders_get_between() -> None:
    aside = records_of(robot(4.2, -0.6), robot(3.4, -0.9))
    assert chance(2.5, 1.0, aside) > chance(2.5, 1.0, aside, delay=1.0)


@given(st.floats(-1.0, 4.0), st.floats(-2.5, 2.5), st.floats(2.0, 4.4), st.floats(-1.0, 1.0))
def test_left_and_right_are_alike(x: float, y: float, ox: float, oy: float) -> None:
    left = chance(x, y, records_of(robot(ox, oy)))
    assert chance(x, -y, records_of(robot(ox, -oy))) == pytest.approx(left, abs=1e-9)
    assert 0.0 <= left <= 1.0


def test_the_angle_of_a_redirect_lies_between_where_it_comes_from_and_the_goal() -> None:
    assert redirect_angle(3.5, 0.0, 2.5, 0.0, 4.5) == pytest.approx(0.0)
    assert redirect_angle(2.5, -2.0, 2.5, 0.0, 4.5) == pytest.approx(pi / 2)


@given(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), st.floats(-1.0, 1.0))
def test_a_ball_kicked_at_the_aim_leaves_where_it_should(vx: float, vy: float, wanted: float) -> None:
    heading = aim_of(cos(wanted), sin(wanted), vx, vy, *SPEEDS)
    sideways = cos(heading) * vy - sin(heading) * vx
    kick = redirect_kick(sideways, *SPEEDS)
    assert abs(wrap_angle(heading + atan2(sideways, kick) - wanted)) < 0.01
    assert hypot(kick, sideways) < DEFAULT_TACTICS.fastest + 1e-9


def test_a_shot_for_which_the_robot_has_to_turn_first_is_worth_less() -> None:
    at_once, turning = (point_worth(x, 0.0, 2.5, 0.0, 0.8, NOBODY, APPLIED) for x in (3.5, 0.5))
    assert at_once > turning + 0.1


def test_the_ball_is_worth_more_near_the_goal_and_away_from_opponents() -> None:
    def worth(x: float, y: float, opponents: Sequence[Mover] = NOBODY) -> float:
        return point_worth(0.0, -2.0, x, y, 0.8, opponents, APPLIED)

    assert worth(2.5, 0.5) > worth(0.5, 0.5) > worth(-3.0, 0.5) > 0.0
    near = records_of(robot(-2.8, 0.6))
    assert worth(-3.0, 0.5, near) < worth(-3.0, 0.5)
    assert hypot(worth(2.5, 0.5), 0.0) <= 1.0
