"""A field's parts fit into each other, and its walls stand where its margins say."""

from __future__ import annotations

import pytest

from robobt.world.field import DIVISION_A, DIVISION_B, FieldGeometry


def test_the_margin_is_the_same_all_around_unless_said_otherwise() -> None:
    sizes = {"length": 6.0, "width": 4.0, "goal_width": 0.7, "defense_width": 2.0, "defense_depth": 0.8}
    assert FieldGeometry(**sizes, margin=0.5).goal_line_margin == 0.5
    assert FieldGeometry(**sizes, margin=0.5, goal_line_margin=0.8).outer == (3.8, 2.5)
    assert FieldGeometry.model_validate({**sizes, "margin": 0.4}).outer == (3.4, 2.4)


def test_division_a_has_the_wider_strip_behind_its_goals_that_the_rules_have_from_2026_on() -> None:
    assert DIVISION_A.outer == pytest.approx((6.6, 4.8))
    assert DIVISION_B.outer == pytest.approx((4.8, 3.3))


def test_a_goal_fits_between_line_and_wall() -> None:
    changed = {**DIVISION_A.model_dump(), "goal_depth": 0.5}
    assert FieldGeometry.model_validate(changed).goal_depth == 0.5
    with pytest.raises(ValueError, match=r"goal_depth 0\.5 must not exceed goal_line_margin 0\.3"):
        FieldGeometry.model_validate({**changed, "goal_line_margin": 0.3})


@pytest.mark.parametrize(("field", "distance"), [(DIVISION_A, 8.0), (DIVISION_B, 6.0)], ids=["a", "b"])
def test_the_penalty_mark_is_where_the_rules_have_it(field: FieldGeometry, distance: float) -> None:
    assert field.penalty_distance == distance
