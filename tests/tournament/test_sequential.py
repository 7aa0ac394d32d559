"""The sequential test: as soon as the evidence is enough, and no more often wrong than stated."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize

from robobt.tournament.fixtures import Fixture
from robobt.tournament.played import PlayedMatch
from robobt.tournament.ratings import expected_score
from robobt.tournament.sequential import SCORES, RunningTest, SequentialTest, Verdict
from tests.tournament.made_up import played

TEST = SequentialTest(0.0, 30.0)


def best_with_mean(counts: np.ndarray, mean: float) -> float:
    """The greatest log-likelihood of the counts by any distribution with this mean, found by brute force."""
    found = minimize(
        lambda logits: -counts @ np.log(np.exp(logits) / np.exp(logits).sum()),
        np.zeros(5),
        constraints={
            "type": "eq",
            "fun": lambda logits: (np.exp(logits) / np.exp(logits).sum()) @ SCORES - mean,
        },
        options={"maxiter": 1000, "ftol": 1e-12},
    )
    assert found.success
    return float(-found.fun)


@pytest.mark.parametrize("counts", [(10, 20, 40, 25, 15), (1, 2, 3, 30, 60), (40, 3, 9, 3, 40)])
def test_the_ratio_is_that_of_the_best_distributions_with_either_mean(counts: tuple[int, ...]) -> None:
    seen = np.array(counts, dtype=float)
    wanted = best_with_mean(seen, expected_score(30.0)) - best_with_mean(seen, expected_score(0.0))
    assert float(TEST.ratio(seen)) == pytest.approx(wanted, abs=0.01)


def test_both_points_of_view_agree() -> None:
    counts = np.array([10, 20, 40, 25, 15])
    turned = SequentialTest(-30.0, 0.0)
    assert float(TEST.ratio(counts)) == pytest.approx(-float(turned.ratio(counts[::-1])), abs=1e-9)


def test_counts_are_judged_one_or_many() -> None:
    counts = np.array([[1, 2, 3, 4, 5], [5, 4, 3, 2, 1]])
    assert TEST.ratio(counts) == pytest.approx([float(TEST.ratio(one)) for one in counts])


def test_the_bounds_are_walds() -> None:
    assert SequentialTest(0, 30, alpha=0.01, beta=0.2).bounds == pytest.approx(
        (-1.599388, 4.382027), abs=1e-6
    )


def test_it_stops_at_the_first_bound_that_is_reached() -> None:
    verdict, rounds, ratio = TEST.judge([1.0] * 100)
    assert verdict is Verdict.BETTER
    assert TEST.judge([1.0] * rounds + [0.0] * 500) == (verdict, rounds, ratio)
    assert TEST.judge([1.0] * (rounds - 1))[0] is Verdict.UNDECIDED
    assert TEST.judge([0.0] * 100)[0] is Verdict.NOT_BETTER
    assert TEST.judge([]) == (Verdict.UNDECIDED, 0, 0.0)


@pytest.mark.parametrize(
    ("given", "problem"),
    [
        ((30.0, 0.0), "elo0 must be below elo1"),
        ((5.0, 5.0), "elo0 must be below elo1"),
        ((0.0, float("inf")), "both within ±1000, not 0 and inf"),
        ((0.0, 30.0, float("nan")), "alpha must lie between"),
        ((0.0, 30.0, 0.5), "alpha must lie between"),
        ((0.0, 30.0, 0.05, 0.0), "beta must lie between"),
    ],
)
def test_what_cannot_be_tested_is_refused(given: tuple[float, ...], problem: str) -> None:
    with pytest.raises(ValueError, match=problem):
        SequentialTest(*given)


def rounds(number: int, first: float = 1.0) -> list[PlayedMatch]:
    """Rounds that the first wins from either side, or loses."""
    goals = (1, 0) if first == 1.0 else (0, 1)
    return [
        match
        for at in range(number)
        for match in (played("new", "old", at, goals), played("old", "new", at, goals[::-1]))
    ]


class TestRunning:
    def test_rounds_count_up_to_the_first_that_is_still_played(self) -> None:
        running, matches = RunningTest(SequentialTest(0, 300), "new", "old"), rounds(100)
        assert running.enough(matches)
        needed = running.rounds
        assert not running.enough([match for match in matches if match.fixture != ("old", "new", 1)])
        assert running.rounds == 1
        assert running.enough(matches[: 2 * needed])
        assert not running.enough(matches[: 2 * needed - 1])

    def test_a_round_that_could_not_be_played_is_left_out(self) -> None:
        running = RunningTest(SequentialTest(0, 300), "new", "old")
        missing = Fixture("old", "new", 1)
        matches = [match for match in rounds(100) if match.fixture != missing]
        assert running.enough(matches, [missing])
        assert running.verdict is Verdict.BETTER

    def test_rounds_that_repeat_one_another_are_one(self) -> None:
        running = RunningTest(SequentialTest(0, 300), "new", "old")
        same = [
            played(blue, yellow, number, goals, trace=blue)
            for number in range(100)
            for blue, yellow, goals in (("new", "old", (1, 0)), ("old", "new", (0, 1)))
        ]
        assert not running.enough(same)
        assert running.rounds == 1

    def test_who_loses_is_not_better(self) -> None:
        running = RunningTest(SequentialTest(0, 300), "new", "old")
        assert running.enough(rounds(100, 0.0))
        assert running.line().startswith("Sequential test: new is not better than old after ")
        assert running.to_json()["verdict"] == "not better"
