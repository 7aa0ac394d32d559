"""Many arenas behave as each would alone."""

from __future__ import annotations

import numpy as np
import pytest

from robobt.sim import Arenas, preset
from robobt.sim.arenas import Solver
from robobt.world import DIVISION_B


def placed(n: int, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    robots = np.concatenate(
        [
            rng.uniform(-2, 2, (n, 4, 2)) + np.array([[-2, -1], [-2, 1], [2, -1], [2, 1]]),
            rng.uniform(-3, 3, (n, 4, 1)),
        ],
        axis=-1,
    )
    balls = np.concatenate([rng.uniform(-0.5, 0.5, (n, 2)), rng.uniform(-4, 4, (n, 2))], axis=-1)
    return robots, balls


def commands(n: int, rng: np.random.Generator) -> np.ndarray:
    values = rng.uniform(-2, 2, (n, 4, 6))
    values[..., 3] = rng.uniform(0, 6, (n, 4)) * (rng.random((n, 4)) < 0.3)
    values[..., 4:] = rng.random((n, 4, 2)) < 0.5
    return values


@pytest.mark.integration
@pytest.mark.parametrize("solver", ["compiled", "pymunk"])
@pytest.mark.parametrize("name", ["default", "grsim"])
def test_each_of_many_arenas_moves_as_it_would_alone_bit_for_bit(name: str, solver: Solver) -> None:
    rng = np.random.default_rng(5)
    n, steps = 9, 80
    robots, balls = placed(n, rng)
    orders = [commands(n, rng) for _ in range(steps)]
    many = Arenas(DIVISION_B, [None] * 4, preset(name), 0.025, n, solver=solver)
    many.place(robots, balls)
    alone = [Arenas(DIVISION_B, [None] * 4, preset(name), 0.025, solver=solver) for _ in range(n)]
    for i, arena in enumerate(alone):
        arena.place(robots[i], balls[i])
    for order in orders:
        many.step(order)
        for i, arena in enumerate(alone):
            arena.step(order[i : i + 1])
            np.testing.assert_array_equal(many.robots[i], arena.robots[0])
            np.testing.assert_array_equal(many.balls[i], arena.balls[0])
            assert (many.contact[i] == arena.contact[0]).all()
            assert many.touch[i] == arena.touch[0]


def test_placing_some_arenas_leaves_the_others_alone() -> None:
    rng = np.random.default_rng(6)
    robots, balls = placed(4, rng)
    one, other = (Arenas(DIVISION_B, [None] * 4, preset("default"), 0.025, 4) for _ in range(2))
    for arenas in (one, other):
        arenas.place(robots, balls)
        for _ in range(10):
            arenas.step(np.ones((4, 4, 6)) * 0.5)
    one.place(robots[[2]], balls[[2]], [2])
    np.testing.assert_allclose(one.robots[2, :, :3], robots[2], atol=1e-12)
    for _ in range(10):
        for arenas in (one, other):
            arenas.step(np.ones((4, 4, 6)) * 0.5)
    for i in (0, 1, 3):
        np.testing.assert_array_equal(one.robots[i], other.robots[i])


def test_the_same_commands_give_the_same_states_bit_for_bit() -> None:
    rng = np.random.default_rng(7)
    robots, balls = placed(1, rng)
    orders = [commands(1, rng) for _ in range(300)]
    traces = []
    for _ in range(2):
        arenas = Arenas(DIVISION_B, [None] * 4, preset("default"), 0.025)
        arenas.place(robots, balls)
        trace = []
        for order in orders:
            arenas.step(order.copy())
            trace.append(arenas.robots.tobytes() + arenas.balls.tobytes())
        traces.append(trace)
    assert traces[0] == traces[1]


def test_the_parameters_of_one_arena_can_differ() -> None:
    arenas = Arenas(DIVISION_B, [None], preset("default"), 0.025, 2)
    arenas.place(np.zeros((2, 1, 3)), np.array([[1.0, 1, 2, 0], [1.0, 1, 2, 0]]))
    arenas.arena_parameters["ball"]["roll_deceleration"][1] *= 3
    for _ in range(20):
        arenas.step(np.zeros((2, 1, 6)))
    assert arenas.balls[1, 2] < arenas.balls[0, 2]


def test_a_pymunk_that_keeps_bodies_otherwise_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("robobt.sim.chipmunk._BODY_OFFSETS", (64, 72, 112, 88, 80, 120))
    with pytest.raises(RuntimeError, match="its structures have changed"):
        Arenas(DIVISION_B, [None] * 4, preset("default"), 0.025, solver="pymunk")
