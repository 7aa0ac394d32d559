"""Clocks are followed whatever their offset and rate; those of cameras that disagree are aligned."""

from __future__ import annotations

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from robobt.league.estimate.clocks import CameraClocks, FieldClock

PERIOD = 1 / 60

rates = st.floats(0.25, 4.0)
origins = st.floats(-1e6, 1e6)
delays = st.lists(st.floats(0.0, 0.005), min_size=1, max_size=50)


def follow(clock: FieldClock, rate: float, origin: float, late: list[float], seconds: float = 2.0) -> float:
    """Send frames at a rate for a while; return by how much the clock is then ahead."""
    sent = PERIOD
    while sent < seconds * rate:
        clock.update(100.0 + sent / rate + late[round(sent / PERIOD) % len(late)], origin + sent)
        sent += PERIOD
    there = clock.at(100.0 + seconds)
    assert there is not None
    return there - (origin + seconds * rate)


@pytest.mark.integration
@given(rates, origins)
def test_a_steady_clock_is_known_exactly(rate: float, origin: float) -> None:
    clock = FieldClock()
    assert follow(clock, rate, origin, [0.0]) == pytest.approx(0.0, abs=1e-3)
    assert clock.rate == pytest.approx(rate, rel=5e-3)
    assert clock.jitter < 1e-3 * max(1.0, rate)


@given(rates, delays)
def test_delays_cost_no_more_than_they_are(rate: float, late: list[float]) -> None:
    least, most = min(late), max(late)
    error = follow(FieldClock(), rate, 0.0, late)
    assert -most * rate - 0.002 <= error <= (most - least) * rate + 0.002


@pytest.mark.integration
@given(rates, delays, origins)
@example(2.0, [0.0] * 9 + [1 / 256] * 6, 0.0625)  # 0.1 s once ended a block by rounding
def test_origins_do_not_matter(rate: float, late: list[float], origin: float) -> None:
    moved = follow(FieldClock(), rate, origin, late)
    assert moved == pytest.approx(follow(FieldClock(), rate, 0.0, late), abs=0.002)


@given(rates, st.floats(0.3, 1.0).map(lambda size: round(size, 3)), st.booleans())
def test_a_clock_that_jumped_is_found_within_half_a_second(rate: float, size: float, ahead: bool) -> None:
    clock = FieldClock()
    follow(clock, rate, 0.0, [0.0, 0.001])
    jump = size if ahead else -size
    sent = 2.0 * rate
    while sent < 2.5 * rate + 0.1:
        clock.update(100.0 + sent / rate, sent + jump)
        sent += PERIOD
    there = clock.at(100.0 + sent / rate)
    assert there == pytest.approx(sent + jump, abs=0.003 * max(1.0, rate))


@given(rates, st.floats(-0.45, 0.45))
def test_one_wrong_timestamp_moves_nothing(rate: float, wrong: float) -> None:
    clock = FieldClock()
    follow(clock, rate, 0.0, [0.0])
    for i in range(60):
        sent = 2.0 * rate + i * PERIOD
        clock.update(100.0 + sent / rate, sent + (wrong if i == 20 else 0.0))
        there = clock.at(100.0 + sent / rate)
        assert there == pytest.approx(sent, abs=0.012)


@settings(max_examples=30)
@given(st.lists(st.tuples(st.floats(0.0, 0.05), st.floats(-1e9, 1e9)), max_size=200))
def test_whatever_is_sent_the_rate_stays_within_reason(packets: list[tuple[float, float]]) -> None:
    clock = FieldClock()
    now = 0.0
    for wait, sent in packets:
        now += wait
        clock.update(now, sent)
        assert 0.05 <= clock.rate <= 20.0
        assert clock.at(now) is not None


@pytest.mark.parametrize("apart", [-1000.0, -3.0, -0.3, 0.2, 7.0, 1e6])
def test_clocks_that_differ_are_brought_together(apart: float) -> None:
    clocks = CameraClocks()
    for i in range(200):
        now = i * PERIOD
        late = 0.01 * (i % 3)
        assert clocks.shift(0, 100.0 + now + late, now) == 0.0
        assert clocks.shift(1, 100.0 + now + late, now + apart) == pytest.approx(-apart)


def test_clocks_in_step_are_left_as_they_are() -> None:
    clocks = CameraClocks()
    for i in range(200):
        now = i * PERIOD
        assert clocks.shift(0, now + 0.001, now) == 0.0
        assert clocks.shift(1, now + 0.02, now) == 0.0


def test_a_packet_whose_clock_has_slipped_moves_no_camera() -> None:
    clocks = CameraClocks()
    for i in range(200):
        now = i * PERIOD
        clocks.shift(0, now, now + (1000.0 if i % 10 == 5 else 0.0))
        assert clocks.shift(1, now, now) == 0.0
