"""Chips are recognised by where cameras see them, followed over their hops, and flat kicks are none."""

from __future__ import annotations

from math import hypot

import numpy as np
import pytest

from benchmarks.chips import bench_chips
from robobt.league.estimate.ball_track import BallMotion
from robobt.league.estimate.filter import VisionFilter
from robobt.league.estimate.flight import FlightWatch
from robobt.league.estimate.hop import Hop
from robobt.league.estimate.kicks import Kick
from robobt.league.serve.cameras import Cameras
from robobt.league.wire.geometry import CameraPlace
from robobt.league.wire.vision import BallDetection, CameraFrame
from robobt.sim import SimWorld, preset, settings_from
from robobt.sim.realism import REALISM
from robobt.world.command import CHIP_ANGLE, RobotCommand
from robobt.world.field import DIVISION_B
from robobt.world.game import Team
from robobt.world.protocol import Placement
from robobt.world.state import BALL_RADIUS, ROBOT_HEIGHT, BallState, Frame, RobotId

ME, IT = RobotId(Team.BLUE, 0), RobotId(Team.YELLOW, 0)
PERIOD = 1 / 60
FACE = preset("default").body.face + BALL_RADIUS + 0.0003


def watched(
    speed: float, angle: float, known: bool = True, away: float = 1.25
) -> list[tuple[BallState, Frame]]:
    """A kick from (-1, 0.5) along x, past a robot: what really was and what the filter had."""
    settings = preset("default")
    world = SimWorld(DIVISION_B, {ME: None, IT: None}, settings, PERIOD)
    world.reset(Placement({ME: (-1.0, 0.5, 0.0), IT: (away - 1.0, 0.5, 3.0)}, (FACE - 1.0, 0.5, 0.0, 0.0)), 0)
    eyes = Cameras(DIVISION_B, REALISM["realistic"], 4, np.random.default_rng(0))
    watch = VisionFilter(DIVISION_B, settings)
    if known:
        watch.cameras.update(eyes.calibrated)
    seen = []
    for tick in range(150):
        truth = world.truth()
        for frame in eyes.capture(truth, truth.time, truth.time):
            watch.add(frame)
        seen.append((truth.ball, watch.frame_at(truth.time)))
        world.act({ME: RobotCommand(kick_speed=speed, kick_angle=angle)} if tick == 20 else {})
    return seen


def test_a_chip_is_seen_in_the_air_hops_and_rolls_on() -> None:
    seen = watched(4.0, CHIP_ANGLE)
    # Once it is known, from 0.25 s on, it is where it really is.
    known = [(real, frame.ball) for real, frame in seen[36:]]
    assert max(ball.z for _, ball in known) == pytest.approx(max(real.z for real, _ in known), abs=0.05)
    for real, ball in known:
        assert hypot(ball.x - real.x, ball.y - real.y) < 0.15
        assert ball.z == pytest.approx(real.z, abs=0.1)
    assert known[-1][1].z == 0.0
    assert known[-1][1].vx == pytest.approx(known[-1][0].vx, abs=0.1)


def test_a_robot_under_a_chip_does_not_touch_it() -> None:
    seen = watched(4.0, CHIP_ANGLE)
    over = [frame for real, frame in seen if real.z > ROBOT_HEIGHT and abs(real.x - 0.25) < 0.09]
    assert over
    assert not any(frame.opponents[0].ball_contact for frame in over)
    assert seen[-1][1].last_touch == ME


def test_a_flat_kick_stays_on_the_ground() -> None:
    assert all(frame.ball.z == 0.0 for _, frame in watched(4.0, 0.0, away=-1.0))
    # Nor does it fly when it hits a robot.
    assert all(frame.ball.z == 0.0 for _, frame in watched(4.0, 0.0))


def test_without_the_cameras_places_nothing_flies() -> None:
    assert all(frame.ball.z == 0.0 for _, frame in watched(4.0, CHIP_ANGLE, known=False))


def test_a_tracker_s_ball_is_as_high_as_it_says() -> None:
    watch = VisionFilter(DIVISION_B)
    for tick in range(6):
        ball = BallState(0.1 * tick, 0.0, 6.0, 0.0, 0.5, 1.0)
        frame = CameraFrame(0, tick, tick * PERIOD, tick * PERIOD)
        frame.balls.append(BallDetection(ball.x, ball.y, tracked=ball))
        watch.add(frame)
    shown = watch.frame_at(5 * PERIOD).ball
    assert (shown.z, shown.vz) == (0.5, 1.0)
    assert watch.frame_at(5 * PERIOD + 0.1).ball.z == pytest.approx(0.5 + 0.1 - 9.81 * 0.005)


