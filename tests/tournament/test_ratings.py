"""Ratings: strengths under which the results are likely, on the Elo scale."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from robobt.tournament.ratings import bradley_terry, expected_score


def test_four_hundred_points_are_odds_of_ten_to_one() -> None:
    assert expected_score(0.0) == 0.5
    assert expected_score(400.0) == pytest.approx(10 / 11)


def test_two_entrants_are_as_far_apart_as_their_score_says() -> None:
    ratings = bradley_terry("ab", [("a", "b", 1.0)] * 7500 + [("a", "b", 0.0)] * 2500, "b")
    assert ratings["a"].elo == pytest.approx(190.85, abs=0.2)
    assert (ratings["b"].elo, ratings["b"].low, ratings["b"].high) == (0.0, 0.0, 0.0)
    # The interval of a proportion of 0.75 in 10 000 matches, in Elo.
    half = 400 / np.log(10) * 1.96 / np.sqrt(10_000 * 0.75 * 0.25)
    assert ratings["a"].high - ratings["a"].elo == pytest.approx(half, rel=0.01)


def test_a_draw_is_half_a_win() -> None:
    wins = bradley_terry("ab", [("a", "b", 1.0), ("a", "b", 0.0)] * 10)
    draws = bradley_terry("ab", [("a", "b", 0.5)] * 20)
    assert wins["a"].elo == pytest.approx(draws["a"].elo, abs=1e-9)
    assert wins["a"].elo == pytest.approx(0.0, abs=1e-9)


def test_who_wins_all_is_rated_finitely_and_widely() -> None:
    ratings = bradley_terry("ab", [("a", "b", 1.0)] * 10)
    assert 200.0 < ratings["a"].elo - ratings["b"].elo < 1000.0
    assert ratings["a"].high - ratings["a"].low > 150.0


def test_ratings_do_not_depend_on_which_side_is_named_first() -> None:
    results = [("a", "b", 1.0), ("b", "c", 0.5), ("a", "c", 0.0), ("a", "b", 0.0), ("c", "b", 1.0)]
    turned = [(second, first, 1.0 - score) for first, second, score in results]
    one, other = bradley_terry("abc", results), bradley_terry("abc", turned)
    for name in "abc":
        assert one[name].elo == pytest.approx(other[name].elo, abs=1e-8)


def test_the_mean_is_zero_without_a_reference() -> None:
    ratings = bradley_terry("abc", [("a", "b", 1.0), ("b", "c", 1.0), ("a", "c", 1.0)])
    assert sum(rating.elo for rating in ratings.values()) == pytest.approx(0.0, abs=1e-8)
    assert ratings["a"].elo > ratings["b"].elo > ratings["c"].elo


def test_whoever_has_not_played_has_no_strength_yet() -> None:
    ratings = bradley_terry("abc", [("a", "b", 1.0)])
    assert ratings["c"].low < -300.0
    assert ratings["c"].high > 300.0


def test_intervals_hold_the_truth_as_often_as_they_say() -> None:
    rng = np.random.default_rng(5)
    truth = {"a": 0.0, "b": 60.0, "c": 150.0, "d": -80.0}
    mean, held, trials = sum(truth.values()) / 4, 0, 300
    for _ in range(trials):
        results = [
            (one, other, float(rng.random() < expected_score(truth[one] - truth[other])))
            for one, other in combinations(truth, 2)
            for _ in range(40)
        ]
        ratings = bradley_terry(list(truth), results)
        held += sum(ratings[name].low <= truth[name] - mean <= ratings[name].high for name in truth)
    # 0.95 less three standard errors of 1 200 intervals, which depend on each other.
    assert 0.92 < held / (4 * trials) < 0.985


@pytest.mark.parametrize("result", [("a", "x", 1.0), ("a", "b", 1.5)])
def test_what_is_no_score_is_refused(result: tuple[str, str, float]) -> None:
    with pytest.raises(ValueError, match="is not a score"):
        bradley_terry("ab", [result])
