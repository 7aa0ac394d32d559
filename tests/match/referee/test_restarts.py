"""Where the ball is put for a restart."""

from __future__ import annotations

import pytest

from robobt.match.referee.restarts import corner_kick, free_kick_spot, goal_kick, penalty
from robobt.world import DIVISION_A, DIVISION_B, FieldGeometry, Team


@pytest.mark.parametrize("field", [DIVISION_A, DIVISION_B], ids=["a", "b"])
@pytest.mark.parametrize("x_share", [-1.1, -0.95, -0.6, 0.0, 0.8, 1.0])
@pytest.mark.parametrize("y_share", [-1.1, -0.5, 0.0, 0.1, 0.9, 1.0])
def test_a_free_kick_is_off_the_lines_and_the_defence_areas(
    field: FieldGeometry, x_share: float, y_share: float
) -> None:
    x, y = free_kick_spot(field, x_share * field.half_length, y_share * field.half_width)
    assert abs(x) <= field.half_length - 0.2 + 1e-9
    assert abs(y) <= field.half_width - 0.2 + 1e-9
    beyond_front = field.half_length - field.defense_depth - abs(x)
    beyond_side = abs(y) - field.defense_width / 2
    assert max(beyond_front, beyond_side) >= 1.0 - 1e-9


def test_on_a_narrow_field_a_free_kick_moves_out_before_the_area() -> None:
    narrow = FieldGeometry(**{**DIVISION_B.model_dump(), "width": 3.8})
    x, y = free_kick_spot(narrow, -3.9, 0.9)
    assert abs(y) <= narrow.half_width - 0.2
    assert x == pytest.approx(-(narrow.half_length - narrow.defense_depth - 1.0))


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_ball_over_a_goal_line_comes_back_near_the_corner_where_it_left(side: float) -> None:
    y = side * (DIVISION_B.half_width - 0.2)
    assert corner_kick(DIVISION_B, Team.BLUE, side).spot == pytest.approx((DIVISION_B.half_length - 0.2, y))
    assert goal_kick(DIVISION_B, Team.YELLOW, side).spot == pytest.approx((DIVISION_B.half_length - 1.0, y))
    assert goal_kick(DIVISION_B, Team.BLUE, side).spot == pytest.approx((1.0 - DIVISION_B.half_length, y))


def test_a_penalty_is_taken_six_metres_from_the_goal_of_nine() -> None:
    assert penalty(DIVISION_B, Team.BLUE).spot == pytest.approx((DIVISION_B.half_length - 6.0, 0.0))
    assert penalty(DIVISION_A, Team.YELLOW).spot == pytest.approx((8.0 - DIVISION_A.half_length, 0.0))
