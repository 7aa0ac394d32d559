"""Of several places at which one object is reported, the one seen more often and more surely wins."""

from __future__ import annotations

from collections.abc import Callable
from math import hypot, nan, pi

import numpy as np
import pytest

from robobt.league.estimate.filter import VisionFilter
from robobt.league.wire.vision import BallDetection, CameraFrame, RobotDetection
from robobt.world.field import DIVISION_B
from robobt.world.game import Team
from robobt.world.geometry import wrap_angle
from robobt.world.state import Frame, RobotId

PERIOD = 1 / 60
ME, MATE = RobotId(Team.BLUE, 2), RobotId(Team.BLUE, 5)

Balls = list[tuple[float, float, float]]
"""x, y and confidence of each."""
Robots = list[tuple[RobotId, float, float, float, float]]
"""Number, x, y, heading and confidence of each."""


class Seen:
    """A filter, and what it is shown, 60 frames a second by one camera unless another is named."""

    def __init__(self) -> None:
        self.filter = VisionFilter(DIVISION_B)
        self.time, self.number = 50.0, 0

    def see(self, balls: Balls | None = None, robots: Robots | None = None, camera: int = 0) -> None:
        self.number += 1
        self.time += PERIOD
        self.filter.add(
            CameraFrame(
                camera,
                self.number,
                self.time,
                self.time,
                [BallDetection(x, y, sure) for x, y, sure in balls or []],
                [RobotDetection(robot, x, y, h, sure) for robot, x, y, h, sure in robots or []],
            )
        )

    def see_for(self, frames: int, balls: Callable[[int], Balls] | None = None) -> None:
        for i in range(frames):
            self.see(balls(i) if balls else None)

    def frame(self) -> Frame:
        return self.filter.frame_at(self.time)

    def ball_is_at(self, x: float, y: float, within: float = 0.02) -> bool:
        ball = self.frame().ball
        return hypot(ball.x - x, ball.y - y) < within


@pytest.fixture
def seen() -> Seen:
    return Seen()


@pytest.mark.parametrize("surely", [0.15, 0.3, 0.6])
def test_a_surer_ball_wins_within_two_seconds_against_one_seen_first(seen: Seen, surely: float) -> None:
    seen.see_for(120, lambda _: [(2.0, 1.0, surely)])
    seen.see_for(120, lambda _: [(2.0, 1.0, surely), (-1.0, 0.5, 0.95)])
    assert seen.ball_is_at(-1.0, 0.5)


def test_a_ball_seen_more_often_wins_against_one_seen_first(seen: Seen) -> None:
    seen.see_for(60, lambda i: [(2.0, 1.0, 1.0)] if i % 3 == 0 else [])
    seen.see_for(180, lambda i: [(-1.0, 0.5, 1.0)] + ([(2.0, 1.0, 1.0)] if i % 3 == 0 else []))
    assert seen.ball_is_at(-1.0, 0.5)


def test_a_moving_ball_wins_against_a_weak_one_at_rest(seen: Seen) -> None:
    seen.see_for(60, lambda _: [(2.0, 1.0, 0.2)])
    seen.see_for(120, lambda i: [(2.0, 1.0, 0.2), (-2.0 + 1.5 * i * PERIOD, 0.0, 0.9)])
    assert seen.ball_is_at(-2.0 + 1.5 * 119 * PERIOD, 0.0, 0.05)
    assert seen.frame().ball.vx == pytest.approx(1.5, abs=0.3)


def test_a_weak_ball_beside_the_one_in_play_is_left_out(seen: Seen) -> None:
    seen.see_for(60, lambda _: [(0.0, 0.0, 0.9)])
    for i in range(120):
        seen.see([(0.0, 0.0, 0.9), (0.08, 0.0, 0.2)] if i % 2 else [(0.08, 0.0, 0.2), (0.0, 0.0, 0.9)])
        assert seen.ball_is_at(0.0, 0.0, 0.005)


def test_of_two_balls_that_are_seen_as_surely_the_nearer_is_the_one_in_play(seen: Seen) -> None:
    seen.see_for(60, lambda _: [(0.0, 0.0, 0.9)])
    for i in range(20):
        balls = [(0.005, 0.0, 0.9), (0.04, 0.0, 0.9)]
        seen.see(balls if i % 2 else balls[::-1])
        assert seen.ball_is_at(0.005, 0.0, 0.01)


