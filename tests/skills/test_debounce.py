from __future__ import annotations

import pytest

from robobt.skills.debounce import Debounce

PERIOD = 0.02


class Seen:
    """Tells a Debounce what was seen for how long."""

    def __init__(self, rise: float, fall: float) -> None:
        self.steady = Debounce(rise, fall)
        self.ticks = 0

    def for_(self, seconds: float, answer: bool) -> bool:
        on = self.steady.on
        for _ in range(round(seconds / PERIOD)):
            on = self.steady.update(answer, self.ticks * PERIOD)
            self.ticks += 1
        return on


def test_it_begins_with_yes_and_a_first_no_ends_that() -> None:
    seen = Seen(rise=0.2, fall=0.4)
    assert seen.steady.on
    assert not seen.for_(0.02, False)


def test_yes_comes_back_after_the_rise() -> None:
    seen = Seen(rise=0.2, fall=0.4)
    seen.for_(0.1, False)
    assert not seen.for_(0.18, True)
    assert seen.for_(0.04, True)


def test_a_flickering_yes_never_counts() -> None:
    seen = Seen(rise=0.2, fall=0.4)
    seen.for_(0.1, False)
    for _ in range(20):
        assert not seen.for_(0.1, True)
        assert not seen.for_(0.1, False)


def test_a_long_yes_survives_a_gap_and_a_short_one_does_not() -> None:
    for yes, survives in ((1.0, True), (0.1, False)):
        seen = Seen(rise=0.0, fall=0.4)
        seen.for_(yes, True)
        assert seen.for_(0.3, False) is survives


def test_no_gap_longer_than_the_fall_is_survived() -> None:
    seen = Seen(rise=0.0, fall=0.4)
    seen.for_(5.0, True)
    assert not seen.for_(0.44, False)


def test_a_clock_that_runs_backwards_starts_anew() -> None:
    seen = Seen(rise=0.2, fall=0.4)
    seen.for_(1.0, False)
    seen.ticks = 0
    assert seen.for_(0.02, True)


@pytest.mark.parametrize(("rise", "fall"), [(-0.1, 0.0), (0.0, -0.1), (float("nan"), 0.0)])
def test_times_are_not_negative(rise: float, fall: float) -> None:
    with pytest.raises(ValueError, match="rise and fall"):
        Debounce(rise, fall)
