from __future__ import annotations

from math import hypot

import pytest

from robobt.skills.defence.wall import Wall
from robobt.testing import robot
from robobt.world import DIVISION_B
from robobt.world.geometry import segment_distance
from robobt.world.rules import in_own_defense_area
from tests.skills.refereed import OPEN, Drive

BALLS = [(0.0, 0.0), (-2.0, 2.5), (-4.0, -2.5), (3.0, -1.0), (-4.4, 2.9)]


@pytest.mark.parametrize("ball", BALLS, ids=str)
def test_one_robot_stands_on_the_way_from_the_ball_to_the_goal(ball: tuple[float, float]) -> None:
    end = Drive(Wall(), robot(-2.0, 0.0, number=1), OPEN, ball).end
    assert segment_distance(end.position, ball, DIVISION_B.our_goal) < 0.02


@pytest.mark.parametrize("ball", BALLS, ids=str)
def test_it_stands_outside_the_defence_area_and_close_to_it(ball: tuple[float, float]) -> None:
    end = Drive(Wall(), robot(-2.0, 0.0, number=1), OPEN, ball).end
    assert not in_own_defense_area(DIVISION_B, end.x, end.y, 0.09)
    assert in_own_defense_area(DIVISION_B, end.x, end.y, 0.16)


@pytest.mark.parametrize("ball", BALLS, ids=str)
def test_two_robots_stand_side_by_side(ball: tuple[float, float]) -> None:
    left = Drive(Wall(place=0, size=2), robot(-2.0, 0.5, number=1), OPEN, ball).end
    right = Drive(Wall(place=1, size=2), robot(-2.0, -0.5, number=2), OPEN, ball).end
    assert 0.14 < hypot(left.x - right.x, left.y - right.y) < 0.22


def test_left_is_left_as_the_robots_look_out() -> None:
    left = Drive(Wall(place=0, size=2), robot(-2.0, 0.5, number=1), OPEN, (0.0, 0.0)).end
    right = Drive(Wall(place=1, size=2), robot(-2.0, -0.5, number=2), OPEN, (0.0, 0.0)).end
    assert left.y > 0.0 > right.y


def test_a_place_outside_the_wall_is_refused() -> None:
    with pytest.raises(ValueError, match="place 2"):
        Wall(place=2, size=2)
