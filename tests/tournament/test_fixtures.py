"""Who meets whom."""

from __future__ import annotations

from robobt.tournament.fixtures import Fixture, fixtures, pairings


def test_everybody_meets_everybody_else_once() -> None:
    assert pairings(["a", "b", "c"]) == [("a", "b"), ("a", "c"), ("b", "c")]


def test_a_gauntlet_is_run_by_all_but_the_one_it_is_against() -> None:
    assert pairings(["a", "old", "b"], "old") == [("a", "old"), ("b", "old")]


def test_each_round_is_played_from_either_side() -> None:
    assert list(fixtures([("a", "b")], 2)) == [
        Fixture("a", "b", 0),
        Fixture("b", "a", 0),
        Fixture("a", "b", 1),
        Fixture("b", "a", 1),
    ]
