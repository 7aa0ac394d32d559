"""Goalkeepers of either team, and how simple opponents drive."""

from __future__ import annotations

from math import pi, sqrt

import numpy as np
import pytest

from robobt.learning.opponents.keepers import GOALKEEPER_KINDS, Keepers
from robobt.learning.opponents.straight import DRIVING_LIMITS, drive_of, drive_straight
from robobt.sim.records import COMMAND, size
from robobt.world import DIVISION_B, RobotLimits, RobotState
from robobt.world.geometry import FloatArray, wrap_angles

LIMITS = RobotLimits()
PERIOD = 0.03


def decided(robots: FloatArray, balls: FloatArray, index: int, blue: int, kind: str) -> FloatArray:
    n = len(balls)
    keepers = Keepers(DIVISION_B, LIMITS, PERIOD, n, index, blue)
    keepers.restart(np.arange(n), np.tile([GOALKEEPER_KINDS.index(kind), 2.0, 0.3], (n, 1)))
    commands = np.zeros((n, robots.shape[1], size(COMMAND)))
    keepers.decide(robots, balls, np.zeros(robots.shape[:2], dtype=np.bool_), commands)
    assert not np.delete(commands, index, axis=1).any()
    return commands[:, index]


@pytest.mark.parametrize("kind", ["line", "angle", "aim", "rush", "shipped"])
def test_a_goalkeeper_of_either_team_minds_the_opponent_nearest_to_the_ball(kind: str) -> None:
    rng, n = np.random.default_rng(2), 50
    robots, balls = rng.uniform(-1.0, 1.0, (n, 2, 6)), np.zeros((n, 4))
    robots[:, :, 0] += [0.5, 4.0]
    robots[:, 0, 2] = rng.uniform(-0.3, 0.3, n)
    balls[:, :2] = robots[:, 0, :2] + rng.uniform(-0.3, 0.3, (n, 2))
    balls[:, 2:] = rng.uniform(-0.5, 2.0, (n, 2)) * [[1.0, 0.2]]
    yellow = decided(robots, balls, 1, 1, kind)
    assert yellow.any()
    # Blue's, first of two mates, against two, of whom the second is far from the ball.
    turned = np.zeros((n, 4, 6))
    turned[:, 0], turned[:, 2] = -robots[:, 1], -robots[:, 0]
    turned[:, 1, :2], turned[:, 3, :2] = -balls[:, :2], (-4.0, 2.5)
    turned[:, [0, 2], 2] = wrap_angles(robots[:, [1, 0], 2] + pi)
    turned[:, [0, 2], 5] = robots[:, [1, 0], 5]
    np.testing.assert_allclose(decided(turned, -balls, 0, 2, kind), yellow, atol=1e-9)


@pytest.mark.parametrize("way", [0.001, 0.2, 3.0])
def test_a_robot_drives_so_that_it_stops_at_the_point_with_braking_in_reserve(way: float) -> None:
    me, drive = RobotState(0, 1.0, 2.0, heading=pi / 2), drive_of(LIMITS, PERIOD).view(DRIVING_LIMITS)[0]
    ahead, left, _ = drive_straight(me, (1.0, 2.0 + way), (1.0, 3.0), 2.0, 6.0, drive)
    braking = min(LIMITS.braking, LIMITS.lateral_braking)
    assert ahead == pytest.approx(min(2.0, sqrt(2.0 * 0.8 * braking * way), way / PERIOD))
    assert left == pytest.approx(0.0, abs=1e-12)


def test_a_robot_turns_to_what_it_faces_and_no_faster_than_it_may() -> None:
    me, drive = RobotState(0, 0.0, 0.0), drive_of(LIMITS, PERIOD).view(DRIVING_LIMITS)[0]
    rates = [
        drive_straight(me, (0.0, 0.0), at, 2.0, 5.0, drive)[2] for at in ((1.0, 0.1), (-1.0, 0.1), (0, -1))
    ]
    assert rates == [pytest.approx(6.0 * np.arctan2(0.1, 1.0)), 5.0, -5.0]
