"""Ways that keep clear: the map of the way, and the velocity chosen from it."""

from __future__ import annotations

from math import hypot

import numpy as np
import pytest

from robobt.motion.clear_way import CAPSULE_COLUMNS, CELL, Ground, clear_velocity_of, clearance, time_map

GROUND = Ground(4.7, 3.2, 3.5, 1.0, 0.3)
NOTHING = np.zeros((0, CAPSULE_COLUMNS))
PACE = (3.0, 3.0, 6.0)


def robot(x: float, y: float, vx: float = 0.0, vy: float = 0.0, radius: float = 0.2) -> np.ndarray:
    return np.array([[x, y, vx, vy, x, y, vx, vy, radius]])


def at(way: np.ndarray, x: float, y: float) -> float:
    return float(way[round((x + GROUND.half_length) / CELL), round((y + GROUND.half_width) / CELL)])


def test_clearance_is_the_gap_to_the_nearest() -> None:
    assert clearance(0.0, 0.0, 0.0, robot(1.0, 0.0), GROUND) == pytest.approx(0.8)
    assert clearance(3.0, 0.0, 0.0, NOTHING, GROUND) == pytest.approx(0.2)
    line = np.array([[1.0, -1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.1]])
    assert clearance(0.0, 0.5, 0.0, line, GROUND) == pytest.approx(0.9)


def test_an_obstacle_is_where_it_will_be_and_grows_meanwhile() -> None:
    moving = robot(1.0, 0.0, -1.0)
    assert clearance(0.0, 0.0, 0.0, moving, GROUND) == pytest.approx(0.8)
    assert clearance(0.0, 0.0, 0.5, moving, GROUND) == pytest.approx(0.3 - 0.075)


def test_the_way_over_free_ground_is_the_distance() -> None:
    way = time_map((-1.0, 0.0), (-3.0, 1.0), 2.0, NOTHING, GROUND)
    for x, y in ((-1.0, 0.0), (-2.0, 2.0), (-3.0, -1.0)):
        assert at(way, x, y) == pytest.approx(hypot(x + 3.0, y - 1.0), rel=0.06, abs=2 * CELL)


def test_the_way_round_a_wall_is_longer() -> None:
    wall = np.array([[-2.0, -1.0, 0.0, 0.0, -2.0, 3.2, 0.0, 0.0, 0.2]])
    way = time_map((-1.0, 1.0), (-3.0, 1.0), 2.0, wall, GROUND)
    assert at(way, -1.0, 1.0) > 2.0 * hypot(1.0, 2.2)


def test_it_drives_at_the_target_and_stops_before_what_is_in_the_way() -> None:
    target = (-1.0, 0.0)
    way = time_map((-3.0, 0.0), target, 2.0, NOTHING, GROUND)
    vx, vy = clear_velocity_of((-3.0, 0.0, 0.0, 0.0), target, PACE, 0.02, way, NOTHING, GROUND)
    assert vx >= 1.35
    assert vy == pytest.approx(0.0, abs=1e-9)
    # A wall over the whole width has appeared half a metre ahead.
    wall = np.array([[-2.3, -3.2, 0.0, 0.0, -2.3, 3.2, 0.0, 0.0, 0.2]])
    vx, _ = clear_velocity_of((-3.0, 0.0, 2.0, 0.0), target, PACE, 0.02, way, wall, GROUND)
    assert vx <= 0.75
