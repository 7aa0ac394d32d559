"""Matches of any number of robots a side, and how their results are told."""

from __future__ import annotations

from dataclasses import replace

import pytest

from benchmarks.any_number import figures_of, with_robots
from robobt.tournament.standings import Encounter

_WON = Encounter("a", "b", 6, 3, 2, 1, 9, 4, 0.8, None, None, 2, 1, 1.0, 1.0)


@pytest.mark.parametrize("count", range(1, 12))
def test_each_side_has_a_goalkeeper_and_so_many_robots(count: int) -> None:
    scenario = with_robots(count)
    for side in (scenario.robots.blue, scenario.robots.yellow):
        assert len(side) == count
        assert [robot.goalkeeper for robot in side] == [True] + [False] * (count - 1)
    assert scenario.field.length == (9.0 if count <= 6 else 12.0)


def test_results_are_those_of_the_play_that_was_asked_for() -> None:
    own, other = figures_of(_WON, "a"), figures_of(_WON, "b")
    assert (own["won"], own["drawn"], own["lost"]) == (3, 2, 1)
    assert (own["goals_for"], own["goals_against"]) == (9, 4)
    assert own["decided"] == 0.75
    assert own["low"] < 0.75 < own["high"]
    assert (other["won"], other["lost"], other["goals_for"], other["decided"]) == (1, 3, 4, 0.25)


def test_draws_decide_nothing() -> None:
    drawn = figures_of(replace(_WON, won=0, drawn=6, lost=0), "a")
    assert (drawn["decided"], drawn["low"], drawn["high"]) == (None, None, None)
