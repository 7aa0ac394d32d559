"""Camera clocks that disagree are aligned; single wrong timestamps are ignored."""

from __future__ import annotations

import pytest

from robobt.league.estimate.clocks import CameraClocks

PERIOD = 1 / 60


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
