from __future__ import annotations

from math import hypot

import pytest

from robobt.skills.restarts.keep_distance import KeepDistance
from robobt.testing import robot
from robobt.tree import Status
from robobt.world import Restart, Team
from robobt.world.geometry import segment_distance
from tests.skills.refereed import STOP, Drive, free_kick, placement, stop_before

CLEAR = 0.5 + 0.09


@pytest.mark.parametrize(
    ("x", "y"), [(0.2, 0.0), (-0.1, 0.3), (0.0, 0.0), (0.0, -0.5)], ids=["front", "side", "on it", "near"]
)
def test_a_robot_near_the_ball_clears_it_in_a_stop(x: float, y: float) -> None:
    drive = Drive(KeepDistance(), robot(x, y, number=1), STOP, (0.0, 0.0), seconds=3.0)
    assert hypot(drive.end.x, drive.end.y) >= CLEAR
    assert drive.status is Status.SUCCESS


def test_it_never_drives_faster_than_the_rules_allow_in_a_stop() -> None:
    drive = Drive(KeepDistance(), robot(0.15, 0.0, number=1), STOP, (0.0, 0.0), seconds=3.0)
    assert max(state.speed for state in drive.way) <= 1.5 + 1e-9


def test_a_robot_that_is_clear_stays_where_it_is() -> None:
    drive = Drive(KeepDistance(), robot(0.7, 0.0, number=1), STOP, (0.0, 0.0), seconds=0.5)
    assert drive.status is Status.SUCCESS
    assert drive.end.position == (0.7, 0.0)


def test_the_place_where_the_ball_will_be_put_is_cleared_too() -> None:
    game = stop_before(Restart.FREE_KICK, Team.YELLOW, (1.0, 1.0))
    drive = Drive(KeepDistance(), robot(1.1, 1.1, number=1), game, (3.0, 3.0), seconds=3.0)
    assert hypot(drive.end.x - 1.0, drive.end.y - 1.0) >= CLEAR


@pytest.mark.parametrize("ball", [(4.3, 2.8), (-4.3, -2.8), (0.0, 2.9)], ids=["corner", "own", "line"])
def test_there_is_a_way_out_of_every_corner(ball: tuple[float, float]) -> None:
    me = robot(ball[0] + 0.1, ball[1] + 0.1, number=1)
    drive = Drive(KeepDistance(), me, free_kick(Team.YELLOW, ball), ball, seconds=4.0)
    assert hypot(drive.end.x - ball[0], drive.end.y - ball[1]) >= CLEAR


@pytest.mark.parametrize("me", [(4.69, 3.19), (4.7, 2.5), (4.2, 3.2)], ids=str)
def test_there_is_a_way_out_from_between_a_placement_and_the_corner(me: tuple[float, float]) -> None:
    ball, spot = (4.73, 2.72), (4.3, 2.8)
    drive = Drive(KeepDistance(), robot(*me, number=1), placement(spot, Team.YELLOW), ball, seconds=2.0)
    assert segment_distance(drive.end.position, ball, spot) >= CLEAR
