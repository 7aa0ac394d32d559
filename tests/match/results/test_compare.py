"""Variants compared pair by pair."""

from __future__ import annotations

import pytest

from robobt.match.results.compare import compare_results
from robobt.match.results.results import MatchResult, RobotResult


def trial(number: int, *, goal: bool, kick: float | None = 1.0, trace: str | None = None) -> MatchResult:
    robot = RobotResult(go_to_ball=0.5, shoot=None if kick is None else kick - 0.5)
    outcome = "goal_blue" if goal else "time"
    trace = f"{number}{goal}{kick}" if trace is None else trace
    return MatchResult("s", number, number, outcome, 2.0, int(goal), 0, 1.0, 80, {"blue 0": robot}, trace)


def test_trials_are_paired_by_their_number() -> None:
    first = [trial(n, goal=n < 2) for n in range(10)]
    other = [trial(n, goal=n < 7, kick=None if n == 9 else 1.5 + 0.01 * n) for n in reversed(range(10))]
    found = compare_results({"first": first, "other": other})
    assert found["first"].against_first is None
    against = found["other"].against_first
    assert against is not None
    assert (against.only_this, against.only_first) == (5, 0)
    assert against.p == pytest.approx(0.0625)
    assert against.scored.mean == pytest.approx(0.5)
    assert against.scored.low is not None
    assert 0.0 < against.scored.low < 0.5
    assert against.goals.mean == pytest.approx(0.5)
    assert against.to_ball.mean == 0.0
    assert (against.to_kick.n, against.to_kick.mean) == (9, pytest.approx(0.54))


def test_a_trial_that_only_one_played_is_left_out() -> None:
    found = compare_results({"a": [trial(0, goal=True), trial(1, goal=True)], "b": [trial(1, goal=False)]})
    against = found["b"].against_first
    assert against is not None
    assert (against.scored.n, against.only_first) == (1, 1)
    with pytest.raises(ValueError, match="b has no trial to compare with"):
        compare_results({"a": [trial(0, goal=True)], "b": [trial(1, goal=True)]})


def test_trials_that_repeat_one_another_give_no_interval() -> None:
    first = [trial(n, goal=False, trace="x") for n in range(5)]
    other = [trial(n, goal=True, trace="y") for n in range(5)]
    found = compare_results({"a": first, "b": other})
    assert (found["a"].trials, found["a"].distinct) == (5, 1)
    against = found["b"].against_first
    assert against is not None
    assert against.scored.mean == 1.0
    assert (against.scored.low, against.scored.high, against.to_kick.low) == (None, None, None)


def test_differences_that_are_all_the_same_give_no_interval() -> None:
    trials = [trial(n, goal=n < 2) for n in range(5)]
    against = compare_results({"a": trials, "b": trials})["b"].against_first
    assert against is not None
    assert (against.goals.mean, against.goals.low, against.goals.high) == (0.0, None, None)


def test_failed_trees_are_counted() -> None:
    failing = trial(0, goal=True)
    failing.robots["blue 0"].errors, failing.robots["blue 0"].first_error = 3, "Burst: ValueError"
    found = compare_results({"a": [trial(0, goal=True)], "b": [failing]})
    assert (found["a"].errors, found["a"].first_error) == (0, None)
    assert (found["b"].errors, found["b"].first_error) == (3, "blue 0: Burst: ValueError")


def test_p_is_corrected_for_the_number_of_variants() -> None:
    base = [trial(n, goal=False) for n in range(8)]
    found = compare_results(
        {
            "base": base,
            "much": [trial(n, goal=True) for n in range(8)],
            "little": [trial(n, goal=n < 4) for n in range(8)],
        }
    )
    much, little = found["much"].against_first, found["little"].against_first
    assert much is not None
    assert little is not None
    assert (much.p, much.holm) == (pytest.approx(2 / 256), pytest.approx(4 / 256))
    assert (little.p, little.holm) == (pytest.approx(2 / 16), pytest.approx(2 / 16))
