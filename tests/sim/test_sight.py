"""What cameras see past robots, and by how much they are wrong."""

from __future__ import annotations

from math import hypot, pi

import numpy as np
import pytest

from robobt.sim import REALISM, SimWorld, preset
from robobt.sim.realism import RealismSettings
from robobt.sim.sight import camera_places, offset_of, visible_part
from robobt.world import BALL_RADIUS, DIVISION_B, Placement, RobotCommand
from tests.sim.rig import IT, ME

FACE = 0.075
CAMERA = (2.25, 1.5)


def towards(distance: float, camera: tuple[float, float] = CAMERA) -> tuple[float, float]:
    """Return the place at a distance from the point below a camera, on the way to the centre [m]."""
    x, y = camera
    away = hypot(x, y)
    return x - x / away * distance, y - y / away * distance


def robot_before(ball: tuple[float, float], gap: float) -> tuple[float, float, float]:
    """Return a robot that stands between a ball and the camera, its round back ``gap`` from the ball."""
    dx, dy = CAMERA[0] - ball[0], CAMERA[1] - ball[1]
    away = hypot(dx, dy)
    reach = 0.09 + BALL_RADIUS + gap
    return ball[0] + dx / away * reach, ball[1] + dy / away * reach, np.arctan2(dy, dx)


def test_a_ball_in_the_open_is_seen_whole() -> None:
    part = visible_part((0.0, 0.0, 0.0), CAMERA, [(1.0, 1.0, 0.0)], FACE)
    assert (part.share, part.x, part.y) == (1.0, 0.0, 0.0)


@pytest.mark.parametrize(("distance", "hidden"), [(0.3, False), (4.0, True)])
def test_a_robot_hides_the_ball_from_a_camera_that_is_far(distance: float, hidden: bool) -> None:
    x, y = towards(distance)
    share = visible_part((x, y, 0.0), CAMERA, [robot_before((x, y), 0.0)], FACE).share
    assert (share < 0.4) == hidden


def test_a_robot_behind_the_ball_hides_nothing() -> None:
    x, y = towards(3.0)
    rx, ry, heading = robot_before((x, y), 0.0)
    behind = (2 * x - rx, 2 * y - ry, heading)
    assert visible_part((x, y, 0.0), CAMERA, [behind], FACE).share == 1.0


def test_the_share_that_is_seen_grows_with_the_gap() -> None:
    x, y = towards(3.0)
    shares = [
        visible_part((x, y, 0.0), CAMERA, [robot_before((x, y), gap)], FACE).share for gap in (0, 0.03, 0.06)
    ]
    assert shares == sorted(shares)
    assert shares[0] < shares[-1]


def test_the_part_that_is_seen_lies_on_the_side_of_the_ball_away_from_the_robot() -> None:
    x, y = towards(3.0)
    robot = robot_before((x, y), 0.0)
    beside = (robot[0] - 0.07, robot[1] + 0.07, robot[2])
    part = visible_part((x, y, 0.0), CAMERA, [beside], FACE)
    assert 0.0 < part.share < 1.0
    assert hypot(part.x - beside[0], part.y - beside[1]) > hypot(x - beside[0], y - beside[1])
    assert hypot(part.x - x, part.y - y) < BALL_RADIUS


def test_a_ball_above_the_robots_is_seen() -> None:
    x, y = towards(4.0)
    assert visible_part((x, y, 0.2), CAMERA, [robot_before((x, y), 0.0)], FACE).share == 1.0


def test_cameras_see_everything_farther_from_the_centre() -> None:
    for place in camera_places(DIVISION_B, 4):
        dx, dy = offset_of(place, 0.02)
        assert hypot(dx, dy) == pytest.approx(0.02)
        assert dx * place[0] + dy * place[1] > 0.0
    assert offset_of((0.0, 0.0), 0.02) == (0.0, 0.0)


def seen_from(realism: RealismSettings, ball: tuple[float, float, float, float]) -> SimWorld:
    world = SimWorld(DIVISION_B, {ME: None, IT: None}, preset("default", realism=realism), 1 / 60)
    world.reset(Placement({ME: (-3.0, 1.0, 0.0), IT: (3.0, 1.0, pi)}, ball), seed=0)
    return world


def test_a_systematic_offset_stays_from_frame_to_frame() -> None:
    world = seen_from(RealismSettings(object_offset=0.02), (1.0, 1.0, 0.0, 0.0))
    for _ in range(5):
        world.act({})
        seen, true = world.observe(), world.truth()
        assert hypot(seen.ball.x - true.ball.x, seen.ball.y - true.ball.y) == pytest.approx(0.02)
        assert seen.own[0].x < true.own[0].x
        assert seen.opponents[0].x > true.opponents[0].x


def test_wrong_places_of_the_cameras_shift_only_a_ball_that_flies() -> None:
    world = seen_from(RealismSettings(camera_error=0.1), (-2.87, 1.0, 0.0, 0.0))
    assert world.observe().ball == world.truth().ball
    for _ in range(30):
        world.act({ME: RobotCommand(vx=0.5, kick_speed=4.0, kick_angle=pi / 4)})
        true, seen = world.truth().ball, world.observe().ball
        shift = hypot(seen.x - true.x, seen.y - true.y)
        assert shift == pytest.approx(
            0.1 * hypot(0.3, 0.7) / hypot(0.3, 0.7, 0.05) * true.z / (4 - BALL_RADIUS)
        )
    assert max(true.z, shift) > 0.0


def test_a_hidden_ball_stays_where_it_was_seen_last() -> None:
    realism = RealismSettings(hidden_below=0.4)
    world = SimWorld(DIVISION_B, {ME: None, IT: None}, preset("default", realism=realism), 1 / 60)
    # Far from the nearest camera a ball rolls past the back of a robot that looks at the camera.
    world.reset(
        Placement({ME: (4.2, 2.5, -2.67), IT: (-3, 0, 0)}, (4.215, 2.73, 0.46 * 0.8, -0.89 * 0.8)), seed=0
    )
    stays = []
    for _ in range(40):
        before = world.observe().ball.position
        world.act({})
        stays.append(world.observe().ball.position == before)
    assert any(stays)
    assert not all(stays)


def test_a_lost_response_leaves_the_last_one() -> None:
    def touches(loss: float) -> list[bool]:
        world = seen_from(RealismSettings(response_loss=loss), (-2.87, 1.0, 0.0, 0.0))
        told = []
        for tick in range(60):
            world.act({ME: RobotCommand(vx=0.4, dribbler=True, kick_speed=3.0 if tick == 40 else 0.0)})
            told.append(world.observe().own[0].ball_contact)
        return told

    assert any(touches(0.0))
    assert not any(touches(1.0))
    assert touches(0.5).index(True) >= touches(0.0).index(True)


def test_a_seed_fixes_what_a_level_shows() -> None:
    def play() -> list[float]:
        world = seen_from(REALISM["realistic"], (0.0, 0.0, 2.0, 0.0))
        shown = []
        for _ in range(30):
            world.act({ME: RobotCommand(vx=1.0)})
            shown += [world.observe().ball.x, world.observe().own[0].x]
        return shown

    assert play() == play()
