"""Cameras share the field as grSim's do, and see what is over their part of it."""

from __future__ import annotations

import numpy as np
import pytest

from robobt.league.serve.cameras import Cameras
from robobt.league.wire.geometry import CAMERA_HEIGHT
from robobt.sim.settings import REALISM
from robobt.world.field import DIVISION_B
from robobt.world.game import Team
from robobt.world.state import BALL_RADIUS, BallState, Frame, RobotId, RobotState


def cameras(count: int) -> Cameras:
    return Cameras(DIVISION_B, REALISM["none"], count, np.random.default_rng(0))


def test_four_are_numbered_and_placed_as_grsims() -> None:
    assert cameras(4).places == [(2.25, 1.5), (2.25, -1.5), (-2.25, -1.5), (-2.25, 1.5)]


def test_one_hangs_over_the_middle() -> None:
    assert cameras(1).places == [(0.0, 0.0)]


@pytest.mark.parametrize("count", [2, 6, 16])
def test_every_camera_sees_what_is_below_it(count: int) -> None:
    shared = cameras(count)
    assert len(set(shared.places)) == count
    robots = tuple(RobotState(i, x, y, 0.0) for i, (x, y) in enumerate(shared.places))
    frame = Frame(0.0, DIVISION_B, BallState(0.0, 0.0), robots)
    for seen in shared.capture(frame, 0.0, 0.0):
        assert RobotId(Team.BLUE, seen.camera) in {detection.robot for detection in seen.robots}


def test_a_ball_in_the_air_is_seen_where_the_ray_through_it_meets_the_ground() -> None:
    high = BallState(1.0, -0.5, z=(CAMERA_HEIGHT - BALL_RADIUS) / 2)
    (seen,) = cameras(1).capture(Frame(0.0, DIVISION_B, high), 0.0, 0.0)
    assert [(ball.x, ball.y) for ball in seen.balls] == [pytest.approx((2.0, -1.0))]


def test_a_ball_below_the_camera_is_seen_where_it_is_however_high() -> None:
    shared = cameras(4)
    x, y = shared.places[2]
    seen = shared.capture(Frame(0.0, DIVISION_B, BallState(x, y, z=1.5)), 0.0, 0.0)
    assert [(ball.x, ball.y) for ball in seen[2].balls] == [(x, y)]


def test_what_lies_in_the_middle_is_seen_by_all_four() -> None:
    frame = Frame(0.0, DIVISION_B, BallState(0.1, -0.1))
    assert [len(seen.balls) for seen in cameras(4).capture(frame, 0.0, 0.0)] == [1, 1, 1, 1]
