"""Sequential tests of entrants of known strength."""

from __future__ import annotations

import numpy as np
import pytest

from benchmarks.simulated_tests import round_chances, simulate
from robobt.tournament.ratings import expected_score
from robobt.tournament.sequential import SCORES, SequentialTest


@pytest.mark.parametrize("elo", [-200.0, 0.0, 30.0, 60.0])
@pytest.mark.parametrize(("draws", "spread"), [(0.0, 0.0), (0.25, 100.0), (0.6, 300.0)])
def test_rounds_score_what_the_strength_says(elo: float, draws: float, spread: float) -> None:
    chances = round_chances(elo, draws, spread)
    assert chances.sum() == pytest.approx(1.0)
    assert chances @ SCORES == pytest.approx(expected_score(elo), abs=1e-9)


def test_without_draws_a_round_scores_a_half_or_all_or_nothing() -> None:
    assert round_chances(0.0, 0.0, 0.0) == pytest.approx([0.25, 0.0, 0.5, 0.0, 0.25])


def test_uneven_starts_make_rounds_more_alike() -> None:
    even, uneven = round_chances(0.0, 0.25, 0.0), round_chances(0.0, 0.25, 300.0)
    assert uneven @ (SCORES - 0.5) ** 2 < even @ (SCORES - 0.5) ** 2


@pytest.mark.integration
@pytest.mark.parametrize(("draws", "spread"), [(0.25, 100.0), (0.0, 0.0)])
def test_a_test_errs_no_more_often_than_it_states(draws: float, spread: float) -> None:
    test = SequentialTest(0.0, 150.0)
    for elo in (0.0, 150.0):
        found = simulate(test, elo, 1000, 2000, np.random.default_rng(7), draws, spread)
        wrong = found.better if elo == 0.0 else found.not_better
        # 5 % of 1 000, and three standard errors.
        assert wrong <= 70
        assert found.better + found.not_better == 1000


def test_a_test_that_is_cut_short_is_undecided() -> None:
    found = simulate(SequentialTest(0.0, 30.0), 15.0, 20, 10, np.random.default_rng(1))
    assert (found.better, found.not_better, found.mean_rounds) == (0, 0, 10.0)


def test_the_seed_fixes_the_figures() -> None:
    first, again = (
        simulate(SequentialTest(0.0, 100.0), 100.0, 50, 300, np.random.default_rng(3)) for _ in range(2)
    )
    assert first == again
