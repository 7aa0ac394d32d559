import pytest
from hypothesis import given
from hypothesis import strategies as st

from robobt.statistics import wilson_interval


def test_known_values_of_the_wilson_interval():
    # Worked out from the closed form with z = 1.959964.
    assert wilson_interval(28, 100) == pytest.approx((0.2014, 0.3749), abs=1e-4)
    assert wilson_interval(25, 25) == pytest.approx((0.8668, 1.0), abs=1e-4)
    assert wilson_interval(0, 25) == pytest.approx((0.0, 0.1332), abs=1e-4)


def test_nothing_is_known_without_trials():
    assert wilson_interval(0, 0) == (0.0, 1.0)


@given(st.integers(0, 500), st.integers(1, 500))
def test_the_interval_holds_the_rate_and_lies_in_zero_to_one(successes: int, trials: int):
    successes = min(successes, trials)
    low, high = wilson_interval(successes, trials)
    assert 0.0 <= low <= successes / trials <= high <= 1.0
    assert high - low > 0.0


@given(st.integers(0, 100))
def test_the_interval_is_symmetric_in_success_and_failure(successes: int):
    low, high = wilson_interval(successes, 100)
    other_low, other_high = wilson_interval(100 - successes, 100)
    assert low == pytest.approx(1.0 - other_high, abs=1e-12)
    assert high == pytest.approx(1.0 - other_low, abs=1e-12)


def test_more_confidence_is_a_wider_interval():
    narrow, wide = wilson_interval(30, 100, 0.9), wilson_interval(30, 100, 0.99)
    assert wide.low < narrow.low < narrow.high < wide.high


@pytest.mark.parametrize(
    ("successes", "trials", "confidence"),
    [(-1, 10, 0.95), (11, 10, 0.95), (1, -2, 0.95), (1, 2, 1.0), (1, 2, 0.0)],
)
def test_impossible_counts_are_refused(successes: int, trials: int, confidence: float):
    with pytest.raises(ValueError, match=r"count|confidence"):
        wilson_interval(successes, trials, confidence)
