"""Telling a sliding ball from a rolling one."""

from __future__ import annotations

import pytest

from robobt.motion.ball_watch import BallWatch
from robobt.testing import Trial, blue, frame, robot
from robobt.world import Frame
from robobt.world.ball_model import DEFAULT_BALL

PERIOD = 1 / 60


def seen(speed: float, tick: int) -> Frame:
    return frame(robot(), ball=(0.0, 0.0, speed, 0.0), time=tick * PERIOD)


def test_a_ball_seen_for_the_first_time_rolls() -> None:
    assert BallWatch().rolling_speed(seen(3.0, 0)) == 3.0


def test_a_kick_makes_it_slide_down_to_the_share_of_its_speed() -> None:
    watch = BallWatch()
    watch.rolling_speed(seen(0.0, 0))
    assert watch.rolling_speed(seen(5.0, 1)) == pytest.approx(5.0 * DEFAULT_BALL.switch_share)
    assert watch.rolling_speed(seen(4.95, 2)) == pytest.approx(5.0 * DEFAULT_BALL.switch_share)


def test_slow_deceleration_means_it_rolls() -> None:
    watch = BallWatch()
    watch.rolling_speed(seen(2.0, 0))
    assert watch.rolling_speed(seen(1.995, 1)) == 1.995


def test_fast_deceleration_means_it_slides() -> None:
    watch = BallWatch()
    watch.rolling_speed(seen(2.0, 0))
    assert watch.rolling_speed(seen(1.95, 1)) < 1.7


def test_asked_twice_in_a_frame_it_says_the_same() -> None:
    watch = BallWatch()
    watch.rolling_speed(seen(0.0, 0))
    assert watch.rolling_speed(seen(4.0, 1)) == watch.rolling_speed(seen(4.0, 1))


def test_a_gap_in_time_starts_anew() -> None:
    watch = BallWatch()
    watch.rolling_speed(seen(5.0, 0))
    assert watch.rolling_speed(seen(3.0, 60)) == 3.0


def test_it_agrees_with_the_simulated_ball() -> None:
    trial = Trial({}, {blue(0): (-4.0, 2.5, 0.0)}, ball=(-3.0, 0.0, 4.0, 0.0))
    watch = BallWatch()
    for _ in range(90):
        world = trial.tick()
        rolling = watch.rolling_speed(world)
    assert rolling == world.ball.speed, "after 1.5 s it rolls"
