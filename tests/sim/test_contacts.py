"""The compiled solver moves bodies as pymunk does."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from robobt.sim import Arenas, preset
from robobt.sim.arenas import Solver
from robobt.sim.records import CONTACT_MEMORY
from robobt.world import DIVISION_B
from robobt.world.geometry import FloatArray

PERIOD = 0.03
N = 40
Scene = Callable[[np.random.Generator], tuple[FloatArray, FloatArray, FloatArray]]


def ball_comes_at_a_robot(rng: np.random.Generator) -> tuple[FloatArray, FloatArray, FloatArray]:
    from_, off, speed = rng.uniform(-3, 3, N), rng.uniform(-0.15, 0.15, N), rng.uniform(0.5, 6, N)
    balls = np.stack(
        [
            0.5 * np.cos(from_),
            0.5 * np.sin(from_),
            -speed * np.cos(from_ + off),
            -speed * np.sin(from_ + off),
        ],
        axis=-1,
    )
    robots = np.zeros((N, 1, 3))
    robots[..., 2] = rng.uniform(-3, 3, (N, 1))
    commands = np.zeros((N, 1, 6))
    commands[..., :3] = rng.uniform(-1, 1, (N, 1, 3))
    return robots, balls, commands


def two_robots_collide(rng: np.random.Generator) -> tuple[FloatArray, FloatArray, FloatArray]:
    robots = np.tile([[-0.5, 0.0, 0.0], [0.5, 0.0, np.pi]], (N, 1, 1))
    robots[..., 1] = rng.uniform(-0.1, 0.1, (N, 2))
    commands = np.zeros((N, 2, 6))
    commands[..., 0], commands[..., 2] = 2.0, rng.uniform(-3, 3, (N, 2))
    return robots, np.tile([3.0, 2.0, 0.0, 0.0], (N, 1)), commands


def ball_flies_at_walls_and_goals(rng: np.random.Generator) -> tuple[FloatArray, FloatArray, FloatArray]:
    places = np.stack([rng.uniform(2, 4, N), rng.uniform(-2.8, 2.8, N)], axis=-1)
    balls = np.concatenate([places, rng.uniform(2, 6, (N, 1)), rng.uniform(-6, 6, (N, 1))], axis=-1)
    return np.tile([[-2.0, 0.0, 0.0]], (N, 1, 1)), balls, np.zeros((N, 1, 6))


def robot_drives_into_walls(rng: np.random.Generator) -> tuple[FloatArray, FloatArray, FloatArray]:
    robots = np.stack([rng.uniform(3, 4, N), rng.uniform(-2, 2, N), rng.uniform(-0.8, 0.8, N)], axis=-1)
    commands = np.zeros((N, 1, 6))
    commands[..., 0], commands[..., 1] = rng.uniform(2, 3, (N, 1)), rng.uniform(-1, 1, (N, 1))
    return robots[:, None], np.tile([-1.0, 0.0, 0.0, 0.0], (N, 1)), commands


def played(
    scene: tuple[FloatArray, FloatArray, FloatArray], name: str, solver: Solver, steps: int
) -> tuple[FloatArray, Arenas]:
    """Return robots and balls after each step, (steps, N, 6 R + 4), and the arenas."""
    robots, balls, commands = scene
    arenas = Arenas(DIVISION_B, [None] * robots.shape[1], preset(name), PERIOD, N, solver=solver)
    arenas.place(robots, balls)
    rows = []
    for _ in range(steps):
        arenas.step(commands)
        rows.append(np.concatenate([arenas.robots.reshape(N, -1), arenas.balls], axis=-1))
    return np.array(rows), arenas


@pytest.mark.parametrize("name", ["default", "grsim", "erforce"])
@pytest.mark.parametrize(
    "scene",
    [ball_comes_at_a_robot, two_robots_collide, ball_flies_at_walls_and_goals, robot_drives_into_walls],
)
def test_it_moves_what_touches_as_pymunk_does(scene: Scene, name: str) -> None:
    made = scene(np.random.default_rng(1))
    theirs, _ = played(made, name, "pymunk", 40)
    ours, arenas = played(made, name, "compiled", 40)
    touched = (arenas._arrays.contacts.memory.view(CONTACT_MEMORY)["when"][..., 0] > 0.0).any(axis=1)
    assert name == "grsim" or touched.mean() > 0.4, "in grsim the kernels push the ball"
    apart = np.sort(np.abs(theirs - ours).max(axis=(0, 2)))
    assert apart[:-4].max() < 1e-8
    # In a corner two contacts are solved at once, in an order that is not the same.
    assert apart.max() < 0.3


def crowd(solver: Solver) -> FloatArray:
    """Return mean and spread of what six robots and a ball, all at one spot, come to in N arenas."""
    rng = np.random.default_rng(2)
    angles = rng.uniform(0, 2 * np.pi, (N, 1)) + np.arange(6) * np.pi / 3
    robots = np.stack([0.5 * np.cos(angles), 0.5 * np.sin(angles), angles + np.pi], axis=-1)
    commands = np.zeros((N, 6, 6))
    commands[..., 0], commands[..., 1], commands[..., 2] = 1.5, rng.uniform(-0.3, 0.3, (N, 6)), 0.0
    states = played((robots, np.zeros((N, 4)), commands), "default", solver, 60)[0][20:]
    reach = np.hypot(states[..., 0:36:6], states[..., 1:36:6]).mean(axis=(0, 2))
    speed = np.hypot(states[..., 3:36:6], states[..., 4:36:6]).mean(axis=(0, 2))
    ball = np.hypot(states[..., -4], states[..., -3]).mean(axis=0)
    return np.array([[each.mean(), each.std() / N**0.5] for each in (reach, speed, ball)])


def test_a_crowd_comes_to_the_same_on_average() -> None:
    theirs, ours = crowd("pymunk"), crowd("compiled")
    assert (np.abs(theirs[:, 0] - ours[:, 0]) < 4.0 * np.hypot(theirs[:, 1], ours[:, 1])).all()


def test_robots_that_start_inside_each_other_are_pushed_apart_slowly() -> None:
    robots = np.array([[[0.0, 0.0, 0.0], [0.1, 0.0, 0.0]]])
    arenas = Arenas(DIVISION_B, [None] * 2, preset("default"), PERIOD)
    arenas.place(robots, [[2.0, 0.0, 0.0, 0.0]])
    gaps = []
    for _ in range(40):
        arenas.step(np.zeros((1, 2, 6)))
        gaps.append(float(arenas.robots[0, 1, 0] - arenas.robots[0, 0, 0]))
    assert (np.diff(gaps) >= -1e-12).all()
    assert gaps[-1] > 0.179
    assert np.abs(arenas.robots[..., 3:5]).max() < 1e-3, "bodies take no velocity from it"


def test_a_heavier_robot_is_pushed_less() -> None:
    pushed = []
    for mass in (1.0, 4.0):
        arenas = Arenas(DIVISION_B, [None] * 2, preset("default"), PERIOD, 1)
        arenas.weigh(0, mass)
        arenas.place([[[0.0, 0.0, 0.0], [2.0, 2.0, 0.0]]], [[0.6, 0.0, -5.0, 0.0]])
        for _ in range(6):
            arenas.step(np.zeros((1, 2, 6)))
        pushed.append(abs(float(arenas.robots[0, 0, 0])))
    assert pushed[1] < 0.5 * pushed[0]


def test_what_an_arena_was_before_does_not_matter() -> None:
    rng = np.random.default_rng(3)
    robots, balls, commands = two_robots_collide(rng)
    arenas = Arenas(DIVISION_B, [None] * 2, preset("default"), PERIOD, N)
    states = []
    for _ in range(2):
        arenas.place(robots, balls)
        for _ in range(25):
            arenas.step(commands)
        states.append(arenas.robots.copy())
    np.testing.assert_array_equal(*states)


def test_a_solver_that_there_is_not_is_refused() -> None:
    with pytest.raises(ValueError, match="solver must be one of compiled, pymunk, not 'box2d'"):
        Arenas(DIVISION_B, [None], preset("default"), PERIOD, solver="box2d")  # type: ignore[arg-type]
