"""Blind fields are drawn by their seeds, and scored against what they are."""

from __future__ import annotations

from dataclasses import replace

import pytest

from benchmarks.blind.field import draw_field, swapped
from benchmarks.blind.scores import Score, summed
from robobt.world.game import Team
from robobt.world.state import RobotId


def test_a_seed_fixes_a_field_and_fields_differ() -> None:
    assert draw_field(7) == draw_field(7)
    assert draw_field(7).settings != draw_field(8).settings
    delays = [min(draw_field(seed).whole_delays.values()) for seed in range(50)]
    assert 0.015 < min(delays) < 0.05
    assert max(max(draw_field(seed).whole_delays.values()) for seed in range(50)) < 0.14


def test_swapped_teams_have_each_others_robots() -> None:
    field = draw_field(7)
    other = swapped(field)
    assert other.limits[RobotId(Team.BLUE, 2)] == field.limits[RobotId(Team.YELLOW, 2)]
    assert other.limits != field.limits
    assert swapped(other) == field


def test_scores_count_only_what_was_seen_enough() -> None:
    right = Score("ball", "ball.switch_share", True, 0.01, True)
    wrong = replace(right, error=-0.2, covered=False)
    unseen = replace(wrong, seen=False)
    row = next(row for row in summed([right, wrong, unseen]) if row["kind"] == "ball")
    assert row["figures"] == 3
    assert row["seen"] == 2
    assert row["within"] == pytest.approx(0.5)
    assert row["covered"] == pytest.approx(0.5)
