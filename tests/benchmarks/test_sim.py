from __future__ import annotations

import pytest

from benchmarks.sim import bench_arenas


@pytest.mark.integration
def test_crowded_arenas_are_measured_for_every_size() -> None:
    speeds = bench_arenas(0.05, sides=(1, 3), arenas=(1, 8))
    assert {side: list(of) for side, of in speeds.items()} == {1: [1, 8], 3: [1, 8]}
    assert all(speed > 0.0 for of in speeds.values() for speed in of.values())
