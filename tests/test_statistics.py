import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy import stats

from robobt.statistics import (
    ReliabilityBin,
    calibration_error,
    clopper_pearson_interval,
    corrected_resampled_t_test,
    mcnemar,
    mean_interval,
    reliability,
    surely_negative,
    wilson_interval,
)


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


@given(st.integers(0, 60), st.integers(1, 60), st.sampled_from([0.8, 0.95, 0.99]))
def test_intervals_of_a_proportion_agree_with_scipy(successes: int, trials: int, confidence: float):
    successes = min(successes, trials)
    theirs = stats.binomtest(successes, trials)
    for ours, method in [(wilson_interval, "wilson"), (clopper_pearson_interval, "exact")]:
        expected = theirs.proportion_ci(confidence, method=method)
        assert ours(successes, trials, confidence) == pytest.approx((expected.low, expected.high), abs=1e-9)


def test_clopper_pearson_without_trials_knows_nothing():
    assert clopper_pearson_interval(0, 0) == (0.0, 1.0)


@given(st.lists(st.floats(-100, 100), min_size=2, max_size=20))
def test_the_interval_of_a_mean_agrees_with_scipy(values: list[float]):
    assume(np.std(values) > 1e-3)
    low, high = stats.ttest_1samp(values, 0.0).confidence_interval(0.95)
    assert mean_interval(values) == pytest.approx((low, high))


def test_one_value_says_nothing_about_its_mean():
    assert mean_interval([3.0]) == (-np.inf, np.inf)
    with pytest.raises(ValueError, match="values"):
        mean_interval([])


@pytest.mark.parametrize(
    ("mean", "variance", "t", "p"), [(2.9512, 18.5950, 1.9666, 0.0520), (2.9556, 17.0759, 2.0552, 0.0425)]
)
def test_the_corrected_test_gives_the_published_values(mean: float, variance: float, t: float, p: float):
    # The two rows of Table 2, from their printed mean and variance of 100 differences.
    wave = np.tile([1.0, -1.0], 50)
    test = corrected_resampled_t_test(mean + wave * np.sqrt(variance / wave.var(ddof=1)), 1 / 9)
    assert (test.mean, test.variance, test.degrees) == pytest.approx((mean, variance, 99))
    assert test.t == pytest.approx(t, abs=1e-4)
    assert test.p == pytest.approx(p, abs=1e-4)


@given(st.lists(st.floats(-10, 10), min_size=2, max_size=30))
def test_without_correction_it_is_the_ordinary_paired_test(values: list[float]):
    assume(np.std(values) > 1e-6)
    ours, theirs = corrected_resampled_t_test(values, 0.0), stats.ttest_1samp(values, 0.0)
    assert ours.t == pytest.approx(theirs.statistic)
    assert ours.p == pytest.approx(theirs.pvalue)
    assert abs(corrected_resampled_t_test(values, 0.1).t) <= abs(ours.t)


def test_equal_differences_leave_no_doubt():
    assert corrected_resampled_t_test([0.0, 0.0], 0.1)[2:] == (0.0, 1, 1.0)
    assert corrected_resampled_t_test([-1.0, -1.0], 0.1)[2:] == (-np.inf, 1, 0.0)


@pytest.mark.parametrize(("values", "ratio"), [([1.0], 0.1), ([1.0, np.nan], 0.1), ([1.0, 2.0], -1.0)])
def test_impossible_paired_tests_are_refused(values: list[float], ratio: float):
    with pytest.raises(ValueError, match=r"differences|test_to_train"):
        corrected_resampled_t_test(values, ratio)


def _mcnemar_p(one: int, other: int) -> float:
    return mcnemar(np.arange(one + other) < one, np.arange(one + other) >= one).p


@given(st.integers(0, 60), st.integers(0, 60))
def test_mcnemar_agrees_with_the_binomial_test(one: int, other: int):
    assume(one + other > 0)
    assert _mcnemar_p(one, other) == pytest.approx(stats.binomtest(one, one + other).pvalue)


def test_mcnemar_of_very_many_trials_is_a_matter_of_a_moment():
    assert _mcnemar_p(100_000, 101_000) == pytest.approx(2 * stats.binom.cdf(100_000, 201_000, 0.5))
    assert _mcnemar_p(100_000, 200_000) == 0.0


