"""Robots and ball placed without anything touching; tests of scenarios place from files."""

from __future__ import annotations

from itertools import combinations
from math import hypot, pi
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robobt.config.errors import FieldError
from robobt.match.scenario.placing import HELD_DISTANCE, Placer, check_starts
from robobt.match.scenario.starts import BallStart, RobotStart
from robobt.world import BALL_RADIUS, DIVISION_B, ROBOT_RADIUS, Placement, RobotId, Team
from robobt.world.geometry import wrap_angle

BLUE, YELLOW = RobotId(Team.BLUE, 0), RobotId(Team.YELLOW, 0)
MIDDLE = {"x": [-0.6, 0.6], "y": [-0.6, 0.6]}
seeds = st.integers(0, 2**32 - 1)


def start(position: Any, heading: Any = 0.0) -> RobotStart:
    return RobotStart.model_validate({"position": position, "heading": heading}, strict=False)


def ball(position: Any = None, **more: Any) -> BallStart:
    return BallStart.model_validate({"position": position, **more}, strict=False)


def place(
    robots: dict[RobotId, RobotStart], at: BallStart, seed: int = 0, clearance: float = 0.1
) -> Placement:
    return Placer(DIVISION_B, robots, at, clearance, np.random.default_rng(seed)).place()


@given(seeds)
def test_what_is_placed_at_random_keeps_its_clearance(seed: int) -> None:
    robots = {RobotId(team, number): start(MIDDLE) for team in Team for number in range(3)}
    placed = place(robots, ball(MIDDLE), seed)
    discs = [(x, y, ROBOT_RADIUS) for x, y, _ in placed.robots.values()]
    discs.append((*placed.ball[:2], BALL_RADIUS))
    for (x, y, radius), (other_x, other_y, other) in combinations(discs, 2):
        assert hypot(x - other_x, y - other_y) >= radius + other + 0.1 - 1e-9
    assert list(placed.robots) == list(robots)


def test_fixed_places_are_taken_first_whatever_the_order() -> None:
    tight = {"x": [-0.2, 0.2], "y": [0.0, 0.0]}
    robots = {BLUE: start(tight), YELLOW: start([0.15, 0.0])}
    for seed in range(20):
        placed = place(robots, ball([2.0, 2.0]), seed, clearance=0.0)
        assert placed.robots[YELLOW][:2] == (-0.15, 0.0)
        assert placed.robots[BLUE][0] >= -0.15 + 2 * ROBOT_RADIUS


def test_a_yellow_start_is_a_blue_one_turned_by_half_a_turn() -> None:
    position, at = {"x": [0.5, 1.5], "y": [-1.0, 0.0]}, ball([2.0, 1.0])
    blue = place({BLUE: start(position, [0.0, 1.0])}, at)
    yellow = place({YELLOW: start(position, [0.0, 1.0])}, at)
    x, y, heading = blue.robots[BLUE]
    assert yellow.robots[YELLOW][:2] == (-x, -y)
    assert wrap_angle(yellow.robots[YELLOW][2] - heading - pi) == pytest.approx(0.0)


@pytest.mark.parametrize("robot", [BLUE, YELLOW])
def test_a_robot_that_faces_something_does_so_in_the_world(robot: RobotId) -> None:
    placed = place({robot: start([-1.0, 0.5], "towards ball")}, ball([1.0, 1.0]))
    x, y, heading = placed.robots[robot]
    reach = hypot(1.0 - x, 1.0 - y)
    assert x + reach * np.cos(heading) == pytest.approx(1.0)
    assert y + reach * np.sin(heading) == pytest.approx(1.0)


@pytest.mark.parametrize("robot", [BLUE, YELLOW])
@given(seed=seeds)
def test_a_held_ball_lies_in_the_holders_mouth(robot: RobotId, seed: int) -> None:
    placed = place({robot: start(MIDDLE, [-pi, pi])}, ball(held_by=str(robot)), seed)
    x, y, heading = placed.robots[robot]
    assert placed.ball[0] == pytest.approx(x + HELD_DISTANCE * np.cos(heading))
    assert placed.ball[1] == pytest.approx(y + HELD_DISTANCE * np.sin(heading))


def test_around_the_ball_is_around_the_sampled_ball() -> None:
    robots = {YELLOW: start({"around": "ball", "distance": [0.5, 0.5], "bearing": [0.0, 0.0]})}
    placed = place(robots, ball(MIDDLE))
    # Yellow's +x is the world's -x.
    assert placed.robots[YELLOW][:2] == pytest.approx((placed.ball[0] - 0.5, placed.ball[1]))


def test_a_moving_ball_keeps_its_velocity() -> None:
    assert place({}, ball([1.0, 2.0], velocity=[0.5, -1.0])).ball == (1.0, 2.0, 0.5, -1.0)


def refusal(robots: dict[RobotId, RobotStart], at: BallStart) -> tuple[str, str]:
    """The field and the problem of starts that find no place."""
    with pytest.raises(FieldError) as caught:
        place(robots, at)
    return caught.value.field, str(caught.value)


def test_what_finds_no_room_is_named() -> None:
    there = start([0.05, 0.05])
    field, problem = refusal({BLUE: there, YELLOW: start({"x": [-0.1, 0], "y": [-0.1, 0]})}, ball([2, 2]))
    assert field == "robots.yellow.0.start"
    assert problem == "no free place in the box x -0.1 to 0 m, y -0.1 to 0 m found in 1000 tries"
    field, _ = refusal({BLUE: there}, ball({"x": [0.0, 0.1], "y": [0.0, 0.1]}))
    assert field == "ball.position"


@pytest.mark.parametrize(
    ("robots", "at", "field", "problem"),
    [
        ({BLUE: start([5.0, 0.0])}, ball([0, 0]), "robots.blue.0.start.position", "outside the field"),
        ({}, ball({"center": [0.0, 4.0], "radius": 0.1}), "ball.position", "outside the field"),
        ({BLUE: start([0.1, 0.0])}, ball([0, 0]), "robots.blue.0.start", "blue 0 would overlap the ball"),
        # In its own view yellow stands on the other side; in the world both stand in one place.
        (
            {BLUE: start([1.0, 0.5]), YELLOW: start([-1.0, -0.5])},
            ball([0, 0]),
            "robots.yellow.0.start",
            "yellow 0 would overlap blue 0",
        ),
        ({BLUE: start([1.0, 0.5])}, ball(held_by="blue 1"), "ball.held_by", "no robot is called"),
    ],
)
def test_starts_that_no_chance_can_help_are_refused(
    robots: dict[RobotId, RobotStart], at: BallStart, field: str, problem: str
) -> None:
    with pytest.raises(FieldError, match=problem) as caught:
        check_starts(DIVISION_B, robots, at)
    assert caught.value.field == field
