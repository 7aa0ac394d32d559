from __future__ import annotations

import numpy as np
import pytest

from benchmarks.minimal_kernel import MinimalArenas
from benchmarks.sim import bench_arenas, bench_minimal


@pytest.mark.integration
def test_crowded_arenas_are_measured_for_every_size() -> None:
    speeds = bench_arenas(0.05, sides=(1, 3), arenas=(1, 8))
    assert {side: list(of) for side, of in speeds.items()} == {1: [1, 8], 3: [1, 8]}
    assert all(speed > 0.0 for of in speeds.values() for speed in of.values())


@pytest.mark.integration
def test_arenas_are_measured_beside_the_minimal_kernel() -> None:
    figures = bench_minimal(0.05, sides=(1,), n=8)
    assert figures[1].keys() == {"arenas", "minimal", "minimal_ratio"}
    assert figures[1]["minimal_ratio"] > 1.0


@pytest.mark.integration
def test_the_minimal_kernel_plays() -> None:
    """A robot gets the ball, carries it back and kicks it into the goal; one robot pushes the other."""
    arenas = MinimalArenas(1, 2, steps=4, dt=0.0075)
    arenas.place(np.array([[[3.2, 0.0, 0.0], [2.0, 1.0, np.pi / 2]]]), np.array([[3.5, 0.0, 0.0, 0.0]]))
    ahead, back, kick = np.zeros((3, 1, 2, 7))
    ahead[0, 0, [0, 5]], back[0, 0, [0, 5]], kick[0, 0, 3] = (0.4, 1.0), (-0.5, 1.0), 5.0
    for _ in range(30):
        arenas.step(ahead)
    assert arenas.contact[0].tolist() == [True, False]
    taken = arenas.balls[0, 0]
    for _ in range(30):
        arenas.step(back)
    assert arenas.contact[0, 0]
    assert arenas.balls[0, 0] < taken - 0.1
    arenas.step(kick)
    speeds = []
    for _ in range(20):
        arenas.step(np.zeros((1, 2, 7)))
        speeds.append(np.hypot(*arenas.balls[0, 2:]))
    assert speeds[0] > 4.5
    assert arenas.goals[0] == 1

    arenas.place(np.array([[[0.0, 0.0, 0.0], [0.5, 0.0, 0.0]]]), np.array([[0.0, 2.0, 0.0, 0.0]]))
    for _ in range(90):
        arenas.step(ahead)
    assert np.hypot(*(arenas.robots[0, 1, :2] - arenas.robots[0, 0, :2])) > 0.17
    assert arenas.robots[0, 1, 0] > 0.52
