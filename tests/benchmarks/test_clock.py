"""The time on a field with a clock of its own is known, and no more is predicted than was measured."""

from __future__ import annotations

import pytest

from benchmarks.clock import FAULTS, SPEEDS, Fault, Peer, PeerClock, PeerWorld, lead_figures
from robobt.league.known_field import KnownField


@pytest.mark.integration
@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.parametrize("speed", SPEEDS)
def test_frames_are_predicted_to_the_present(speed: float, fault: Fault) -> None:
    figures = lead_figures(Peer(speed, drift=0.02, jitter=0.005, fault=fault), seconds=12.0)
    assert figures["frames"] > 60 * speed
    assert figures["mean_error"] <= 0.003
    assert figures["p99_error"] <= 0.008


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(1, 6))
@pytest.mark.parametrize("speed", SPEEDS)
def test_they_are_in_other_matches_too(speed: float, seed: int) -> None:
    for fault in FAULTS:
        figures = lead_figures(Peer(speed, fault=fault), seconds=60.0, seed=seed)
        assert figures["mean_error"] <= 0.003
        assert figures["p99_error"] <= 0.008


@pytest.mark.integration
@pytest.mark.parametrize("fault", ["none", "frozen", "lost", "restart"])  # queued packets show a latency
@pytest.mark.parametrize("speed", [0.25, 0.98, 4.0])
def test_nothing_is_predicted_further_than_the_latency_that_was_measured(speed: float, fault: Fault) -> None:
    clock = PeerClock(Peer(speed, drift=0.0, jitter=0.0, fault=fault), 12.0)
    with PeerWorld(clock) as world:
        while world.machine_time < 12.0:
            world.act({})
            captured, since = world._feed.filter.captured, world._feed.now() - world._feed.arrived
            if captured is not None:
                # Without jitter, nothing but the time since the arrival and what rounding adds.
                assert -1e-9 <= world._looked_at - captured <= min(since, 0.25) + 0.002 * max(1.0, speed)


@pytest.mark.integration
@pytest.mark.parametrize("speed", [0.25, 0.98, 1.0, 4.0])
def test_a_match_lasts_as_long_as_on_the_fields_clock(speed: float) -> None:
    clock = PeerClock(Peer(speed, fault="frozen"), 14.0)
    with PeerWorld(clock) as world:
        for _ in range(int(60 * speed * 2)):
            world.act({})
        began, match_began = clock.shows(world.machine_time), world.observe().time
        while world.machine_time < 14.0:
            before = world.observe().time
            world.act({})
            assert world.observe().time > before
        elapsed = clock.shows(world.machine_time) - began
        assert world.observe().time - match_began == pytest.approx(elapsed, abs=0.02)


def test_a_matchs_time_goes_on_when_the_field_is_restarted() -> None:
    with PeerWorld(PeerClock(Peer(0.98, fault="restart"), 14.0)) as world:
        while world.machine_time < 14.0:
            before, at = world.observe().time, world.machine_time
            world.act({})
            assert 0.0 < world.observe().time - before < 2.0 * (world.machine_time - at) + 0.3
        assert world.observe().time == pytest.approx(14.0 * 0.98, abs=1.0)


def _told(peer: Peer, known: KnownField, caplog: pytest.LogCaptureFixture) -> list[str]:
    caplog.clear()
    with PeerWorld(PeerClock(peer, 20.0), known) as world:
        while world.machine_time < 20.0:
            world.act({})
    return caplog.messages


def test_a_rate_that_is_not_the_expected_one_is_told_once(caplog: pytest.LogCaptureFixture) -> None:
    known = KnownField()
    (told,) = _told(Peer(0.98, drift=0.0), known, caplog)
    assert "0.980 of real time, not at 1" in told
    assert _told(Peer(0.98, drift=0.0), known, caplog) == []


def test_a_field_much_slower_than_expected_is_told_with_what_it_means(
    caplog: pytest.LogCaptureFixture,
) -> None:
    (told,) = _told(Peer(0.8, drift=0.0), KnownField(), caplog)
    assert "0.800 of real time, not at 1: its simulator does not keep up" in told
    assert "takes longer" in told


@pytest.mark.integration
@pytest.mark.parametrize(("speed", "expected"), [(1.005, 1.0), (0.5, 0.5), (2.0, 2.0)])
def test_the_expected_rate_is_not_told(
    speed: float, expected: float, caplog: pytest.LogCaptureFixture
) -> None:
    assert _told(Peer(speed, drift=0.0), KnownField(expected), caplog) == []
