from math import atan, atan2, erf, exp, pi, sqrt

import numpy as np
import pytest

from robobt.skills.aim.raters import Gaussian
from robobt.skills.aim.raters.openings import goal_mouth
from robobt.testing import frame, robot
from robobt.world import BALL_RADIUS, DIVISION_B

ME, BALL = robot(1.9, 0.0), (2.0, 0.0)
RATER = Gaussian()
MOUTH = goal_mouth(DIVISION_B, BALL, BALL_RADIUS)
assert MOUTH is not None
LOW, HIGH = MOUTH


def test_without_blockers_it_is_the_normal_mass_between_the_posts() -> None:
    aims = np.array([0.0, 0.1, HIGH])
    got = RATER.chances(aims, (LOW, HIGH), [])
    for aim, chance in zip(aims, got, strict=True):
        spread = RATER.kick_error * sqrt(2.0)
        assert chance == pytest.approx((erf((HIGH - aim) / spread) - erf((LOW - aim) / spread)) / 2)
    assert got[2] == pytest.approx(0.5, abs=1e-3)


@pytest.mark.parametrize("blocker", [(0.0, 0.1), (0.15, 0.3), (-0.3, 0.05)])
def test_a_blocker_takes_the_integral_of_kick_times_block(blocker: tuple[float, float]) -> None:
    centre, width = blocker
    angles = np.linspace(LOW, HIGH, 20_001)
    for aim in (-0.1, 0.0, 0.12):
        kick = np.exp(-0.5 * ((angles - aim) / RATER.kick_error) ** 2) / (RATER.kick_error * sqrt(2 * pi))
        passes = 1.0 - np.exp(-0.5 * ((angles - centre) / width) ** 2)
        expected = float(np.trapezoid(kick * passes, angles))
        (chance,) = RATER.chances(np.array([aim]), (LOW, HIGH), [blocker])
        assert chance == pytest.approx(expected, abs=1e-6)


def test_the_target_is_the_best_aim_of_the_mouth() -> None:
    keeper = robot(4.2, 0.12)
    shot = RATER.rate(frame(ME, BALL, opponents=(keeper,)), BALL, ME)
    assert shot is not None
    blocker = (atan2(0.12, 2.2), atan(0.3 / np.hypot(2.2, 0.12)))
    ys = np.linspace(-0.47, 0.47, 941)
    chances = RATER.chances(np.arctan2(ys, 2.5), (LOW, HIGH), [blocker])
    assert shot.target[1] == pytest.approx(ys[chances.argmax()], abs=0.02)
    assert shot.score == pytest.approx(chances.max(), abs=1e-3)


def test_a_sharper_kicker_has_the_better_chance() -> None:
    here = frame(ME, BALL, opponents=(robot(4.2, 0.2),))
    scores = []
    for error in (0.01, 0.04, 0.16):
        shot = Gaussian(kick_error=error).rate(here, BALL, ME)
        assert shot is not None
        scores.append(shot.score)
    assert scores == sorted(scores, reverse=True)
    assert scores[0] > scores[2] + 0.1


def test_a_robot_straight_in_the_way_stops_what_comes_straight_at_it() -> None:
    (chance,) = Gaussian(kick_error=0.001).chances(np.array([0.0]), (LOW, HIGH), [(0.0, 0.2)])
    assert chance == pytest.approx(0.0, abs=1e-4)
    (beside,) = Gaussian(kick_error=0.001).chances(np.array([0.1]), (LOW, HIGH), [(0.0, 0.1)])
    assert beside == pytest.approx(1.0 - exp(-0.5), abs=1e-3)


def test_right_before_the_goal_the_aim_is_the_middle_of_all_that_is_certain() -> None:
    ball = (4.2, 0.0)
    shot = RATER.rate(frame(robot(4.1, 0.0), ball), ball, robot(4.1, 0.0))
    assert shot is not None
    assert shot.score == pytest.approx(1.0, abs=1e-6)
    assert shot.target[1] == pytest.approx(0.0, abs=1e-9)
