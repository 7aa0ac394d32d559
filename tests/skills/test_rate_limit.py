import pytest

from robobt.skills.rate_limit import RateLimit


def test_it_is_due_at_once_and_then_every_so_often() -> None:
    look = RateLimit(0.2)
    ticks = [i * 0.05 for i in range(9)]
    assert [look.due(time) for time in ticks] == [True, False, False, False] * 2 + [True]


def test_every_zero_is_every_tick() -> None:
    look = RateLimit(0.0)
    assert all(look.due(0.0) for _ in range(3))


def test_a_multiple_of_the_period_does_not_slip_a_tick() -> None:
    look = RateLimit(0.1)
    due = [i for i in range(600) if look.due(i / 60)]
    assert due == list(range(0, 600, 6))


def test_a_clock_set_back_is_a_new_match() -> None:
    look = RateLimit(1.0)
    assert look.due(50.0)
    assert look.due(0.0)
    assert not look.due(0.5)


def test_a_negative_time_is_refused() -> None:
    with pytest.raises(ValueError, match="every"):
        RateLimit(-0.1)
