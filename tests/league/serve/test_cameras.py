"""Cameras share the field as grSim's do, and see what is over their part of it."""

from __future__ import annotations

from math import dist, hypot

import numpy as np
import pytest

from robobt.league.serve.cameras import Cameras
from robobt.league.wire.geometry import CAMERA_HEIGHT
from robobt.sim.realism import REALISM, RealismSettings
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


def level(**changes: float) -> Cameras:
    return Cameras(DIVISION_B, RealismSettings(**changes), 4, np.random.default_rng(0))


def test_each_camera_sees_everything_shifted_away_from_the_centre() -> None:
    frame = Frame(0.0, DIVISION_B, BallState(0.0, 0.0), (RobotState(1, 0.1, 0.0, 0.0),))
    eyes = level(object_offset=0.02)
    for seen, (px, py) in zip(eyes.capture(frame, 0.0, 0.0), eyes.places, strict=True):
        (ball,), (robot,) = seen.balls, seen.robots
        assert hypot(ball.x, ball.y) == pytest.approx(0.02)
        assert ball.x * px > 0 < ball.y * py
        assert (robot.x - 0.1, robot.y) == pytest.approx((ball.x, ball.y))


def test_a_calibration_is_wrong_by_the_cameras_error() -> None:
    eyes = level(camera_error=0.1)
    for (x, y), place in zip(eyes.places, eyes.calibrated.values(), strict=True):
        assert dist((x, y, CAMERA_HEIGHT), place) == pytest.approx(0.1)


def test_a_ball_behind_a_robot_is_not_seen() -> None:
    behind = Frame(0.0, DIVISION_B, BallState(-0.113, 0.0), (RobotState(1, 0.0, 0.0, 0.0),))
    distant = Cameras(DIVISION_B, RealismSettings(hidden_below=0.4), 4, np.random.default_rng(0))
    saw = [bool(seen.balls) for seen in distant.capture(behind, 0.0, 0.0)]
    # The two cameras over the half at +x look over the robot.
    assert saw == [False, False, True, True]


def test_false_balls_are_seen_at_dribblers_as_often_as_the_level_says() -> None:
    robot = RobotState(1, 1.0, 1.0, 0.3)
    frame = Frame(0.0, DIVISION_B, BallState(-3.0, -2.0), (robot,))
    eyes = level(false_balls=6.0)
    seen = [ball for _ in range(2000) for one in eyes.capture(frame, 0.0, 0.0) for ball in one.balls]
    false = [ball for ball in seen if hypot(ball.x - robot.x, ball.y - robot.y) < 0.1]
    # 6 a second at 60 frames a second: one in ten, of 2,000.
    assert 150 < len(false) < 250


def test_cameras_of_a_level_overlap_as_it_says() -> None:
    frame = Frame(0.0, DIVISION_B, BallState(0.8, 0.9))
    assert [len(seen.balls) for seen in level(camera_overlap=1.0).capture(frame, 0.0, 0.0)] == [1, 1, 1, 1]
    assert [len(seen.balls) for seen in level(camera_overlap=0.3).capture(frame, 0.0, 0.0)] == [1, 0, 0, 0]
