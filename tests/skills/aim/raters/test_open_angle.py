from math import asin, atan2, pi, radians

import pytest

from robobt.skills.aim.raters import OpenAngle
from robobt.skills.aim.raters.openings import disc_shadow, free_intervals, goal_mouth
from robobt.testing import frame, robot
from robobt.world import BALL_RADIUS, DIVISION_B, ROBOT_RADIUS

ME, BALL = robot(1.9, 0.0), (2.0, 0.0)


def test_an_open_goal_is_the_angle_between_the_posts() -> None:
    shot = OpenAngle(clearance=0.0, full_angle=1.0).rate(frame(ME, BALL), BALL, ME)
    assert shot is not None
    assert shot.tolerance == pytest.approx(atan2(0.5, 2.5))
    assert shot.score == pytest.approx(2 * atan2(0.5, 2.5))


def test_a_robot_takes_away_the_angle_between_its_tangents() -> None:
    keeper = robot(4.0, 0.0)
    shots = OpenAngle().rate_all(frame(ME, BALL, opponents=(keeper,)), BALL, ME)
    hidden = asin((ROBOT_RADIUS + BALL_RADIUS) / 2.0)
    post = atan2(0.5 - BALL_RADIUS, 2.5)
    assert [shot.tolerance for shot in shots] == pytest.approx([(post - hidden) / 2] * 2)
    aims = [atan2(shot.target[1], 2.5) for shot in shots]
    assert aims == pytest.approx([(post + hidden) / 2, -(post + hidden) / 2])


def test_from_the_full_angle_on_a_shot_scores_one_and_half_of_it_a_half() -> None:
    width = 2 * atan2(0.5, 2.5)
    for full, score in ((width, 1.0), (width / 2, 1.0), (2 * width, 0.5)):
        shot = OpenAngle(clearance=0.0, full_angle=full).rate(frame(ME, BALL), BALL, ME)
        assert shot is not None
        assert shot.score == pytest.approx(score)


def test_thunderbots_six_degrees_are_six_tenths_of_a_score() -> None:
    assert OpenAngle().full_angle == pytest.approx(radians(10.0))


def test_a_robot_touching_the_ball_hides_the_half_plane_on_its_side() -> None:
    shadow = disc_shadow(DIVISION_B, (0.0, 0.0), (0.05, 0.0), 0.1)
    assert shadow == pytest.approx((-pi / 2, pi / 2))


def test_overlapping_shadows_are_taken_away_once() -> None:
    shadows = [(0.5, 0.7), (0.2, 0.6), (-1.0, 0.1), (0.95, 2.0)]
    assert free_intervals((0.0, 1.0), shadows) == [(0.1, 0.2), (0.7, 0.95)]
    assert free_intervals((0.0, 1.0), [(2.0, 3.0), (-2.0, -1.0)]) == [(0.0, 1.0)]
    assert free_intervals((0.0, 1.0), [(-1.0, 0.5), (0.5, 2.0)]) == []


def test_a_goal_narrower_than_what_its_posts_take_has_no_mouth() -> None:
    assert goal_mouth(DIVISION_B, BALL, 0.5) is None
