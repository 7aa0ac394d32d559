"""Fixed places and distributions: what they accept, what they sample and how they print."""

from __future__ import annotations

from math import atan2, hypot, pi
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from robobt.match.scenario.starts import Anywhere, Around, BallStart, Box, Disc, RobotStart
from robobt.world import DIVISION_B
from robobt.world.state import BALL_RADIUS

seeds = st.integers(0, 2**32 - 1)


def start(position: Any, heading: Any = 0.0) -> RobotStart:
    return RobotStart.model_validate({"position": position, "heading": heading}, strict=False)


@given(seeds)
def test_a_sample_lies_in_its_box_its_disc_or_around_its_middle(seed: int) -> None:
    rng = np.random.default_rng(seed)
    x, y = Box(x=(-1.0, 2.0), y=(0.5, 0.6)).sample(rng)
    assert -1.0 <= x <= 2.0
    assert 0.5 <= y <= 0.6
    x, y = Disc(center=(1.0, -1.0), radius=0.4).sample(rng)
    assert hypot(x - 1.0, y + 1.0) <= 0.4
    around = Around(around="ball", distance=(0.5, 1.0), bearing=(0.0, pi / 2))
    x, y = around.sample(rng, (2.0, 1.0))
    assert 0.5 - 1e-9 <= hypot(x - 2.0, y - 1.0) <= 1.0 + 1e-9
    assert -1e-9 <= atan2(y - 1.0, x - 2.0) <= pi / 2 + 1e-9


def test_a_disc_is_filled_evenly() -> None:
    rng = np.random.default_rng(0)
    disc = Disc(center=(0.0, 0.0), radius=1.0)
    inner = sum(hypot(*disc.sample(rng)) < 0.5 for _ in range(4000)) / 4000
    assert inner == pytest.approx(0.25, abs=0.03)


def test_a_range_of_no_width_is_one_value() -> None:
    rng = np.random.default_rng(0)
    assert Box(x=(1.0, 1.0), y=(2.0, 2.0)).sample(rng) == (1.0, 2.0)
    assert start([0.0, 0.0], [0.5, 0.5]).sample_heading(rng, (0.0, 0.0), None, DIVISION_B) == 0.5


def test_a_heading_is_an_angle_a_range_or_a_look_at_something() -> None:
    rng = np.random.default_rng(0)
    place, ball = (3.5, -1.0), (3.5, 2.0)
    assert start([0, 0], 1.0).sample_heading(rng, place, ball, DIVISION_B) == 1.0
    assert 0.1 <= start([0, 0], [0.1, 0.2]).sample_heading(rng, place, ball, DIVISION_B) <= 0.2
    assert start([0, 0], "towards ball").sample_heading(rng, place, ball, DIVISION_B) == pytest.approx(pi / 2)
    goal = start([0, 0], "towards goal").sample_heading(rng, place, ball, DIVISION_B)
    assert goal == pytest.approx(pi / 4)
    assert start([0, 0], "towards ball").sample_heading(rng, place, None, DIVISION_B) == goal


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ([0.5, -1], "at (0.5, -1) m, heading 0 rad"),
        ({"x": [0, 1], "y": [-1, 1]}, "in the box x 0 to 1 m, y -1 to 1 m, heading 0 rad"),
        ({"center": [0, 1], "radius": 0.5}, "within 0.5 m of (0, 1) m, heading 0 rad"),
        ({"around": "own goal", "distance": [1, 2]}, "1 to 2 m from the own goal, heading 0 rad"),
        (
            {"around": "ball", "distance": [1, 2], "bearing": [0, 1]},
            "1 to 2 m from the ball, bearing 0 to 1 rad, heading 0 rad",
        ),
    ],
)
def test_a_start_prints_as_a_phrase(value: Any, text: str) -> None:
    assert str(start(value)) == text


@pytest.mark.parametrize(
    "value",
    [
        {"x": [1.0, 0.0], "y": [0.0, 1.0]},
        {"center": [0.0, 0.0], "radius": 0.0},
        {"around": "ball", "distance": [-1.0, 1.0]},
        {"around": "the goal", "distance": [0.0, 1.0]},
        [0.0],
        [float("nan"), 0.0],
        "ball",
    ],
)
def test_a_position_that_cannot_be_is_refused(value: Any) -> None:
    with pytest.raises(ValidationError):
        start(value)


@pytest.mark.parametrize(
    ("values", "problem"),
    [
        ({}, "either position or held_by"),
        ({"position": (0.0, 0.0), "held_by": "blue 0"}, "either position or held_by"),
        ({"held_by": "blue 0", "velocity": (1.0, 0.0)}, "no velocity of its own"),
        ({"position": Around(around="ball", distance=(0.0, 1.0))}, "cannot be placed around something"),
    ],
)
def test_a_ball_has_one_place(values: dict[str, Any], problem: str) -> None:
    with pytest.raises(ValidationError, match=problem):
        BallStart(**values)


def test_anywhere_is_within_the_walls_and_as_often_at_them_as_asked() -> None:
    rng, places = np.random.default_rng(0), []
    wall_x, wall_y = DIVISION_B.outer
    for _ in range(2000):
        x, y = Anywhere(at_walls=0.3).sample(rng, DIVISION_B)
        assert abs(x) < wall_x - BALL_RADIUS
        assert abs(y) < wall_y - BALL_RADIUS
        # Never in the wall or a post of a goal.
        assert abs(x) < DIVISION_B.half_length or abs(abs(y) - DIVISION_B.goal_width / 2) > BALL_RADIUS
        in_goal = abs(x) > DIVISION_B.half_length and abs(y) < DIVISION_B.goal_width / 2
        places.append(in_goal or abs(x) > wall_x - 0.03 or abs(y) > wall_y - 0.03)
    assert np.mean(places) == pytest.approx(0.3, abs=0.05)
