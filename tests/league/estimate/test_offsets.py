"""Where cameras overlap and disagree, what rests stays at rest and what moves goes on evenly."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, hypot, pi, sin

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from robobt.league.estimate.filter import VisionFilter
from robobt.league.estimate.offsets import MeanOffsets
from robobt.league.wire.vision import BallDetection, CameraFrame, RobotDetection
from robobt.sim.realism import REALISM
from robobt.sim.settings import SimSettings
from robobt.world.field import DIVISION_B
from robobt.world.game import Team
from robobt.world.geometry import wrap_angle
from robobt.world.state import BALL_RADIUS, Frame, RobotId

PERIOD = 1 / 60
ME, HER = RobotId(Team.BLUE, 2), RobotId(Team.YELLOW, 3)
NOISE = REALISM["realistic"]
SETTINGS = SimSettings(realism=NOISE)
MOUTH = SETTINGS.body.face + BALL_RADIUS

Place = tuple[float, float]
Way = Callable[[float], Place]


class Overlap:
    """Cameras that see the same things, each with an offset of its own and noise, one after the other."""

    def __init__(self, cameras: int, offset: float, apart: float, seed: int = 0) -> None:
        self.rng = np.random.default_rng([seed, cameras])
        self.filter = VisionFilter(DIVISION_B, SETTINGS)
        angles = self.rng.uniform(-pi, pi, cameras)
        self.offsets = [(offset * cos(angle), offset * sin(angle)) for angle in angles]
        self.apart, self.turns, self.start = apart, [0.0] * cameras, 0.0

    def frames(
        self,
        seconds: float,
        ball: Way,
        robot: Way,
        heading: float = 0.5,
        sees: Callable[[int, Place], bool] = lambda camera, place: True,
        ball_too: Callable[[int], bool] = lambda camera: True,
    ) -> list[tuple[float, Frame]]:
        """Return the times and the frames known after each camera's frame."""
        found = []
        for i in range(round(seconds / PERIOD)):
            for camera, (dx, dy) in enumerate(self.offsets):
                time = i * PERIOD + camera * self.apart
                a, b, c, d, e = self.rng.standard_normal(5).tolist()
                (x, y), (rx, ry) = ball(time), robot(time)
                now = 100.0 + self.start + time
                seen = CameraFrame(camera, i, now, now)
                if sees(camera, (x, y)) and ball_too(camera):
                    noise = NOISE.ball_noise
                    seen.balls.append(BallDetection(x + dx + a * noise, y + dy + b * noise))
                if sees(camera, (rx, ry)):
                    noise = NOISE.robot_noise
                    turned = wrap_angle(heading + self.turns[camera] + e * NOISE.heading_noise)
                    seen.robots.append(RobotDetection(ME, rx + dx + c * noise, ry + dy + d * noise, turned))
                self.filter.add(seen)
                found.append((time, self.filter.frame_at(now)))
        return found


def errors_of_speed(found: list[tuple[float, Frame]], ball: Place, robot: Place, since: float) -> Place:
    """Return the largest errors of the ball's and of the robot's velocity [m/s]."""
    late = [frame for time, frame in found if time > since]
    return (
        max(hypot(frame.ball.vx - ball[0], frame.ball.vy - ball[1]) for frame in late),
        max(hypot(frame.own[0].vx - robot[0], frame.own[0].vy - robot[1]) for frame in late),
    )


APART = [0.0, 0.001, 0.008]
"""Time from one camera's frame to the next [s]."""


@pytest.mark.parametrize("apart", APART)
@pytest.mark.parametrize("offset", [0.01, 0.02, 0.05])
@pytest.mark.parametrize("cameras", [2, 4])
def test_what_rests_where_cameras_disagree_stays_at_rest(cameras: int, offset: float, apart: float) -> None:
    overlap = Overlap(cameras, offset, apart / (cameras - 1))
    found = overlap.frames(2.0, lambda _: (0.0, 0.0), lambda _: (1.0, 0.0))
    ball, robot = errors_of_speed(found, (0.0, 0.0), (0.0, 0.0), 0.5)
    assert ball < 0.03
    assert robot < 0.03
    wander = max(hypot(frame.ball.x, frame.ball.y) for time, frame in found if time > 0.5)
    assert wander < offset + 0.005