def test_equal_differences_leave_no_doubt_whatever_their_rounding_error():
    found = corrected_resampled_t_test([0.1] * 3, 1 / 9)
    assert (found.variance, found.t, found.p) == (0.0, np.inf, 0.0)


def test_a_mean_of_what_is_no_number_is_refused():
    with pytest.raises(ValueError, match="finite"):
        mean_interval([1.0, np.nan])


def test_mcnemar_of_published_examples():
    # statsmodels' documentation: exact p of 121 against 59.
    assert _mcnemar_p(121, 59) == pytest.approx(4.4344e-06, rel=1e-3)
    # Fagerland et al., airway hyper-responsiveness: 1 and 7 discordant pairs.
    assert _mcnemar_p(1, 7) == pytest.approx(0.0703, abs=1e-4)


def test_mcnemar_counts_the_trials_on_which_two_classifiers_differ():
    result = mcnemar([True, True, False, True, False], [True, False, True, False, False])
    assert result[:2] == (2, 1)
    assert mcnemar([True], [True]).p == 1.0
    with pytest.raises(ValueError, match="same trials"):
        mcnemar([True], [True, False])


def test_reliability_and_calibration_error_worked_out_by_hand():
    predicted, came = [0.1, 0.2, 0.9, 1.0], [0, 1, 1, 1]
    assert reliability(predicted, came, 2) == [
        ReliabilityBin(0.0, 0.5, 2, pytest.approx(0.15), 0.5),
        ReliabilityBin(0.5, 1.0, 2, pytest.approx(0.95), 1.0),
    ]
    assert calibration_error(predicted, came, 2) == pytest.approx(0.5 * 0.35 + 0.5 * 0.05)


@pytest.mark.parametrize(
    ("predicted", "came", "bins"),
    [([], [], 3), ([0.5], [1, 0], 3), ([1.5], [1], 3), ([0.5], [2], 3), ([0.5], [1], 0)],
)
def test_impossible_reliabilities_are_refused(predicted: list[float], came: list[int], bins: int):
    with pytest.raises(ValueError, match=r"bins|outcomes"):
        reliability(predicted, came, bins)


class TestSurelyNegative:
    def test_who_always_loses_is_found_out_after_seven_values(self) -> None:
        assert surely_negative([-1.0] * 6) is None
        assert surely_negative([-1.0] * 100) == 7
        assert surely_negative([-1.0] * 100, 1e-3) == 13

    def test_a_mean_of_zero_is_seldom_called_negative_however_long_one_looks(self) -> None:
        rng = np.random.default_rng(1)
        for values in (
            rng.choice([-1.0, 1.0], (500, 300)),
            rng.choice([-1.0, 0.0, 0.0, 1.0], (500, 300)),
            rng.choice([-0.25, -0.25, -0.25, 0.75], (500, 300)),
        ):
            assert sum(surely_negative(row) is not None for row in values) <= 0.06 * len(values)

    def test_a_negative_mean_is_found(self) -> None:
        values = np.random.default_rng(1).choice([-1.0, 0.0, 0.5], 200)
        assert (surely_negative(values) or 200) < 100
        assert surely_negative(-values) is None

    def test_no_values_say_nothing(self) -> None:
        assert surely_negative([]) is None

    @pytest.mark.parametrize("given", [([2.0], 0.05), ([float("nan")], 0.05), ([0.0], 0.0), ([0.0], 1.0)])
    def test_what_is_out_of_range_is_refused(self, given: tuple[list[float], float]) -> None:
        with pytest.raises(ValueError, match="values from -1 to 1, and an error between"):
            surely_negative(*given)


def test_students_quantile_is_scipys() -> None:
    for degrees in (1, 2, 3, 4, 5, 9, 10, 99, 100, 999, 4000):
        for confidence in (0.5, 0.9, 0.95, 0.999):
            sample = np.zeros(degrees + 1)
            sample[0] = 1.0
            half = mean_interval(sample, confidence).high - sample.mean()
            scale = sample.std(ddof=1) / np.sqrt(degrees + 1)
            assert half / scale == pytest.approx(stats.t.ppf(0.5 + confidence / 2.0, degrees), rel=1e-9)