def test_a_spare_ball_that_two_cameras_see_does_not_win_against_the_one_in_play(seen: Seen) -> None:
    seen.see_for(60, lambda _: [(2.0, 1.0, 0.9)])
    for _ in range(180):
        seen.see([(2.0, 1.0, 0.9), (0.0, 0.0, 0.9)])
        seen.see([(0.0, 0.0, 0.9)], camera=1)
        assert seen.ball_is_at(2.0, 1.0)


def test_a_weak_ball_is_not_taken_for_one_that_is_hidden(seen: Seen) -> None:
    seen.see_for(60, lambda _: [(0.0, 0.0, 0.9)])
    seen.see_for(7, lambda _: [(0.9, 0.0, 0.15)])
    assert seen.ball_is_at(0.0, 0.0)
    seen.see_for(180, lambda _: [(0.9, 0.0, 0.15)])
    # Nothing else is seen: after three seconds it is better than nothing.
    assert seen.ball_is_at(0.9, 0.0)
    seen.see_for(15, lambda _: [(0.9, 0.0, 0.15), (0.0, 0.0, 0.9)])
    assert seen.ball_is_at(0.0, 0.0)


def test_a_spare_ball_is_not_taken_for_one_that_is_hidden_for_a_moment(seen: Seen) -> None:
    seen.see_for(60, lambda _: [(0.0, 0.0, 0.9), (0.5, 0.0, 0.9)])
    assert seen.ball_is_at(0.0, 0.0)
    seen.see_for(2, lambda _: [(0.5, 0.0, 0.9)])
    assert seen.ball_is_at(0.0, 0.0)


def test_scattered_false_balls_do_not_keep_the_real_one_from_being_found(seen: Seen) -> None:
    rng = np.random.default_rng(3)
    for _ in range(6):
        scattered = [(float(x), float(y), 1.0) for x, y in rng.uniform(-2.9, 2.9, (4, 2))]
        seen.see([*scattered, (0.3, 0.3, 0.9)])
    assert seen.ball_is_at(0.3, 0.3)


@pytest.mark.parametrize("surely", [0.15, 0.5])
def test_a_surer_robot_wins_against_its_number_seen_first_elsewhere(seen: Seen, surely: float) -> None:
    ghost = (ME, 2.0, 1.0, 0.0, surely)
    for _ in range(60):
        seen.see(robots=[ghost])
    for _ in range(120):
        seen.see(robots=[ghost, (ME, -1.0, 0.5, 1.0, 0.95)])
    (robot,) = seen.frame().own
    assert (robot.x, robot.y, robot.heading) == pytest.approx((-1.0, 0.5, 1.0), abs=0.01)


@pytest.mark.parametrize("frames", [1, 3, 10, 30])
def test_robots_whose_numbers_are_exchanged_for_a_while_stay_where_they_are(seen: Seen, frames: int) -> None:
    for i in range(90 + frames):
        one, other = (ME, MATE) if i < 60 or i >= 60 + frames else (MATE, ME)
        seen.see(robots=[(one, 1.0, 0.0, 0.0, 0.9), (other, -1.0, 0.5, 0.0, 0.9)])
        if i > 10:
            me, mate = seen.frame().own
            assert (me.x, me.y) == pytest.approx((1.0, 0.0), abs=0.01)
            assert (mate.x, mate.y) == pytest.approx((-1.0, 0.5), abs=0.01)


def test_robots_that_were_exchanged_for_good_are_found_within_a_second(seen: Seen) -> None:
    for i in range(120):
        one, other = (ME, MATE) if i < 60 else (MATE, ME)
        seen.see(robots=[(one, 1.0, 0.0, 0.0, 0.9), (other, -1.0, 0.5, 0.0, 0.9)])
    me, mate = seen.frame().own
    assert (me.x, mate.x) == pytest.approx((-1.0, 1.0), abs=0.01)


TURNED = {
    "one frame by half a turn": lambda i: pi if i == 60 else 0.0,
    "three frames by half a turn": lambda i: pi if 60 <= i < 63 else 0.0,
    "every tenth by half a turn": lambda i: pi if i % 10 == 5 else 0.0,
    "every third by a right angle": lambda i: pi / 2 if i % 3 == 1 else 0.0,
    "the first by half a turn": lambda i: pi if i < 5 else 0.0,
    "every other by 1 rad after a second": lambda i: 1.0 if i > 60 and i % 2 else 0.0,
}


@pytest.mark.parametrize("turned", TURNED.values(), ids=TURNED)
@pytest.mark.parametrize("turn", [0.0, 4.0])
def test_headings_that_are_misread_now_and_then_are_left_out(
    seen: Seen, turned: Callable[[int], float], turn: float
) -> None:
    rng = np.random.default_rng(1)
    for i in range(180):
        heading = wrap_angle(turn * i * PERIOD)
        noise = 0.01 * float(rng.standard_normal())
        seen.see(robots=[(ME, 0.0, 0.0, wrap_angle(heading + turned(i) + noise), 0.9)])
        if i > 30:
            (robot,) = seen.frame().own
            assert abs(wrap_angle(robot.heading - heading)) < 0.05
            assert robot.omega == pytest.approx(turn, abs=0.8)


