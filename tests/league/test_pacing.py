"""The beat keeps its rate whatever the frames do, and falls in step with them where it can."""

from __future__ import annotations

import pytest

from robobt.league.pacing import FrameBeat

PERIOD = 1 / 60


def play(frames: list[float], seconds: float) -> tuple[list[float], list[float]]:
    """When it acts, and how old the newest frame is then, for frames at these times."""
    pace = FrameBeat(PERIOD, 0.0)
    acts, ages = [], []
    now, index, newest = 0.0, 0, None
    while now < seconds:
        fresh = None
        # What a world does: act on a frame once the window is open, or when it closes.
        while index < len(frames) and frames[index] < pace.closes():
            fresh = newest = frames[index]
            index += 1
            if fresh >= pace.opens():
                break
        now = (
            max(fresh, pace.opens())
            if fresh is not None and fresh >= pace.opens() - PERIOD
            else pace.closes()
        )
        acts.append(now)
        if newest is not None:
            ages.append(now - newest)
        pace.acted(now, fresh)
    return acts, ages


@pytest.mark.parametrize("phase", [0.1, 0.3, 0.5, 0.7, 0.9])
def test_it_falls_in_step_with_frames_of_its_own_rate(phase: float) -> None:
    acts, ages = play([(i + phase) * PERIOD for i in range(600)], 9.0)
    assert max(ages[120:]) < 1e-9
    assert len(acts) == pytest.approx(9.0 / PERIOD, rel=0.02)


@pytest.mark.parametrize("rate", [20.0, 58.5, 66.7, 100.0])
def test_it_keeps_its_rate_at_any_rate_of_frames(rate: float) -> None:
    acts, _ = play([i / rate for i in range(int(10 * rate))], 9.0)
    assert len(acts) / acts[-1] == pytest.approx(60.0, rel=0.035)


def test_it_keeps_its_rate_when_frames_stop() -> None:
    acts, _ = play([i * PERIOD for i in range(60)], 3.0)
    stalled = [act for act in acts if 1.2 < act < 2.8]
    assert len(stalled) == pytest.approx(1.6 / PERIOD, abs=2)


def test_it_does_not_hurry_after_a_long_halt() -> None:
    pace = FrameBeat(PERIOD, 0.0)
    pace.acted(5.0, None)
    assert pace.opens() > 5.0