@pytest.mark.parametrize("apart", APART)
@pytest.mark.parametrize("cameras", [2, 4])
def test_what_moves_where_cameras_disagree_goes_on_evenly(cameras: int, apart: float) -> None:
    overlap = Overlap(cameras, 0.04, apart / (cameras - 1))
    found = overlap.frames(2.0, lambda t: (-2.0 + 1.5 * t, 1.0), lambda t: (-2.0 + 1.5 * t, -1.0))
    ball, robot = errors_of_speed(found, (1.5, 0.0), (1.5, 0.0), 0.5)
    assert robot < 0.1
    assert ball < 0.1


@pytest.mark.parametrize("speed", [0.5, 2.0, 4.0])
@pytest.mark.parametrize("seed", range(3))
def test_what_goes_from_one_camera_to_the_next_keeps_its_speed(speed: float, seed: int) -> None:
    overlap = Overlap(2, 0.04, 0.006, seed)

    def sees(camera: int, place: Place) -> bool:
        return place[0] < 0.2 if camera == 0 else place[0] > -0.2

    start = -0.75 * speed
    found = overlap.frames(
        1.5, lambda t: (start + speed * t, 1.0), lambda t: (start + speed * t, -1.0), 0.5, sees
    )
    ball, robot = errors_of_speed(found, (speed, 0.0), (speed, 0.0), 0.4)
    assert robot < 0.1
    assert ball < 0.1
    assert overlap.filter.kicks == []


def test_what_is_first_seen_by_the_next_camera_without_any_overlap_keeps_its_speed() -> None:
    overlap = Overlap(2, 0.04, 0.006)
    found = overlap.frames(
        1.5,
        lambda t: (-1.5 + 2.0 * t, 1.0),
        lambda t: (-1.5 + 2.0 * t, -1.0),
        sees=lambda camera, place: (place[0] > 0.0) == (camera == 1),
    )
    ball, robot = errors_of_speed(found, (2.0, 0.0), (2.0, 0.0), 0.4)
    assert robot < 0.1
    assert ball < 0.1


@pytest.mark.parametrize("turn", [0.02, 0.05])
def test_cameras_that_disagree_about_headings_turn_no_robot(turn: float) -> None:
    overlap = Overlap(2, 0.02, 0.001)
    overlap.turns = [0.0, turn]
    found = overlap.frames(1.5, lambda _: (0.0, 0.0), lambda _: (1.0, 0.0))
    assert max(abs(frame.own[0].omega) for time, frame in found if time > 0.5) < 0.5


@pytest.mark.parametrize("cameras", [2, 4])
@pytest.mark.parametrize(("gap", "has"), [(0.0, True), (0.03, False)])
@pytest.mark.parametrize("hidden", [False, True])
def test_who_has_the_ball_does_not_depend_on_which_cameras_see_it(
    cameras: int, gap: float, has: bool, hidden: bool
) -> None:
    overlap = Overlap(cameras, 0.05, 0.016 / cameras)
    heading = 1.0
    ball = (MOUTH + gap) * cos(heading), (MOUTH + gap) * sin(heading)
    found = overlap.frames(
        2.0, lambda _: ball, lambda _: (0.0, 0.0), heading, ball_too=lambda camera: camera == 0 or not hidden
    )
    late = [frame.own[0].ball_contact for time, frame in found if time > 1.0]
    assert sum(contact == has for contact in late) >= 0.99 * len(late)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("cameras", [2, 3])