def test_a_robot_that_was_turned_by_hand_is_seen_so_within_a_fifth_of_a_second(seen: Seen) -> None:
    for i in range(72):
        seen.see(robots=[(ME, 0.0, 0.0, 0.0 if i < 60 else 2.0, 0.9)])
    assert seen.frame().own[0].heading == pytest.approx(2.0, abs=0.01)


@pytest.mark.parametrize("turn", [8.0, 15.0, 25.0])
def test_a_robot_that_is_suddenly_spun_round_is_followed(seen: Seen, turn: float) -> None:
    for i in range(120):
        heading = wrap_angle(turn * max(0, i - 60) * PERIOD)
        seen.see(robots=[(ME, 0.0, 0.0, heading, 0.9)])
        if i > 75:
            (robot,) = seen.frame().own
            assert abs(wrap_angle(robot.heading - heading)) < 0.1
            assert robot.omega == pytest.approx(turn, rel=0.1)


@pytest.mark.parametrize("every", [3, 5, 10])
@pytest.mark.parametrize("turn", [0.0, 10.0])
def test_headings_that_are_misread_by_any_angle_are_left_out(seen: Seen, every: int, turn: float) -> None:
    rng = np.random.default_rng(2)
    bad = 0
    for i in range(400):
        heading = wrap_angle(turn * i * PERIOD)
        off = (
            float(rng.uniform(-pi, pi)) if i % every == 0 and i > 10 else 0.01 * float(rng.standard_normal())
        )
        seen.see(robots=[(ME, 0.0, 0.0, wrap_angle(heading + off), 0.9)])
        if i > 30:
            (robot,) = seen.frame().own
            bad += abs(wrap_angle(robot.heading - heading)) > 0.15
    assert bad <= 4


@pytest.mark.parametrize("off", [0.15, 0.3, 0.55])
@pytest.mark.parametrize("every", [2, 10])
def test_headings_that_are_misread_a_little_turn_no_robot(seen: Seen, off: float, every: int) -> None:
    for i in range(240):
        seen.see(robots=[(ME, 0.0, 0.0, off if i % every == 0 and i > 20 else 0.0, 0.9)])
        if i > 20:
            assert abs(seen.frame().own[0].heading) < 0.03


@pytest.mark.parametrize("speed", [2.0, 4.0, 6.0])
@pytest.mark.parametrize("surely", [0.3, 0.5, 0.7])
def test_a_ball_that_is_kicked_beside_a_less_sure_one_is_followed(
    seen: Seen, speed: float, surely: float
) -> None:
    phantom = (0.05, 0.0, surely)
    seen.see_for(60, lambda _: [(0.0, 0.0, 0.9), phantom])
    seen.see_for(30, lambda i: [(speed * (i + 1) * PERIOD, 0.0, 0.9), phantom])
    assert seen.ball_is_at(speed * 30 * PERIOD, 0.0, 0.05)


def test_scattered_weak_balls_are_not_taken_for_one_that_is_hidden(seen: Seen) -> None:
    rng = np.random.default_rng(4)
    seen.see_for(60, lambda _: [(0.0, 0.0, 0.9)])
    for _ in range(60):
        seen.see([(float(x), float(y), 0.4) for x, y in rng.uniform(-2.5, 2.5, (3, 2))])
        # One that happens to lie where the ball may be is taken for it.
        assert seen.ball_is_at(0.0, 0.0, within=0.25)


@pytest.mark.parametrize("confidence", [1.5, 1e300])
def test_no_confidence_counts_for_more_than_certainty(seen: Seen, confidence: float) -> None:
    seen.see_for(60, lambda _: [(0.0, 0.0, 1.0)])
    seen.see([(2.0, 0.0, confidence)])
    seen.see_for(5, lambda _: [(0.0, 0.0, 1.0), (2.0, 0.0, confidence)])
    assert seen.ball_is_at(0.0, 0.0)


def test_a_heading_that_is_no_number_is_left_out(seen: Seen) -> None:
    for i in range(60):
        seen.see(robots=[(ME, 0.0, 0.0, nan if i % 10 == 5 else 0.5, 0.9)])
    assert seen.frame().own[0].heading == pytest.approx(0.5, abs=0.01)
