from math import pi

import numpy as np
import pytest

from robobt.skills.aim.raters import NNFiltered, SegmentClearance
from robobt.skills.aim.raters.goal_line import goal_candidates
from robobt.testing import frame, robot
from robobt.world import DIVISION_B

ME = robot(2.6, 0.0)
BALL = (2.7, 0.0)
POINTS = goal_candidates(DIVISION_B)


def test_it_lets_only_shots_pass_that_are_clear_as_well():
    scene = frame(ME, BALL, opponents=(robot(4.2, 0.35, pi),))
    clear = SegmentClearance(tolerance=0.3645).rate(scene, BALL, ME)
    shot = NNFiltered().rate(scene, BALL, ME)
    assert clear is not None
    assert shot is not None
    assert shot.score <= clear.score


def test_a_threshold_nobody_reaches_vetoes_every_shot():
    scene = frame(ME, BALL, opponents=(robot(4.2, 0.35, pi),))
    assert NNFiltered(model="shot_nn_strong", threshold=1.0).rate_all(scene, BALL, ME) == []


def test_a_threshold_of_nothing_is_the_clearance_test_alone():
    scene = frame(ME, BALL, opponents=(robot(4.2, 0.35, pi),))
    shots = NNFiltered(threshold=0.0).rate_all(scene, BALL, ME)
    assert shots == SegmentClearance(tolerance=0.3645).rate_all(scene, BALL, ME)


def test_the_chance_grows_away_from_the_goalkeeper():
    scene = frame(ME, BALL, opponents=(robot(4.2, 0.3, pi),))
    chances = NNFiltered().chances(scene, ME, POINTS)
    assert chances[0] > 0.5
    assert chances[np.argmin(np.abs(POINTS[:, 1] - 0.33))] < 0.3


def test_of_several_robots_the_one_in_the_way_counts():
    alone = frame(ME, BALL, opponents=(robot(4.2, 0.3, pi),))
    both = frame(ME, BALL, opponents=(robot(4.2, 0.3, pi), robot(4.0, -0.3, pi, number=1)))
    rater = NNFiltered()
    one = frame(ME, BALL, opponents=(robot(4.0, -0.3, pi, number=1),))
    least = np.minimum(rater.chances(alone, ME, POINTS), rater.chances(one, ME, POINTS))
    assert rater.chances(both, ME, POINTS) == pytest.approx(least, abs=1e-6)


def test_a_robot_behind_the_shooter_is_not_asked_about():
    scene = frame(ME, BALL, opponents=(robot(2.5, 0.1, pi),))
    assert np.all(NNFiltered().chances(scene, ME, POINTS) == 1.0)


def test_a_model_that_judges_something_else_is_refused():
    with pytest.raises(ValueError, match=r"shot_expected.*takes the observation"):
        NNFiltered(model="shot_expected")