@pytest.mark.parametrize(("height", "flies"), [(1.5, True), (2.6, False)])
def test_no_ball_is_taken_to_fall_from_higher_than_robots_chip(height: float, flies: bool) -> None:
    """In the real grSim a ball that came off a wall once looked like one that fell from 2.6 m."""
    camera = CameraPlace(2.25, 1.5, 4.0)
    watch = FlightWatch(preset("grsim").ball, 0.002, {0: camera})
    hop, seen = Hop(0.0, BallMotion(1.8, 2.1, 2.0, -1.0, 0.0, height, 3.0)), False
    for tick in range(20):
        ball = hop.at(tick * PERIOD)
        stretch = (camera.z - BALL_RADIUS) / (camera.z - BALL_RADIUS - ball.z)
        x, y = (place + stretch * (at - place) for at, place in ((ball.x, camera.x), (ball.y, camera.y)))
        watch.update(tick * PERIOD, 0, x, y)
        seen = seen or watch.hop is not None
    assert seen is flies


def test_a_ball_that_is_back_exactly_where_it_was_kicked_has_not_flown() -> None:
    """As one between two dribblers is, seen without noise, in the real grSim."""
    watch = FlightWatch(preset("grsim").ball, 0.002, {0: CameraPlace(2.25, 1.5, 4.0)})
    watch.update(0.0, 0, 0.0, 0.0)
    kick = Kick(ME, PERIOD)
    for tick, x in enumerate([0.05, 0.1, 0.15, 0.1, 0.05, 0.0, 0.0], 1):
        watch.update(tick * PERIOD, 0, x, 0.0, kick if tick == 1 else None)
    assert watch.hop is None


class Chip:
    """A ball that is chipped from the origin along x, seen without noise by one of two cameras; a watch."""

    def __init__(self, noise: float = 0.002, speed: float = 2.0, rise: float = 2.0) -> None:
        self.camera, self.tick = CameraPlace(2.25, 1.5, 4.0), 0
        self.ball = Hop(0.0, BallMotion(0.0, 0.0, speed, 0.0, 0.0, 0.0, rise))
        cameras = {0: self.camera, 1: CameraPlace(-2.25, 1.5, 4.0)}
        self.watch = FlightWatch(preset("grsim").ball, noise, cameras)
        self.watch.update(0.0, 0, 0.0, 0.0)

    def see(self, dx: float = 0.0, dy: float = 0.0) -> bool:
        """See it once more, so far off [m]; whether it is taken to fly then."""
        self.tick += 1
        real, camera = self.ball.at(self.tick * PERIOD), self.camera
        stretch = (camera.z - BALL_RADIUS) / (camera.z - BALL_RADIUS - real.z)
        x, y = (at + stretch * (place - at) for place, at in ((real.x, camera.x), (0.0, camera.y)))
        kick = Kick(ME, PERIOD) if self.tick == 1 else None
        self.watch.update(self.tick * PERIOD, 0, x + dx, y + dy, kick)
        return self.watch.hop is not None


def test_a_chip_that_explains_little_more_than_a_flat_kick_is_not_yet_believed() -> None:
    """A flat kick does not fit and a chip does, with 31 % of its misfit; one detection later with 26 %."""
    chip = Chip(noise=0.00155)
    flies = [chip.see(off, off) for off in [0.0022, -0.0022] * 4]
    assert flies == [False] * 7 + [True]


def test_a_ball_in_the_air_is_lost_once_it_is_seen_elsewhere_three_times_in_a_row() -> None:
    twice, thrice = Chip(speed=4.0, rise=4.0), Chip(speed=4.0, rise=4.0)
    for chip in (twice, thrice):
        assert [chip.see() for _ in range(25)][-1]
        assert chip.see(0.0, 0.3)
        assert chip.see(0.0, -0.3)
    assert all(twice.see() for _ in range(4))
    assert not thrice.see(0.0, 0.3)


@pytest.mark.parametrize(("time", "x"), [(13 * PERIOD, 0.0), (0.0, 0.01)], ids=["put back", "late"])
def test_a_chip_in_flight_may_be_seen_where_it_began_or_as_it_was_before(time: float, x: float) -> None:
    chip = Chip()
    assert [chip.see() for _ in range(12)][-1]
    chip.watch.update(time, int(time == 0.0), x, 0.0)
    assert chip.watch.hop is None or abs(chip.watch.hop.ball.vx) < 10.0


@pytest.mark.integration
@pytest.mark.parametrize("name", ["default", "grsim"])
def test_most_chips_are_known_and_land_where_they_are_said_to(name: str) -> None:
    figures = bench_chips(settings_from({"preset": name, "realism": "realistic"}), 30, 30, seed=5, cameras=4)
    assert figures["recognised"] >= 0.8 * figures["chips"]
    assert figures["landing_error"]["0.5"]["p90"] < 0.2
    assert figures["taken_for_chips"] == 0