def test_a_kick_where_cameras_disagree_is_seen_once_with_its_speed(cameras: int, seed: int) -> None:
    overlap = Overlap(cameras, 0.04, 0.015 / cameras, seed)
    kicked, speed = 1.0, 4.0
    found = overlap.frames(
        1.3, lambda t: (MOUTH + 0.005 + speed * max(0.0, t - kicked), 0.0), lambda _: (0.0, 0.0), heading=0.0
    )
    for time, frame in found:
        if 0.6 < time < kicked:
            assert hypot(frame.ball.vx, frame.ball.vy) < 0.05
        if time > kicked + 3.5 * PERIOD:
            assert frame.ball.vx == pytest.approx(speed, rel=0.12)
            assert abs(frame.ball.vy) < 0.5
    assert [kick.robot for kick in overlap.filter.kicks] == [ME]


@given(
    st.lists(st.dictionaries(st.integers(0, 3), st.floats(-0.05, 0.05), min_size=2), min_size=1, max_size=30)
)
def test_mean_offsets_add_up_to_nothing(seen: list[dict[int, float]]) -> None:
    means = MeanOffsets(1)
    for offsets in seen:
        means.learn({camera: [offset] for camera, offset in offsets.items()})
    assert sum(means.of(camera)[0] for camera in range(4)) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("jump", [0.02, 0.05])
@pytest.mark.parametrize("cameras", [2, 4])
def test_a_camera_whose_offset_changes_kicks_no_ball(cameras: int, jump: float) -> None:
    overlap = Overlap(cameras, 0.02, 0.008)
    overlap.frames(1.0, lambda _: (0.0, 0.0), lambda _: (1.0, 0.0))
    dx, dy = overlap.offsets[1]
    overlap.offsets[1] = dx + jump, dy
    overlap.start = 1.0
    found = overlap.frames(1.0, lambda _: (0.0, 0.0), lambda _: (1.0, 0.0))
    assert max(hypot(frame.ball.vx, frame.ball.vy) for _, frame in found) < 0.05


@pytest.mark.parametrize("late", [0.012, 0.02, 0.03])
def test_a_kick_is_known_although_one_camera_is_late(late: float) -> None:
    filter_ = VisionFilter(DIVISION_B, SETTINGS)
    kicked, speed = 0.5, 5.0
    waiting: list[tuple[float, CameraFrame]] = []
    for i in range(60):
        for camera, delay in ((0, 0.0), (1, late)):
            time = i * PERIOD + camera * 0.005
            x = MOUTH + 0.005 + speed * max(0.0, time - kicked)
            seen = CameraFrame(
                camera, i, time, time, [BallDetection(x, 0.0)], [RobotDetection(ME, 0.0, 0.0, 0.0)]
            )
            waiting.append((time + delay, seen))
    for arrived, seen in sorted(waiting, key=lambda each: each[0]):
        filter_.add(seen)
        if arrived > kicked + 0.15:
            assert filter_.captured is not None
            assert filter_.frame_at(filter_.captured).ball.vx == pytest.approx(speed, abs=0.5)


@pytest.mark.parametrize("moved", [0.03, 0.08, 0.11, 0.5])
@pytest.mark.parametrize("cameras", [1, 2, 4])
@pytest.mark.parametrize("hidden", [0.0, 0.1])
def test_a_ball_that_is_put_elsewhere_is_found_there(cameras: int, moved: float, hidden: float) -> None:
    overlap = Overlap(cameras, 0.02, 0.008 / cameras)
    overlap.frames(0.3, lambda _: (0.0, 0.0), lambda _: (1.5, 0.0))
    overlap.start = 0.3
    if hidden:
        overlap.frames(hidden, lambda _: (0.0, 0.0), lambda _: (1.5, 0.0), ball_too=lambda _: False)
        overlap.start += hidden
    found = overlap.frames(0.5, lambda _: (moved, 0.0), lambda _: (1.5, 0.0))
    for time, frame in found:
        if time > 0.3:
            assert hypot(frame.ball.x - moved, frame.ball.y) < 0.03
